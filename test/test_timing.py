"""Time scaling: the limits are kept as the controller runs it, and used."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from youbot_kinematics.timing import RATES, cubic_rate, time_paths
from youbot_kinematics.trajectory import JointPath, interpolate

VELOCITY, ACCELERATION, DT = np.full(5, np.pi / 2), np.full(5, 3.0), 0.02


def path_through(joints, checkpoint=0):
    joints = np.asarray(joints, dtype=float)
    return JointPath("line", checkpoint, checkpoint + 1, np.linspace(0, 1, len(joints)), joints)


def straight(*distances):
    return path_through(np.linspace(np.zeros(5), distances, 8))


def peaks(trajectory):
    dense = np.arange(0, trajectory.duration + 5e-4, 1e-3)
    _, v, a = interpolate(trajectory, dense)
    return np.abs(v).max(axis=0), np.abs(a).max(axis=0)


def test_the_cubic_scaling_is_3_t2_minus_2_t3():
    times, rates = cubic_rate(straight(1.0, 0, 0, 0, 0), VELOCITY, ACCELERATION)
    s = np.concatenate([[0.0], np.cumsum(np.diff(times) * (rates[1:] + rates[:-1]) / 2)])
    t = times / times[-1]
    np.testing.assert_allclose(s, 3 * t**2 - 2 * t**3, atol=1e-4)


def test_a_short_move_takes_the_time_that_its_acceleration_asks_for():
    """The peak acceleration of the cubic is 6 d / T^2; two samples of rounding come on top."""
    trajectory = time_paths([straight(0.2, 0, 0, 0, 0)], VELOCITY, ACCELERATION, DT, "cubic")
    shortest = np.sqrt(6 * 0.2 / 3.0)
    assert shortest <= trajectory.duration <= shortest + 2.5 * DT


def test_a_long_move_takes_the_time_that_its_velocity_asks_for():
    trajectory = time_paths([straight(0, 0, 0, 4.0, 0)], VELOCITY, ACCELERATION, DT, "cubic")
    shortest = 1.5 * 4.0 / (np.pi / 2)
    assert shortest <= trajectory.duration <= shortest + 2.5 * DT


@settings(max_examples=25)
@given(
    st.integers(0, 2**32 - 1),
    st.integers(2, 12),
    st.sampled_from([0.005, 0.02, 0.1]),
    st.sampled_from(list(RATES)),
)
def test_the_controller_s_motion_keeps_the_limits_and_uses_them(seed, n, dt, timing):
    joints = np.random.default_rng(seed).normal(size=(n, 5)).cumsum(axis=0)
    trajectory = time_paths([path_through(joints)], VELOCITY, ACCELERATION, dt, timing)
    v, a = peaks(trajectory)
    assert (v <= VELOCITY).all()
    assert (a <= ACCELERATION).all()
    shorter = trajectory.duration - 4 * dt
    used = max((v / VELOCITY).max(), np.sqrt((a / ACCELERATION).max()))
    assert used * trajectory.duration >= 0.8 * shorter


@settings(max_examples=25)
@given(st.integers(0, 2**32 - 1), st.integers(2, 8))
def test_it_starts_and_ends_at_rest_where_the_path_does(seed, n):
    joints = np.random.default_rng(seed).normal(size=(n, 5))
    trajectory = time_paths([path_through(joints)], VELOCITY, ACCELERATION, DT)
    assert (trajectory.positions[[0, -1]] == joints[[0, -1]]).all()
    assert not trajectory.velocities[[0, -1]].any()
    assert not trajectory.accelerations[[0, -1]].any()


def test_paths_follow_each_other_with_a_point_at_rest_between_them():
    a, b = np.zeros(5), np.full(5, 0.3)
    paths = [path_through([a, b / 2, b]), path_through([b, b / 3, a], checkpoint=1)]
    trajectory = time_paths(paths, VELOCITY, ACCELERATION, DT)
    first, second = trajectory.segments
    assert (first.from_checkpoint, first.to_checkpoint) == (0, 1)
    assert first.start == 0.0 and first.end == second.start and second.end == trajectory.duration
    at_stop = round(first.end / DT)
    np.testing.assert_array_equal(trajectory.positions[at_stop], b)
    assert not trajectory.velocities[at_stop].any()
    np.testing.assert_allclose(np.diff(trajectory.times), DT, atol=1e-12)


def test_a_path_that_goes_nowhere_takes_no_time():
    q = np.full((3, 5), 0.5)
    paths = [path_through(q), straight(0.1, 0, 0, 0, 0), path_through(q)]
    paths[1] = paths[1]._replace(joints=paths[1].joints + 0.5)
    trajectory = time_paths(paths[:2], VELOCITY, ACCELERATION, DT)
    assert trajectory.segments[0].start == trajectory.segments[0].end == 0.0
    assert time_paths([path_through(q)], VELOCITY, ACCELERATION, DT).times.tolist() == [0.0]


def test_the_optimal_motion_of_one_joint_is_bang_coast_bang():
    trajectory = time_paths([straight(0, 4.0, 0, 0, 0)], VELOCITY, ACCELERATION, DT, "optimal")
    shortest = 4.0 / (np.pi / 2) + (np.pi / 2) / 3.0
    assert shortest <= trajectory.duration <= shortest + 2.5 * DT


def test_velocity_scaling_stretches_the_time():
    paths = [straight(4.0, 0, 0, 0, 0)]
    fast = time_paths(paths, VELOCITY, ACCELERATION, DT, "cubic").duration
    slow = time_paths(paths, VELOCITY / 2, ACCELERATION, DT, "cubic").duration
    assert slow == pytest.approx(2 * fast, abs=4 * DT)
