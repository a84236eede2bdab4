"""The pseudo-inverse: it converges, keeps the limits all the way, and says when it cannot."""

import numpy as np
import pytest

from youbot_kinematics import PlanningError, YoubotKinematics
from youbot_kinematics.differential import (
    LINE_TOLERANCE,
    POSITION_TOLERANCE,
    damped_pseudo_inverse,
    full_checkpoints_to_joints,
    ik_position_only,
    line_path,
)
from youbot_kinematics.path import intermediate_tfs

ARM = YoubotKinematics()
WORKING = np.array([2.9, 1.2, -2.0, 2.2, 2.9])
NEARBY = WORKING + [0.3, 0.2, -0.2, 0.1, 0.2]


def test_it_finds_a_nearby_position_and_reports_its_residual():
    pose = ARM.forward_kinematics(NEARBY)
    solution = ik_position_only(ARM, pose, WORKING, ARM.limits)
    reached = ARM.forward_kinematics(solution.joints)[:3, 3]
    assert solution.converged
    assert solution.residual == pytest.approx(np.linalg.norm(reached - pose[:3, 3]), abs=1e-12)
    assert solution.residual <= POSITION_TOLERANCE


def test_the_null_space_follows_the_orientation():
    """A pose that the arm can take is taken, though only the position is asked for."""
    pose = ARM.forward_kinematics(NEARBY)
    assert ik_position_only(ARM, pose, WORKING, ARM.limits).angle < 1e-4
    assert ik_position_only(ARM, pose, WORKING, ARM.limits, max_turn=0.0).angle > 1e-2


def test_every_iterate_keeps_the_limits_where_the_target_pulls_beyond_them():
    rng = np.random.default_rng(0)
    for _ in range(30):
        start = rng.uniform(ARM.limits.lower, ARM.limits.upper)
        pose = ARM.forward_kinematics(rng.uniform(ARM.limits.lower, ARM.limits.upper))
        assert ARM.limits.contain(ik_position_only(ARM, pose, start, ARM.limits).joints)


def test_out_of_reach_ends_with_the_residual_and_not_in_an_endless_loop():
    pose = np.eye(4)
    pose[:3, 3] = [2.0, 0.0, 0.2]
    solution = ik_position_only(ARM, pose, WORKING, ARM.limits)
    assert not solution.converged
    assert solution.residual > 1.0


def test_a_start_with_all_joints_on_their_limits_can_leave_them():
    lower = np.zeros(5)
    pose = ARM.forward_kinematics(lower + [0.05, 0.05, -0.05, 0.05, 0.05])
    assert ik_position_only(ARM, pose, lower, ARM.limits).converged


def test_the_damped_inverse_is_the_pseudo_inverse_without_damping():
    J = np.random.default_rng(0).normal(size=(3, 5))
    np.testing.assert_allclose(damped_pseudo_inverse(J, 0.0), np.linalg.pinv(J), atol=1e-12)


def test_the_damped_inverse_stays_bounded_at_a_singularity():
    J = np.diag([1.0, 1e-9, 0.0])
    assert np.abs(damped_pseudo_inverse(J, 0.02)).max() <= 25


def test_a_path_is_solved_at_each_of_its_waypoints():
    checkpoints = ARM.forward_kinematics([WORKING, NEARBY])
    poses = intermediate_tfs([0, 1], checkpoints, 10)
    joints = full_checkpoints_to_joints(ARM, poses, WORKING, ARM.limits)
    assert joints.shape == (12, 5)
    reached = ARM.forward_kinematics(joints)[:, :3, 3]
    np.testing.assert_allclose(reached, poses[:, :3, 3], atol=POSITION_TOLERANCE)
    assert ARM.limits.contain(joints).all()


def test_the_spline_of_a_line_stays_on_the_line_between_its_waypoints():
    T_a, T_b = ARM.forward_kinematics([WORKING, NEARBY])
    path = line_path(ARM, T_a, T_b, WORKING, ARM.limits, checkpoint=0, num_points=2)
    s = np.linspace(0, 1, 1001)
    tool = ARM.forward_kinematics(path.spline()(s))[:, :3, 3]
    line = T_a[:3, 3] + s[:, None] * (T_b[:3, 3] - T_a[:3, 3])
    assert np.linalg.norm(tool - line, axis=1).max() < 2 * LINE_TOLERANCE


def test_a_line_close_to_joint_1_s_axis_turns_the_arm_round_and_does_not_leap_over_the_axis():
    """With few waypoints the coursework's pseudo-inverse lands on the other side, over the back."""
    T_a, T_b = np.tile(ARM.forward_kinematics(WORKING), (2, 1, 1))
    T_a[:3, 3], T_b[:3, 3] = [0.006, -0.15, 0.45], [0.006, 0.15, 0.45]
    q_a = ik_position_only(ARM, T_a, [4.3, 1.2, -2.0, 2.2, 2.9], ARM.limits).joints
    path = line_path(ARM, T_a, T_b, q_a, ARM.limits, checkpoint=0, num_points=0)
    azimuth = np.deg2rad(170) - path.joints[:, 0]
    tool = ARM.forward_kinematics(path.joints)[:, :3, 3]
    radius = tool[:, 0] * np.cos(azimuth) + tool[:, 1] * np.sin(azimuth)
    assert radius.min() > 0.0
    assert np.ptp(path.joints[:, 0]) == pytest.approx(2 * np.arctan2(0.15, 0.006), abs=1e-3)


def test_a_path_that_cannot_be_tracked_names_waypoint_joint_and_limit():
    far = np.eye(4)
    far[:3, 3] = [0.7, 0.0, 0.2]
    poses = intermediate_tfs([0, 1], [ARM.forward_kinematics(WORKING), far], 10)
    with pytest.raises(PlanningError, match=r"waypoint \d+ .*arm_joint_\d.* limit"):
        full_checkpoints_to_joints(ARM, poses, WORKING, ARM.limits)
