"""The classes of UCL COMP0127's coursework 2, by its template's names, over this package.

A course's node can import these in the place of its own, and a student can compare with them.
Names, signatures and array layouts are the template's: poses are stacked along the last axis,
4x4xN, and joint positions are columns, 5xN. What they compute is the package's own, so it keeps the
joint limits and says what cannot be reached. There is no ROS in here: what publishes, subscribes or
broadcasts is the node's.
"""

from __future__ import annotations

import numpy as np

from . import arm, differential, path, tour
from .exceptions import InputError
from .kdl import YoubotKDL
from .kinematics import Kinematics, YoubotKinematics
from .resources import resource_path
from .targets import load_targets


class YoubotKinematicBase:
    """What both kinematics of the template have: joint positions are lists or (5,) arrays, rad."""

    def __init__(self, tf_suffix: str, kinematics: Kinematics, limits: arm.JointLimits):
        self.tf_suffix = tf_suffix
        self.kinematics = kinematics
        self.current_joint_position = [0.0] * arm.DOF
        self.joint_limit_min, self.joint_limit_max = limits.lower, limits.upper
        self.dh_params = {
            "a": arm.A.tolist(),
            "alpha": arm.ALPHA.tolist(),
            "d": arm.D.tolist(),
            "theta": (arm.THETA_0 + arm.OFFSET).tolist(),
        }
        self.youbot_joint_readings_polarity = arm.SIGN.tolist()

    def forward_kinematics(self, joints_readings, up_to_joint=5) -> np.ndarray:
        """Pose (4, 4) of frame ``up_to_joint``, 0 to 5, in ``base_link``, m."""
        return self.kinematics.forward_kinematics(joints_readings, up_to_joint)

    def get_jacobian(self, joint) -> np.ndarray:
        """Geometric Jacobian (6, 5) of the tool in ``base_link``, linear over angular velocity."""
        return self.kinematics.get_jacobian(joint)

    def check_singularity(self, joint) -> bool:
        """Whether the Jacobian (6, 5) loses rank there."""
        return self.kinematics.check_singularity(joint)


class YoubotKinematicStudent(YoubotKinematicBase):
    """Question 4: kinematics from the Denavit-Hartenberg table."""

    def __init__(self):
        kinematics = YoubotKinematics()
        super().__init__("student", kinematics, kinematics.limits)


class YoubotKinematicKDL(YoubotKinematicBase):
    """The template's reference: kinematics from the URDF, computed by KDL.

    Raises:
        InputError: KDL or the URDF's parser is missing.
    """

    def __init__(self, tf_suffix="kdl"):
        kinematics = YoubotKDL()
        super().__init__(tf_suffix, kinematics, kinematics.limits)

    @staticmethod
    def list_to_kdl_jnt_array(joints):
        """Five joint positions as KDL's JntArray."""
        return _kdl_joint_array(joints)

    @staticmethod
    def kdl_jnt_array_to_list(kdl_array) -> list:
        """KDL's JntArray as a list of five."""
        return [kdl_array[i] for i in range(arm.DOF)]


class YoubotTrajectoryPlanning:
    """Question 6, but for what needs ROS: ``q6``, ``run`` and ``publish_traj_tfs``.

    Args:
        bag: path of a bag of joint targets; the package's own if not given.
        kdl_youbot: kinematics, as above; ``YoubotKinematicStudent`` if not given.
    """

    def __init__(self, bag=None, kdl_youbot: YoubotKinematicBase | None = None):
        self.bag = resource_path("bags/demo.bag") if bag is None else bag
        self.kdl_youbot = YoubotKinematicStudent() if kdl_youbot is None else kdl_youbot

    def load_targets(self):
        """The arm's current position, then the targets of the bag.

        Returns:
            ``(target_cart_tf, target_joint_positions)``: poses (4, 4, N), m; joints (5, N), rad.

        Raises:
            BagError: the bag has no usable targets.
            InputError: it has poses, and no joint positions.
        """
        targets = load_targets(self.bag)
        if targets.joints is None:
            raise InputError(f"{targets.source} has poses, and joint positions are asked for")
        joints = np.vstack([np.ravel(self.kdl_youbot.current_joint_position), targets.joints])
        poses = [self.kdl_youbot.forward_kinematics(q) for q in joints]
        return np.stack(poses, axis=-1), joints.T

    def get_shortest_path(self, checkpoints_tf):
        """The order of least length through checkpoints (4, 4, N), from the first, and that length.

        Returns:
            ``(sorted_order, min_dist)``: (N,) of which the first is 0, and m.
        """
        positions = np.asarray(checkpoints_tf)[:3, 3].T
        order, length = tour.shortest_path(positions[0], positions[1:])
        return np.append(0, order + 1), length

    def intermediate_tfs(self, sorted_checkpoint_idx, target_checkpoint_tfs, num_points):
        """The whole way through checkpoints (4, 4, N) in an order, each checkpoint once.

        Returns:
            (4, 4, (N - 1) * (num_points + 1) + 1), m.
        """
        poses = _first_axis(target_checkpoint_tfs)
        return _last_axis(path.intermediate_tfs(sorted_checkpoint_idx, poses, num_points))

    def decoupled_rot_and_trans(self, checkpoint_a_tf, checkpoint_b_tf, num_points):
        """Poses (4, 4, num_points) between two poses (4, 4), without the two themselves, m."""
        poses = path.decoupled_rot_and_trans(checkpoint_a_tf, checkpoint_b_tf, num_points)
        return _last_axis(poses)

    def full_checkpoints_to_joints(self, full_checkpoint_tfs, init_joint_position):
        """Joints (5, M), rad, along poses (4, 4, M) of which the first is that of the joints given.

        Raises:
            PlanningError: a pose cannot be reached from the one before inside the joint limits.
        """
        poses, q = _first_axis(full_checkpoint_tfs), np.ravel(init_joint_position)
        kinematics, limits = self._model()
        return differential.full_checkpoints_to_joints(kinematics, poses, q, limits).T

    def ik_position_only(self, pose, q0):
        """Joints that bring the tool to the position of a pose (4, 4), by the pseudo-inverse.

        Returns:
            ``(q, error)``: rad, in the shape of q0, and the distance that is left, m.
        """
        kinematics, limits = self._model()
        solution = differential.ik_position_only(kinematics, pose, np.ravel(q0), limits)
        return solution.joints.reshape(np.shape(q0)), solution.residual

    @staticmethod
    def list_to_kdl_jnt_array(joints):
        """Five joint positions as KDL's JntArray."""
        return _kdl_joint_array(joints)

    def _model(self):
        arm_model = self.kdl_youbot
        limits = arm.joint_limits("urdf")._replace(
            lower=arm_model.joint_limit_min, upper=arm_model.joint_limit_max
        )
        return arm_model.kinematics, limits


def _first_axis(tfs) -> np.ndarray:
    """Poses (4, 4, N) as the package has them, (N, 4, 4)."""
    return np.moveaxis(np.asarray(tfs, dtype=float), -1, 0)


def _last_axis(poses) -> np.ndarray:
    """Poses (N, 4, 4) as the template has them, (4, 4, N)."""
    return np.moveaxis(poses, 0, -1)


def _kdl_joint_array(joints):
    from PyKDL import JntArray  # here, since only these two methods know KDL's types

    array = JntArray(arm.DOF)
    for i, value in enumerate(joints):
        array[i] = value
    return array
