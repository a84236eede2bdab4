"""The course template's names, signatures and layouts, over the package's own functions."""

import inspect

import numpy as np
import pytest

from youbot_kinematics import (
    InputError,
    YoubotKinematics,
    coursework,
    differential,
    joint_limits,
    path,
    tour,
)
from youbot_kinematics.make_bag import make_bag
from youbot_kinematics.targets import Targets, load_targets

SIGNATURES = {
    "YoubotKinematicStudent": {
        "forward_kinematics": ["joints_readings", "up_to_joint"],
        "get_jacobian": ["joint"],
        "check_singularity": ["joint"],
    },
    "YoubotKinematicKDL": {
        "forward_kinematics": ["joints_readings", "up_to_joint"],
        "get_jacobian": ["joint"],
        "check_singularity": ["joint"],
        "list_to_kdl_jnt_array": ["joints"],
        "kdl_jnt_array_to_list": ["kdl_array"],
    },
    "YoubotTrajectoryPlanning": {
        "load_targets": [],
        "get_shortest_path": ["checkpoints_tf"],
        "intermediate_tfs": ["sorted_checkpoint_idx", "target_checkpoint_tfs", "num_points"],
        "decoupled_rot_and_trans": ["checkpoint_a_tf", "checkpoint_b_tf", "num_points"],
        "full_checkpoints_to_joints": ["full_checkpoint_tfs", "init_joint_position"],
        "ik_position_only": ["pose", "q0"],
        "list_to_kdl_jnt_array": ["joints"],
    },
}
Q = [0.5, 0.5, -2.0, 1.2, 0.6]
JOINTS = np.array(
    [[1.4, 0.4, -1.9, 1.0, 1.5], [0.9, 0.25, -1.8, 0.9, 1.0], [0.7, 0.6, -2.1, 1.1, 1.0]]
)


@pytest.fixture
def planning(tmp_path):
    make_bag(tmp_path / "data.bag", Targets.from_joints(JOINTS), "unnamed_joint_state")
    planning = coursework.YoubotTrajectoryPlanning(tmp_path / "data.bag")
    planning.kdl_youbot.current_joint_position = Q
    return planning


@pytest.fixture(params=["Student", "KDL"])
def youbot(request):
    if request.param == "KDL":
        pytest.importorskip("PyKDL")
        pytest.importorskip("urdf_parser_py")
    return getattr(coursework, "YoubotKinematic" + request.param)()


@pytest.mark.parametrize("name", SIGNATURES)
def test_classes_have_the_templates_methods_with_its_arguments(name):
    for method, arguments in SIGNATURES[name].items():
        function = getattr(getattr(coursework, name), method)
        found = [a for a in inspect.signature(function).parameters if a != "self"]
        assert found == arguments, method


def test_kinematics_take_lists_and_agree_with_the_package(youbot):
    own = YoubotKinematics()
    T, J = youbot.forward_kinematics(Q), youbot.get_jacobian(Q)
    assert T.shape == (4, 4) and J.shape == (6, 5)
    np.testing.assert_allclose(T, own.forward_kinematics(Q), atol=1e-9)
    np.testing.assert_allclose(J, own.get_jacobian(Q), atol=1e-9)
    assert youbot.check_singularity(Q) is False
    assert youbot.check_singularity([0, 0, np.deg2rad(-146), 1, 0]) is True
    np.testing.assert_array_equal(youbot.forward_kinematics(Q, up_to_joint=0), np.eye(4))


def test_the_students_table_gives_the_students_kinematics():
    youbot = coursework.YoubotKinematicStudent()
    dh, T = youbot.dh_params, np.eye(4)
    for i, sign in enumerate(youbot.youbot_joint_readings_polarity):
        theta = dh["theta"][i] + sign * Q[i]
        c, s, ca, sa = np.cos(theta), np.sin(theta), np.cos(dh["alpha"][i]), np.sin(dh["alpha"][i])
        a, d = dh["a"][i], dh["d"][i]
        T = T @ [
            [c, -s * ca, s * sa, a * c],
            [s, c * ca, -c * sa, a * s],
            [0, sa, ca, d],
            [0, 0, 0, 1],
        ]
    np.testing.assert_allclose(youbot.forward_kinematics(Q), T, atol=1e-12)


def test_targets_come_after_the_start_along_the_last_axis(planning):
    tfs, joints = planning.load_targets()
    assert tfs.shape == (4, 4, 4) and joints.shape == (5, 4)
    targets = load_targets(planning.bag)
    np.testing.assert_array_equal(joints[:, 0], Q)
    np.testing.assert_array_equal(joints[:, 1:], targets.joints.T)
    np.testing.assert_allclose(np.moveaxis(tfs[..., 1:], -1, 0), targets.poses, atol=1e-12)


def test_a_bag_of_poses_has_no_joints_to_give(tmp_path):
    make_bag(tmp_path / "poses.bag", Targets.from_joints(JOINTS), "pose_stamped")
    with pytest.raises(InputError, match="joint positions are asked for"):
        coursework.YoubotTrajectoryPlanning(tmp_path / "poses.bag").load_targets()


def test_the_shortest_path_is_the_packages_with_the_start_in_front(planning):
    tfs, _ = planning.load_targets()
    order, length = planning.get_shortest_path(tfs)
    own, own_length = tour.shortest_path(tfs[:3, 3, 0], tfs[:3, 3, 1:].T)
    assert isinstance(order, np.ndarray) and isinstance(length, float)
    assert order.tolist() == [0, *(own + 1)] and length == own_length


def test_the_steps_of_question_6_are_the_packages_in_the_templates_layout(planning):
    tfs, joints = planning.load_targets()
    order, _ = planning.get_shortest_path(tfs)
    full = planning.intermediate_tfs(order, tfs, 4)
    poses = path.intermediate_tfs(order, np.moveaxis(tfs, -1, 0), 4)
    assert full.shape == (4, 4, 3 * 5 + 1)
    np.testing.assert_array_equal(full, np.moveaxis(poses, 0, -1))

    between = planning.decoupled_rot_and_trans(tfs[..., 0], tfs[..., order[1]], 4)
    np.testing.assert_array_equal(between, full[..., 1:5])

    q = planning.full_checkpoints_to_joints(full, joints[:, 0])
    kinematics, limits = YoubotKinematics(), joint_limits("urdf")
    own = differential.full_checkpoints_to_joints(kinematics, poses, Q, limits)
    assert q.shape == (5, 16)
    np.testing.assert_array_equal(q, own.T)


@pytest.mark.parametrize("shape", [(5,), (5, 1)])
def test_position_only_inverse_kinematics_keeps_the_shape_of_its_start(planning, shape):
    pose = planning.kdl_youbot.forward_kinematics(JOINTS[0])
    q, error = planning.ik_position_only(pose, np.reshape(Q, shape))
    own = differential.ik_position_only(YoubotKinematics(), pose, Q, joint_limits("urdf"))
    assert q.shape == shape and isinstance(error, float)
    np.testing.assert_array_equal(q.ravel(), own.joints)
    assert error == own.residual < 1e-6


def test_lists_become_kdls_arrays_and_lists_again():
    pytest.importorskip("PyKDL")
    array = coursework.YoubotTrajectoryPlanning.list_to_kdl_jnt_array(Q)
    assert coursework.YoubotKinematicKDL.kdl_jnt_array_to_list(array) == Q
