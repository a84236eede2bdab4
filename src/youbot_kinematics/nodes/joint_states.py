"""Where the arm is, from the joint states on its topic, and whether it stands still there."""

from __future__ import annotations

import time

import numpy as np
import rospy
from sensor_msgs.msg import JointState

from .. import arm
from ..state_messages import joints_from_message
from .common import JOINT_STATES_TOPIC

# The arm stands once no joint has moved by STILL (rad) for SETTLED (s). Positions tell it better
# than velocities, which some drivers leave out and others fill with noise.
STILL, SETTLED = 0.001, 0.3
# What came longer ago than this (s), or is stamped so far from now, does not say where the arm is.
FRESH = 1.0


class JointStates:
    """Listens to joint states; those of a gripper or of wheels may come on the same topic.

    Attributes:
        others: how many messages were passed over, for lack of one of the arm's joints.
        problem: why the arm's newest state is of no use, or empty.
    """

    def __init__(self):
        self.others, self.problem = 0, ""
        self._newest = np.full(arm.DOF, np.nan)
        self._came = self._moved = -np.inf  # when it did last, s
        self._reference = np.full(arm.DOF, np.inf)  # where the arm was when it last moved, rad
        rospy.Subscriber(JOINT_STATES_TOPIC, JointState, self._take, queue_size=10)

    def position(self) -> np.ndarray | None:
        """Where the arm is, (5,) rad, or None if no complete state has come lately."""
        return self._newest if time.monotonic() - self._came < FRESH else None

    def standing(self) -> np.ndarray | None:
        """Where the arm is, (5,) rad, if it has stood there for a while; None otherwise."""
        return self.position() if time.monotonic() - self._moved > SETTLED else None

    def expect_motion(self) -> None:
        """The arm has just been told to move, and does not stand even if it has not begun to."""
        self._moved = time.monotonic()

    def _take(self, message: JointState) -> None:
        if not set(arm.JOINT_NAMES) <= set(message.name):
            self.others += 1
            return
        joints = joints_from_message(message)
        self.problem = _problem(message, joints)
        if self.problem:
            return
        now = time.monotonic()
        if np.abs(joints - self._reference).max() > STILL:
            self._reference, self._moved = joints, now
        self._newest, self._came = joints, now


def _problem(message: JointState, joints: np.ndarray | None) -> str:
    """Why a state with all of the arm's joints does not say where the arm is, or ''."""
    if joints is None:
        return "a joint is named twice, or has no value or none that is finite"
    if message.header.stamp.is_zero():  # of no known time, which is not a wrong one
        return ""
    age = (rospy.Time.now() - message.header.stamp).to_sec()
    if abs(age) <= FRESH:
        return ""
    return f"stamped {abs(age):.1f} s in the {'past' if age > 0 else 'future'}"
