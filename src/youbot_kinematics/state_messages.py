"""The arm's joints <-> ``sensor_msgs/JointState``; apart from ``messages``, since it loads fast."""

from __future__ import annotations

import genpy
import numpy as np
from sensor_msgs.msg import JointState

from . import arm


def joint_state_message(stamp: genpy.Time, positions, velocities) -> JointState:
    """State of the arm's joints at a time: positions (5,) rad, velocities (5,) rad/s."""
    message = JointState(name=list(arm.JOINT_NAMES))
    message.header.stamp = stamp
    message.position, message.velocity = list(positions), list(velocities)
    return message


def joints_from_message(message: JointState, field: str = "position") -> np.ndarray | None:
    """The arm's five joints of a message that may have others (wheels, gripper), in any order.

    Args:
        message: names, and a value of ``field`` for each.
        field: ``"position"`` (rad) or ``"velocity"`` (rad/s).

    Returns:
        (5,) in the arm's order, or None: a joint is missing or named twice, the numbers of names
        and values differ, or a value is not finite.
    """
    names, values = list(message.name), getattr(message, field)
    if len(names) != len(values) or any(names.count(name) != 1 for name in arm.JOINT_NAMES):
        return None
    joints = np.array([values[names.index(name)] for name in arm.JOINT_NAMES], dtype=float)
    return joints if np.isfinite(joints).all() else None
