"""The node ``arm_simulator``: a stand-in for the arm and its controller, without Gazebo.

It takes trajectories from the controller's topic, refuses what a controller or the real arm's
driver would (``contract``), moves as the controller would (``controller``), and publishes the state
of the joints.

Its clock is ROS time, as the controller's is: where the clock is simulated the arm stops with it,
and the stamps of its joint states fit the motion. A clock that jumps back does not make the arm
jump: it goes on from where it is.
"""

from __future__ import annotations

import threading

import numpy as np
import rospy
from sensor_msgs.msg import JointState
from trajectory_msgs.msg import JointTrajectory

from .. import arm
from ..controller import Controller
from ..exceptions import InputError
from ..interface import SimulatorParameters
from ..messages import command_from_message
from ..state_messages import joint_state_message
from .common import COMMAND_TOPIC, JOINT_STATES_TOPIC, read_parameters, run_node


class ArmSimulator:
    """The arm under its controller, on the controller's topics.

    Raises:
        InputError: it cannot stand where it is told to.
    """

    def __init__(self, parameters: SimulatorParameters):
        limits = arm.joint_limits(parameters.limits)
        self._controller = Controller(np.array(parameters.start), limits)
        self._lock = threading.Lock()  # between the topic's thread and the loop
        self._elapsed, self._seen = 0.0, rospy.Time.now()
        self._rate = rospy.Rate(parameters.rate, reset=True)
        self._states = rospy.Publisher(JOINT_STATES_TOPIC, JointState, queue_size=10)
        rospy.Subscriber(COMMAND_TOPIC, JointTrajectory, self._take)

    def spin(self) -> None:
        """Publishes where the arm is until ROS shuts down."""
        while not rospy.is_shutdown():
            with self._lock:
                position, velocity, _ = self._controller.state(self._now())
                stamp = self._seen
            self._states.publish(joint_state_message(stamp, position, velocity))
            self._rate.sleep()

    def _now(self) -> float:
        """The controller's time in s: ROS time as far as it goes forward."""
        seen = rospy.Time.now()
        self._elapsed += max(0.0, (seen - self._seen).to_sec())
        self._seen = seen
        return self._elapsed

    def _take(self, message: JointTrajectory) -> None:
        command = command_from_message(message)
        with self._lock:
            now = self._now()
            delay = (message.header.stamp - self._seen).to_sec() if command.stamp else 0.0
            try:
                dropped = self._controller.command(command, now, now + delay)
            except InputError as error:
                rospy.logerr("refused a trajectory: %s", error)
                return
        if not command.times:
            rospy.loginfo("stopping: the trajectory has no points")
        else:
            duration = message.points[-1].time_from_start.to_sec()
            rospy.loginfo("running a trajectory: %d points, %.2f s", len(command.times), duration)
        if dropped:
            rospy.logwarn("dropped %d points that lie in the past", dropped)


def main() -> None:
    run_node(
        "arm_simulator", lambda: ArmSimulator(read_parameters(SimulatorParameters.from_dict)).spin()
    )
