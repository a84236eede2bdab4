"""Inverse kinematics for the position alone, judged by the inverse kinematics for poses."""

from itertools import chain

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from youbot_kinematics import InputError, YoubotKinematics

KIN = YoubotKinematics()
LIMITS = KIN.limits


def random_joints(n, seed=0):
    return np.random.default_rng(seed).uniform(LIMITS.lower, LIMITS.upper, (n, 5))


def poses(p, pitch, roll=0.0):
    """The poses at a position with pitches (n,) and a roll, as the module defines them."""
    azimuth = np.arctan2(p[1], p[0])
    angles = np.stack(np.broadcast_arrays(azimuth, pitch, roll), axis=-1)
    T = np.tile(np.eye(4), (len(angles), 1, 1))
    T[:, :3, :3] = Rotation.from_euler("ZYZ", angles).as_matrix()
    T[:, :3, 3] = p
    return T


def test_a_pitch_has_joints_inside_the_limits_inside_the_intervals_and_nowhere_else():
    pitches = np.linspace(-np.pi, np.pi, 2000, endpoint=False)
    for q in random_joints(60):
        p = KIN.forward_kinematics(q)[:3, 3]
        truth = KIN.inverse_branches(poses(p, pitches))
        inside = (truth.out_of_reach == 0) & (truth.limit_excess[..., :4] == 0).all(axis=-1)
        for branch, intervals in enumerate(KIN.inverse_position(p).pitch_intervals):
            claimed, near_an_end = np.zeros(2000, bool), np.zeros(2000, bool)
            for low, high in intervals:
                assert -np.pi <= low < np.pi and low <= high
                claimed |= np.mod(pitches - low, 2 * np.pi) <= high - low
                for end in (low, high):
                    near_an_end |= np.abs(np.angle(np.exp(1j * (pitches - end)))) < 1e-6
            assert (claimed == inside[:, branch])[~near_an_end].all()


def test_at_the_ends_of_the_intervals_a_joint_is_on_its_limit_or_the_elbow_is_straight():
    for q in random_joints(60, seed=1):
        p = KIN.forward_kinematics(q)[:3, 3]
        for low, high in chain(*KIN.inverse_position(p).pitch_intervals):
            for pitch in (low, high):
                solutions = KIN.inverse_position(p, pitch).solutions
                margin = np.minimum(solutions - LIMITS.lower, LIMITS.upper - solutions)[:, 1:4]
                straight = np.abs(solutions[:, 2] + np.deg2rad(146))
                assert margin.min() < 1e-7 or straight.min() < 1e-6


def test_there_is_a_solution_for_each_interval_and_every_one_reaches_the_position():
    for q in random_joints(100, seed=2):
        p = KIN.forward_kinematics(q)[:3, 3]
        answer = KIN.inverse_position(p)
        assert len(answer.solutions) == sum(map(len, answer.pitch_intervals)) >= 1
        assert np.abs(KIN.forward_kinematics(answer.solutions)[:, :3, 3] - p).max() < 1e-12
        assert LIMITS.contain(answer.solutions).all()


def test_the_seed_itself_is_among_the_solutions_for_its_position():
    for q in random_joints(200, seed=3):
        p = KIN.forward_kinematics(q)[:3, 3]
        solutions = KIN.inverse_position(p, seed=q).solutions
        assert np.abs(solutions - q).max(axis=1).min() < 1e-8


def test_a_position_with_pitch_and_roll_is_a_pose():
    for q in random_joints(200, seed=4):
        T = KIN.forward_kinematics(q)
        _, pitch, roll = Rotation.from_matrix(T[:3, :3]).as_euler("ZYZ")
        to_plane = Rotation.from_euler("Z", -np.arctan2(T[1, 3], T[0, 3])).as_matrix() @ T[:3, :3]
        pitch = np.arctan2(to_plane[0, 2], to_plane[2, 2])
        roll = np.arctan2(to_plane[1, 0], to_plane[1, 1])
        solutions = KIN.inverse_position(T[:3, 3], pitch, roll).solutions
        expected = KIN.inverse_kinematics(T)
        assert solutions.shape == expected.shape and np.abs(solutions - expected).max() < 1e-7


def test_on_joint_1s_axis_joint_1_comes_from_the_seed():
    seed = np.array([2.0, 0.5, -1.0, 1.0, 3.0])
    solutions = KIN.inverse_position([0, 0, 0.5], seed=seed).solutions
    assert set(solutions[:, 0].round(12)) == {2.0, round(2.0 + np.pi, 12)}  # front and back
    assert (solutions[:, 4] == 3.0).all()
    assert np.abs(KIN.forward_kinematics(solutions)[:, :3, 3] - [0, 0, 0.5]).max() < 1e-12


def test_a_roll_that_joint_5_cannot_turn_to_leaves_no_pitch():
    p = KIN.forward_kinematics([2.9, 1.0, -1.2, 1.7, 2.9])[:3, 3]
    roll = np.deg2rad(167.5) - (LIMITS.upper[4] + 0.1)  # in the gap, as the arm reaches forward
    assert any(KIN.inverse_position(p).pitch_intervals[:2])
    rolled = KIN.inverse_position(p, roll=roll)
    assert rolled.pitch_intervals[:2] == [[], []]
    assert not KIN.configuration(rolled.solutions)["front"].any()


def test_a_position_out_of_reach_has_no_intervals_and_no_solutions():
    answer = KIN.inverse_position([1.0, 0.0, 0.3])
    assert answer.pitch_intervals == [[], [], [], []] and answer.solutions.shape == (0, 5)


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        (([0, 0],), r"p must be finite and of shape \(3,\)"),
        (([0, 0, np.nan],), "p must be finite"),
        (("up",), "p must be finite"),
        (([0, 0, 0.5], "down"), "pitch must be finite"),
        (([0, 0, 0.5], 0.0, np.inf), "roll must be finite"),
        (([0, 0, 0.5], None, None, [0, 0]), "joint positions must"),
    ],
)
def test_bad_input_is_refused_with_a_sentence(arguments, sentence):
    with pytest.raises(InputError, match=sentence):
        KIN.inverse_position(*arguments)
