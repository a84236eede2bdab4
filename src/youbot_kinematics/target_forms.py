"""The messages that can hold targets, and how to take the targets out of each.

``FORMS`` is the table: another form is one more function and one more row. A target is an array:
(5,) joint positions in rad, or (4, 4), a pose of ``arm_link_ee`` in m, and with it goes the name of
the frame that the pose is given in, empty where there is none to name.
"""

from __future__ import annotations

from typing import Iterator, Tuple

import numpy as np
from scipy.spatial.transform import Rotation

from . import arm
from .exceptions import BagError
from .kinematics import as_joints

# A quaternion whose norm is this near to 1 was rounded; farther off, it is something else.
_NORM_ROUNDING = 1e-3

Target = Tuple[str, np.ndarray]  # frame, and (5,) or (4, 4)


def joint_state(message) -> Iterator[Target]:
    """sensor_msgs/JointState: one target, by name if it has names."""
    yield "", arm_positions(message.name, message.position)


def joint_trajectory(message) -> Iterator[Target]:
    """trajectory_msgs/JointTrajectory: one target a point."""
    for point in message.points:
        yield "", arm_positions(message.joint_names, point.positions)


def pose(message) -> Iterator[Target]:
    """geometry_msgs/Pose: one target."""
    yield "", transform_matrix(message.position, message.orientation)


def pose_stamped(message) -> Iterator[Target]:
    """geometry_msgs/PoseStamped: one target."""
    yield in_frame(message.header, message.pose.position, message.pose.orientation)


def pose_array(message) -> Iterator[Target]:
    """geometry_msgs/PoseArray: one target a pose."""
    for each in message.poses:
        yield in_frame(message.header, each.position, each.orientation)


def path(message) -> Iterator[Target]:
    """nav_msgs/Path: one target a pose, each with its own header."""
    for each in message.poses:
        yield from pose_stamped(each)


def transform(message) -> Iterator[Target]:
    """geometry_msgs/Transform: one target."""
    yield "", transform_matrix(message.translation, message.rotation)


def transform_stamped(message) -> Iterator[Target]:
    """geometry_msgs/TransformStamped: one target; the name of the child frame is free."""
    yield in_frame(message.header, message.transform.translation, message.transform.rotation)


#: Message type -> the function that yields the targets in a message, or raises InputError.
FORMS = {
    "sensor_msgs/msg/JointState": joint_state,
    "trajectory_msgs/msg/JointTrajectory": joint_trajectory,
    "geometry_msgs/msg/Pose": pose,
    "geometry_msgs/msg/PoseStamped": pose_stamped,
    "geometry_msgs/msg/PoseArray": pose_array,
    "geometry_msgs/msg/Transform": transform,
    "geometry_msgs/msg/TransformStamped": transform_stamped,
    "nav_msgs/msg/Path": path,
}


def arm_positions(names, positions) -> np.ndarray:
    """The arm's five positions (5,) in rad out of a message's: by name, where it has names.

    Raises:
        BagError: an arm joint is missing or named twice, or the numbers of values do not fit.
        InputError: a value is not finite.
    """
    names = list(names)
    if not names and len(positions) != arm.DOF:
        raise BagError(f"{len(positions)} positions without names, instead of {arm.DOF}")
    if not names:
        return as_joints(positions)
    if len(names) != len(positions):
        raise BagError(f"{len(positions)} positions for {len(names)} joint names")
    for joint in arm.JOINT_NAMES:
        if names.count(joint) != 1:
            problem = "named twice" if joint in names else "missing"
            raise BagError(f"{joint} is {problem} in {', '.join(names)}")
    return as_joints([positions[names.index(joint)] for joint in arm.JOINT_NAMES])


def transform_matrix(position, orientation) -> np.ndarray:
    """Homogeneous transform (4, 4) from a message's point (m) and quaternion.

    Raises:
        BagError: a value is not finite, or the quaternion's norm is off 1 by more than rounding.
    """
    p = np.array([position.x, position.y, position.z])
    q = np.array([orientation.x, orientation.y, orientation.z, orientation.w])
    if not (np.isfinite(p).all() and np.isfinite(q).all()):
        raise BagError(f"not finite: position {p}, quaternion (x y z w) {q}")
    norm = float(np.linalg.norm(q))
    if abs(norm - 1.0) > _NORM_ROUNDING:
        raise BagError(f"quaternion (x y z w) {q} has norm {norm:.6g} instead of 1")
    T = np.eye(4)
    T[:3, :3] = Rotation.from_quat(q).as_matrix()  # which normalises it
    T[:3, 3] = p
    return T


def in_frame(header, position, orientation) -> Target:
    """A pose in the frame of a message's header.

    Raises:
        BagError: from ``transform_matrix``.
    """
    return header.frame_id.lstrip("/"), transform_matrix(position, orientation)
