"""The node ``tool_trail``: the way that the tool has really gone, for RViz.

It comes from the joint states alone, so that it can be held against what was planned. A new plan
begins a new trail.
"""

from __future__ import annotations

import threading

import numpy as np
import rospy
from nav_msgs.msg import Path
from sensor_msgs.msg import JointState
from visualization_msgs.msg import Marker

from ..interface import TRAIL, TrailParameters
from ..kinematics import YoubotKinematics
from ..messages import trail_marker
from ..state_messages import joints_from_message
from .common import JOINT_STATES_TOPIC, PATH_TOPIC, read_parameters, run_node


class ToolTrail:
    """Listens to the joint states, and publishes ``tool_trail``."""

    def __init__(self, parameters: TrailParameters):
        self._parameters = parameters
        self._kinematics = YoubotKinematics()
        self._lock = threading.Lock()  # between the topics' threads and the loop
        self._points: list[np.ndarray] = []  # (3,) m
        self._grown = False
        self._trail = rospy.Publisher(TRAIL.name, Marker, queue_size=1, latch=True)
        rospy.Subscriber(JOINT_STATES_TOPIC, JointState, self._take, queue_size=10)
        rospy.Subscriber(PATH_TOPIC, Path, self._begin, queue_size=1)

    def spin(self) -> None:
        """Publishes the trail whenever it has grown, until ROS shuts down."""
        rate = rospy.Rate(self._parameters.rate, reset=True)
        while not rospy.is_shutdown():
            with self._lock:
                points, grown, self._grown = self._points, self._grown, False
            if grown:
                self._trail.publish(trail_marker(np.array(points).reshape(-1, 3)))
            rate.sleep()

    def _take(self, message: JointState) -> None:
        joints = joints_from_message(message)
        if joints is None:
            return
        point = self._kinematics.forward_kinematics(joints)[:3, 3]
        with self._lock:
            before = self._points[-1:]
            if before and np.linalg.norm(point - before[0]) < self._parameters.spacing:
                return
            self._points = [*self._points[1 - self._parameters.points :], point]
            self._grown = True

    def _begin(self, _path: Path) -> None:
        with self._lock:
            self._points, self._grown = self._points[-1:], True


def main() -> None:
    run_node("tool_trail", lambda: ToolTrail(read_parameters(TrailParameters.from_dict)).spin())
