"""Laws that hold for any joints, targets and tours, across modules."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from youbot_kinematics import arm
from youbot_kinematics.contract import command_from_trajectory, shape_problems
from youbot_kinematics.exceptions import PlanningError
from youbot_kinematics.export import write_plan
from youbot_kinematics.kinematics import YoubotKinematics
from youbot_kinematics.make_bag import FORMS, make_bag, random_joints
from youbot_kinematics.plan_reader import read_plan
from youbot_kinematics.planner import plan
from youbot_kinematics.targets import Targets, load_targets
from youbot_kinematics.tour import shortest_path

LIMITS = arm.joint_limits("urdf")
ARM = YoubotKinematics()
SEEDS = st.integers(0, 2**32 - 1)
INSIDE = st.tuples(*(st.floats(a, b) for a, b in zip(LIMITS.lower, LIMITS.upper)))


def about_joint_1(angle):
    """A turn about joint 1's axis, which is the z axis of base_link, (4, 4)."""
    T = np.eye(4)
    T[:3, :3] = Rotation.from_euler("z", angle).as_matrix()
    return T


@given(INSIDE, st.floats(-3, 3))
def test_a_turn_of_joint_1_turns_the_tool_about_its_axis(q, angle):
    turned = np.array(q) - [angle, 0, 0, 0, 0]  # its sign is -1
    expected = about_joint_1(angle) @ ARM.forward_kinematics(q)
    np.testing.assert_allclose(ARM.forward_kinematics(turned), expected, atol=1e-12)


@given(INSIDE, st.floats(-3, 3), st.floats(-3, 3))
def test_neither_joint_1_nor_joint_5_changes_how_near_a_singularity_is(q, one, five):
    turned = np.array(q) + [one, 0, 0, 0, five]
    values = [np.linalg.svd(ARM.get_jacobian(each), compute_uv=False) for each in (q, turned)]
    np.testing.assert_allclose(*values, atol=1e-12)


@given(INSIDE, st.floats(-1, 1))
def test_a_turn_of_joint_1_turns_every_answer_of_the_inverse(q, angle):
    turned = np.array(q) + [angle, 0, 0, 0, 0]
    if not LIMITS.contain(turned):
        return
    answers = ARM.inverse_kinematics(ARM.forward_kinematics(turned))
    assert np.abs(answers - turned).max(axis=1).min() < 1e-7


@given(SEEDS, st.integers(1, 8), st.floats(-np.pi, np.pi), st.booleans())
def test_a_turn_of_all_about_joint_1_keeps_the_length_of_the_tour(seed, n, angle, home):
    points = np.random.default_rng(seed).uniform(-0.5, 0.5, (n + 1, 3))
    turned = points @ about_joint_1(angle)[:3, :3].T
    lengths = [shortest_path(p[0], p[1:], home)[1] for p in (points, turned)]
    assert lengths[0] == pytest.approx(lengths[1], abs=1e-12)


@given(SEEDS, st.integers(2, 8))
def test_another_target_never_makes_the_tour_shorter(seed, n):
    points = np.random.default_rng(seed).uniform(-0.5, 0.5, (n + 1, 3))
    assert shortest_path(points[0], points[1:-1])[1] <= shortest_path(points[0], points[1:])[1]


@settings(max_examples=50)
@given(
    joints=st.lists(INSIDE, min_size=1, max_size=6),
    form=st.sampled_from(sorted(FORMS)),
    compression=st.sampled_from(["none", "bz2"]),
)
def test_targets_come_back_from_a_bag(tmp_path_factory, joints, form, compression):
    bag = tmp_path_factory.mktemp("laws") / "targets.bag"
    made = Targets.from_joints(joints)
    make_bag(bag, made, form, compression=compression)
    np.testing.assert_allclose(load_targets(bag).poses, made.poses, atol=1e-12)


@settings(max_examples=8)
@given(SEEDS, st.integers(1, 4))
def test_a_plan_keeps_its_promises_and_comes_back_from_its_file(tmp_path_factory, seed, n):
    start, *targets = random_joints(n + 1, seed, LIMITS)
    try:
        planned = plan(Targets.from_joints(targets), start)
    except PlanningError as error:
        assert str(error).isprintable()
        return
    trajectory, command = planned.trajectory, command_from_trajectory(planned.trajectory)
    assert shape_problems(command, LIMITS) == []
    np.testing.assert_allclose(trajectory.positions[0], start, atol=1e-12)
    end = ARM.forward_kinematics(trajectory.positions[-1])[:3, 3]
    np.testing.assert_allclose(end, planned.checkpoints[-1, :3, 3], atol=1e-6)

    path = tmp_path_factory.mktemp("laws") / "plan.json"
    write_plan(path, planned)
    read = read_plan(path)
    assert read.command.times == command.times and read.order == list(planned.order)
    np.testing.assert_array_equal(read.command.positions, command.positions)
    np.testing.assert_array_equal(read.command.accelerations, command.accelerations)
