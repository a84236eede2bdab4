"""Where the arm is, from the joint states on its topic, and whether it stands still there."""

from __future__ import annotations

import time

import numpy as np
import rospy
from sensor_msgs.msg import JointState

from .. import arm
from ..messages import joints_from_message
from .common import JOINT_STATES_TOPIC

# The arm stands once no joint has moved by STILL (rad) for SETTLED (s). Positions tell it better
# than velocities, which some drivers leave out and others fill with noise.
STILL, SETTLED = 0.001, 0.3
# What came longer ago than this (s) does not say where the arm is now.
FRESH = 1.0


class JointStates:
    """Listens to joint states; those of a gripper or of wheels may come on the same topic.

    Attributes:
        passed_over: how many messages were of no use, for lack of one of the arm's joints.
    """

    def __init__(self):
        self.passed_over = 0
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
        joints = joints_from_message(message)
        if joints is None:
            self.passed_over += 1
            return
        now = time.monotonic()
        if np.abs(joints - self._reference).max() > STILL:
            self._reference, self._moved = joints, now
        self._newest, self._came = joints, now
