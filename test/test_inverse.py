"""Inverse kinematics, judged by forward kinematics alone."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from youbot_kinematics import InputError, YoubotKinematics, arm

PROFILES = {name: YoubotKinematics(name) for name in arm.LIMITS}
KIN = PROFILES["urdf"]


def random_joints(kin, n, seed=0):
    return np.random.default_rng(seed).uniform(kin.limits.lower, kin.limits.upper, (n, 5))


def pose(position, euler="ZYZ", angles=(0, 0, 0)):
    T = np.eye(4)
    T[:3, :3] = Rotation.from_euler(euler, angles).as_matrix()
    T[:3, 3] = position
    return T


def assert_answers(kin, q):
    """Each answer gives the pose of q back and keeps the limits; q itself is among the answers."""
    T = kin.forward_kinematics(q)
    branches = kin.inverse_branches(T, seed=q if q.ndim == 1 else None)
    answers, valid = branches.joints, branches.valid
    assert np.isfinite(answers).all()
    errors = np.abs(
        kin.forward_kinematics(np.where(valid[..., None], answers, 0)) - T[..., None, :, :]
    )
    assert errors[valid].max() < 1e-9
    assert kin.limits.contain(answers[valid]).all()
    # Near the edge of reach the elbow is as uncertain as the square root of the rounding.
    distance = np.where(valid, np.abs(answers - q[..., None, :]).max(axis=-1), np.inf).min(axis=-1)
    assert distance.max() < 1e-6
    return distance


@pytest.mark.parametrize("profile", PROFILES)
def test_every_answer_brings_its_pose_back_and_the_generating_joints_are_among_them(profile):
    kin = PROFILES[profile]
    distance = assert_answers(kin, random_joints(kin, 10_000))
    assert np.median(distance) < 1e-14


joint_positions = st.tuples(
    *[st.floats(low, high) for low, high in zip(KIN.limits.lower, KIN.limits.upper)]
)


@given(joint_positions)
def test_any_joints_inside_the_limits_are_an_answer_to_their_pose(q):
    T = KIN.forward_kinematics(q)
    answers = KIN.inverse_kinematics(T, seed=q)
    assert 1 <= len(answers) <= 4
    assert np.abs(KIN.forward_kinematics(answers) - T).max() < 1e-9
    assert KIN.limits.contain(answers).all()


@given(
    st.lists(st.floats(-1, 1), min_size=3, max_size=3),
    st.lists(st.floats(-4, 4), min_size=3, max_size=3),
)
def test_any_pose_is_answered_truly_or_with_a_reason_for_each_branch(position, angles):
    T = pose(position, angles=angles)
    branches = KIN.inverse_branches(T)
    for answer in branches.joints[branches.valid]:
        assert np.abs(KIN.forward_kinematics(answer) - T).max() < 1e-8
    against = (
        (branches.out_of_reach != 0)
        | (branches.limit_excess != 0).any(axis=-1)
        | (branches.tilt > 1e-9)
    )
    assert (against == ~branches.valid).all()
    assert not np.isnan(branches.limit_excess).any()


def test_every_combination_of_joints_on_their_limits_is_answered():
    for kin in PROFILES.values():
        bounds = np.stack([kin.limits.lower, kin.limits.upper])
        corners = np.stack(np.meshgrid(*bounds.T, indexing="ij"), axis=-1).reshape(-1, 5)
        for corner in corners:
            assert_answers(kin, corner)


def test_a_straight_elbow_gives_its_two_branches_the_same_answer():
    q = np.array([1.0, 1.2, np.deg2rad(-146), 1.0, 2.0])
    answers = KIN.inverse_kinematics(KIN.forward_kinematics(q))
    assert np.abs(answers - q).max(axis=1).min() < 1e-6
    assert np.abs(KIN.forward_kinematics(answers) - KIN.forward_kinematics(q)).max() < 1e-9


@pytest.mark.parametrize("beta", [0.0, 0.3, -0.8])
def test_a_tool_on_joint_1s_axis_is_answered_in_the_plane_of_its_z_axis(beta):
    T = pose([0, 0, 0.52], angles=[1.1, beta, 0.4])
    answers = KIN.inverse_kinematics(T, seed=arm.UPRIGHT)
    assert len(answers)
    assert np.abs(KIN.forward_kinematics(answers) - T).max() < 1e-9


def test_a_vertical_tool_on_joint_1s_axis_takes_joint_1_from_the_seed():
    T = pose([0, 0, 0.55])
    for q1 in (2.0, 2.5, 3.0):
        assert KIN.inverse_kinematics(T, seed=[q1, 0, 0, 0, 0])[0, 0] == pytest.approx(
            q1, abs=1e-12
        )


def test_a_batch_gives_what_its_members_give():
    T = KIN.forward_kinematics(random_joints(KIN, 6)).reshape(2, 3, 4, 4)
    batch = KIN.inverse_branches(T)
    assert batch.joints.shape == (2, 3, 4, 5)
    for index in np.ndindex(2, 3):
        single = KIN.inverse_branches(T[index])
        for ours, theirs in zip(batch, single):
            assert np.allclose(ours[index], theirs, rtol=0, atol=1e-14)
    assert KIN.inverse_branches(T[:0]).joints.shape == (0, 3, 4, 5)


def test_a_pose_that_is_too_far_says_by_how_much():
    reach = 0.155 + 0.135
    T = pose([0.033 + reach + 0.185 + 0.1, 0, 0.145 + 0.002], "Y", np.pi / 2)
    branches = KIN.inverse_branches(T)
    assert not branches.valid.any() and len(KIN.inverse_kinematics(T)) == 0
    assert np.allclose(branches.out_of_reach[:2], 0.1, atol=1e-3)
    assert (
        branches.reasons()[0] == f"front, elbow +: out of reach by {branches.out_of_reach[0]:.3g} m"
    )


def test_a_pose_that_is_too_close_to_the_shoulder_says_by_how_much():
    T = pose([0.033 + 0.185, 0, 0.145 + 0.002 + 0.005], "Y", np.pi / 2)  # wrist 5 mm above shoulder
    branches = KIN.inverse_branches(T)
    assert np.allclose(branches.out_of_reach[:2], 0.005 - 0.020)
    assert "too close to the shoulder by 0.015 m" in branches.reasons()[0]


def test_a_pose_out_of_the_arms_plane_says_by_what_angle():
    T = KIN.forward_kinematics(random_joints(KIN, 1)[0])
    phi = np.arctan2(T[1, 3], T[0, 3])
    tilted = T.copy()
    normal = np.array([-np.sin(phi), np.cos(phi), 0])
    axis = np.cross(T[:3, 2], normal)
    tilted[:3, :3] = (
        Rotation.from_rotvec(0.25 * axis / np.linalg.norm(axis)).as_matrix() @ T[:3, :3]
    )
    branches = KIN.inverse_branches(tilted)
    assert not branches.valid.any()
    assert np.allclose(branches.tilt, 0.25)
    assert "tool tilted 0.25 rad out of the arm's plane" in branches.reasons()[0]


def test_a_pose_that_breaks_a_limit_names_the_joint_and_by_how_much():
    q = (KIN.limits.lower + KIN.limits.upper) / 2
    q[3] = KIN.limits.upper[3] + 0.2
    branches = KIN.inverse_branches(KIN.forward_kinematics(q))
    against = branches.limit_excess[np.abs(branches.limit_excess[:, 3] - 0.2) < 1e-9]
    assert len(against) == 1 and np.count_nonzero(against) == 1
    assert any(
        "arm_joint_4 would be 0.2 rad above its upper limit" in r for r in branches.reasons()
    )


def test_reasons_of_a_batch_are_refused():
    with pytest.raises(InputError, match="reasons are for one pose"):
        KIN.inverse_branches(np.stack([np.eye(4)] * 2)).reasons()


@pytest.mark.parametrize(
    ("T", "sentence"),
    [
        (np.eye(3), r"got \(3, 3\)"),
        (np.eye(4)[None], "takes one pose"),
        (np.full((4, 4), np.nan), "must be finite"),
        (np.diag([1, 1, -1, 1]), "left-handed"),
        (np.diag([2, 1, 1, 1]), "off the identity by 3"),
        (np.zeros((4, 4)), "off the identity by 1"),
        (np.eye(4) + np.eye(4)[[3]].T @ np.eye(4)[[0]], "last row"),
        ("home", "array .* of numbers"),
        (None, r"got \(\)"),
    ],
)
def test_what_is_no_pose_is_refused_with_what_was_found(T, sentence):
    with pytest.raises(InputError, match=sentence):
        KIN.inverse_kinematics(T)


@pytest.mark.parametrize("seed", [[0, 0], "home", [np.nan] * 5])
def test_a_seed_that_is_no_joint_position_is_refused(seed):
    with pytest.raises(InputError, match="joint positions must"):
        KIN.inverse_kinematics(np.eye(4), seed=seed)


def test_a_tool_near_joint_1s_axis_is_answered_exactly():
    rng = np.random.default_rng(7)
    for distance in (1e-12, 1e-10, 1e-8, 1e-6, 1e-4, 1e-2):
        for pitch in (1e-6, 0.3, -0.8):
            T = np.eye(4)
            azimuth = rng.uniform(-2, 2)
            T[:3, :3] = Rotation.from_euler("ZYZ", [azimuth, pitch, 0.4]).as_matrix()
            T[:3, 3] = [distance * np.cos(azimuth), distance * np.sin(azimuth), 0.53]
            answers = KIN.inverse_kinematics(T)
            assert len(answers), (distance, pitch)
            assert np.abs(KIN.forward_kinematics(answers) - T).max() < 1e-9


def test_front_means_the_same_near_the_axis_as_far_from_it():
    # The tool leans back over the axis: its azimuth is opposite to that of its position.
    for distance in (1e-2, 1e-4, 1e-6):
        T = pose([distance, 0, 0.53], "Y", -0.3)
        front = KIN.inverse_branches(T).joints[0]
        assert np.isclose(front[0], np.deg2rad(170))


def test_a_straight_elbow_is_one_answer_even_with_the_other_joints_on_their_limits():
    for kin in PROFILES.values():
        for bounds in (kin.limits.lower, kin.limits.upper):
            q = bounds.copy()
            q[2] = np.deg2rad(-146)
            answers = kin.inverse_kinematics(kin.forward_kinematics(q))
            assert (np.abs(answers - q).max(axis=1) < 1e-6).sum() == 1


def test_a_vertical_tool_on_the_axis_keeps_joint_5_inside_as_near_to_the_seed_as_can_be():
    rng = np.random.default_rng(8)
    solved = 0
    for _ in range(300):
        down = rng.random() < 0.3
        height = rng.uniform(0.1, 0.45) if down else rng.uniform(0.35, 0.58)
        T = pose([0, 0, height], "ZYZ", [0, np.pi * down, rng.uniform(-np.pi, np.pi)])
        seed = rng.uniform(*KIN.limits[:2])
        answers = KIN.inverse_kinematics(T, seed=seed)
        if len(answers) == 0:
            continue
        solved += 1
        assert np.abs(KIN.forward_kinematics(answers) - T).max() < 1e-9
        # Joints 1 and 5 turn together: try all others of joint 1.
        sense = 1 if down else -1
        q1 = np.linspace(KIN.limits.lower[0], KIN.limits.upper[0], 3000)
        q5 = answers[0, 4] + sense * (q1 - answers[0, 0])
        free = np.mod(q5, 2 * np.pi) <= KIN.limits.upper[4]
        nearest = np.abs(answers[:, 0] - seed[0]).min()
        assert nearest <= np.abs(q1[free] - seed[0]).min() + 1e-9
    assert solved > 100


def test_a_pose_at_the_very_edge_of_reach_is_answered_in_spite_of_rounding():
    rng = np.random.default_rng(9)
    q = rng.uniform(*KIN.limits[:2], (2000, 5))
    q[:, 2] = np.deg2rad(-146)
    T = KIN.forward_kinematics(q)
    for rounding in (-1, 0, 1):
        shifted = T.copy()
        shifted[:, :3, 3] *= 1 + rounding * np.finfo(float).eps
        branches = KIN.inverse_branches(shifted)
        assert branches.valid.any(axis=1).all()
        assert not np.isnan(branches.joints[branches.valid]).any()


def test_poses_that_another_forward_kinematics_computed_a_little_differently_are_answered():
    # A URDF with 12 digits differs by 1e-12. Near the axis, that turned the position's azimuth so
    # much that exact poses were refused as tilted: the tool's z axis tells it better there.
    rng = np.random.default_rng(10)
    for difference in (1e-12, 1e-11):
        q = random_joints(KIN, 50_000, seed=11)
        T = KIN.forward_kinematics(q)
        T[:, :3, 3] += rng.uniform(-difference, difference, (len(q), 3))
        turn = Rotation.from_rotvec(rng.uniform(-difference, difference, (len(q), 3)))
        T[:, :3, :3] = turn.as_matrix() @ T[:, :3, :3]
        branches = KIN.inverse_branches(T)
        assert branches.valid.any(axis=1).all()
        i, _ = np.nonzero(branches.valid)
        reached = KIN.forward_kinematics(branches.joints[branches.valid])
        assert np.abs(reached - T[i]).max() < 1e-9
