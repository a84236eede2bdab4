"""The recipe from targets to a checked trajectory, judged by forward kinematics."""

import numpy as np
import pytest

from youbot_kinematics import InputError, PlanningError, YoubotKinematics
from youbot_kinematics.make_bag import random_joints
from youbot_kinematics.parameters import Parameters
from youbot_kinematics.planner import plan
from youbot_kinematics.summary import summary
from youbot_kinematics.targets import Targets
from youbot_kinematics.trajectory import interpolate

ARM = YoubotKinematics()
START = np.array([2.9, 1.2, -2.0, 2.2, 2.9])
JOINTS = START + np.array(
    [[0.3, 0.2, -0.2, 0.1, 0.2], [-0.4, 0.1, 0.1, 0.2, 0.5], [0.1, -0.2, 0.3, -0.3, 0.0]]
)
TARGETS = Targets.from_joints(JOINTS)


@pytest.fixture(scope="module")
def planned():
    return plan(TARGETS, START)


def test_the_tool_visits_every_target_in_the_order_that_it_says(planned):
    wanted = TARGETS.poses[planned.order][:, :3, 3]
    ends = [segment.end for segment in planned.trajectory.segments]
    q, _, _ = interpolate(planned.trajectory, ends)
    np.testing.assert_allclose(ARM.forward_kinematics(q)[:, :3, 3], wanted, atol=1e-6)


def test_it_begins_where_the_arm_is(planned):
    np.testing.assert_array_equal(planned.trajectory.positions[0], START)


def test_the_plan_shows_the_waypoints_of_the_course(planned):
    assert planned.poses.shape == (3 * 11 + 1, 4, 4)
    np.testing.assert_allclose(planned.poses[::11], planned.checkpoints, atol=1e-15)


def test_auto_takes_the_pseudo_inverse_where_it_tracks_the_whole_path(planned):
    assert planned.solver == "pseudo_inverse"
    assert "tracked" in planned.solver_reason


def test_auto_takes_the_closed_form_where_the_pseudo_inverse_fails_and_says_why():
    behind = Targets.from_joints([[2.9, 1.2, -2.0, 2.2, 2.9], [5.5, 2.5, -4.5, 1.0, 2.0]])
    planned = plan(behind, np.zeros(5))
    assert planned.solver == "closed_form"
    assert planned.solver_reason.startswith("pseudo_inverse failed: waypoint 1")
    assert planned.report.passed


@pytest.mark.parametrize("solver", ["pseudo_inverse", "closed_form"])
def test_a_solver_that_is_asked_for_is_the_one_that_runs(solver):
    planned = plan(TARGETS, START, Parameters(solver=solver))
    assert (planned.solver, planned.solver_reason) == (solver, "as asked for")


@pytest.mark.parametrize("timing", ["cubic", "optimal"])
def test_both_timings_use_the_limits_and_keep_them(timing):
    report = plan(TARGETS, START, Parameters(timing=timing)).report
    assert 0.9 < max(report.velocity_fraction, report.acceleration_fraction) <= 1.0


def test_joint_targets_are_ended_at_on_request():
    planned = plan(TARGETS, START, Parameters(checkpoint="joints", reconfigure=True))
    stops = np.array([s.end for s in planned.trajectory.segments])
    q, _, _ = interpolate(planned.trajectory, stops)
    for joints in JOINTS:
        assert np.abs(q - joints).max(axis=1).min() < 1e-9


def test_pose_targets_are_met_exactly_on_request():
    planned = plan(Targets.from_poses(TARGETS.poses), START, Parameters(checkpoint="pose"))
    assert max(planned.report.checkpoint_distances) < 1e-6
    assert max(planned.report.checkpoint_angles) < 1e-6


def test_a_pose_that_the_arm_cannot_take_is_met_in_position_and_named():
    sideways = TARGETS.poses.copy()
    sideways[1, :3, :3] = sideways[1, :3, :3] @ np.array([[1, 0, 0], [0, 0, -1], [0, 1, 0]])
    planned = plan(Targets.from_poses(sideways), START, Parameters(checkpoint="pose"))
    assert planned.met_in_position_only.tolist() == [1]
    assert max(planned.report.checkpoint_distances) < 1e-6
    assert any("targets 2: the arm cannot" in line for line in summary(planned))


def test_poses_have_no_joints_to_be_met():
    with pytest.raises(InputError, match="choose checkpoint pose or position"):
        plan(Targets.from_poses(TARGETS.poses), START, Parameters(checkpoint="joints"))


def test_a_tour_can_return_home():
    planned = plan(TARGETS, START, Parameters(return_home=True, checkpoint="joints"))
    assert len(planned.checkpoints) == 5
    np.testing.assert_allclose(planned.trajectory.positions[-1], START, atol=1e-12)


def test_the_length_is_that_of_the_tool_s_way(planned):
    corners = planned.checkpoints[:, :3, 3]
    assert planned.length == pytest.approx(np.linalg.norm(np.diff(corners, axis=0), axis=1).sum())


def test_the_bag_s_order_is_kept_on_request():
    assert plan(TARGETS, START, Parameters(order="given")).order.tolist() == [0, 1, 2]


def test_kdl_plans_the_same_as_the_table(planned):
    pytest.importorskip("PyKDL")
    pytest.importorskip("urdf_parser_py")
    by_kdl = plan(TARGETS, START, Parameters(kinematics="kdl"))
    assert by_kdl.solver == planned.solver == "pseudo_inverse"
    np.testing.assert_allclose(by_kdl.trajectory.positions, planned.trajectory.positions, atol=1e-6)


def test_the_hardware_limits_are_kept_when_asked_for():
    from youbot_kinematics import joint_limits

    hardware = plan(TARGETS, START, Parameters(limits="hardware"))
    assert joint_limits("hardware").contain(hardware.trajectory.positions).all()


def test_a_start_outside_of_the_limits_is_refused_with_the_joint():
    with pytest.raises(InputError, match=r"arm_joint_3 at 0\.5"):
        plan(TARGETS, [0, 0, 0.5, 0, 0])


def test_a_start_on_a_limit_by_a_hair_is_taken():
    targets = Targets.from_joints(np.clip(START - [0, 0, 0, 0, 2.8], 0, None)[None] * 0 + START)
    on_limit = START * [1, 1, 1, 1, 0] - [0, 0, 0, 0, 1e-7]
    assert plan(targets, on_limit).trajectory.positions[0, 4] == 0.0


def test_a_target_at_the_start_takes_no_time():
    planned = plan(Targets.from_joints(START[None]), START)
    assert planned.trajectory.duration == 0.0
    assert planned.report.passed


@pytest.mark.parametrize(
    ("solver", "sentence"),
    [
        ("pseudo_inverse", r"waypoint \d+ at .* arm_joint_\d"),
        ("auto", r"checkpoint 1 at \(0.9000, 0.0000, 0.3000\) m is out of reach"),
    ],
)
def test_an_unreachable_target_is_refused_with_where_it_is(solver, sentence):
    far = np.eye(4)
    far[:3, 3] = [0.9, 0, 0.3]
    with pytest.raises(PlanningError, match=sentence):
        plan(Targets.from_poses([far]), START, Parameters(solver=solver))


def test_more_targets_or_waypoints_than_can_be_planned_are_refused_at_once():
    many = Targets.from_joints(random_joints(100_000, 1, ARM.limits))
    with pytest.raises(InputError, match="100,000 targets: at most 2,000"):
        plan(many, START)
    few = Targets.from_joints(random_joints(100, 1, ARM.limits))
    with pytest.raises(InputError, match="1,000,100 waypoints: at most 200,000"):
        plan(few, START, Parameters(num_points=10_000))


def test_an_orientation_to_follow_is_not_left_to_the_pseudo_inverse():
    planned = plan(TARGETS, START, Parameters(orientation_weight=1.0))
    assert planned.solver == "closed_form" and "orientation_weight" in planned.solver_reason
