"""The node ``planner_node``: from a bag's targets to one trajectory for the arm's controller.

It plans from where the arm stands, shows the checkpoints and the path, sends the trajectory once a
controller listens, and then stays for the service ``~replan``, which plans again from where the arm
stands by then. While the arm moves nothing is planned: every trajectory starts at rest.
"""

from __future__ import annotations

import threading

import numpy as np
import rospy
from std_srvs.srv import Trigger, TriggerResponse
from trajectory_msgs.msg import JointTrajectory

from .. import arm
from ..exceptions import YoubotError
from ..interface import REPLAN, NodeParameters
from ..messages import trajectory_message
from ..planner import Plan, plan
from ..progress_bar import logged
from ..summary import summary
from ..targets import load_targets
from .common import COMMAND_TOPIC, wait_for
from .frames import T_base_from
from .joint_states import JointStates
from .master import other_publishers
from .view import View

#: How far the arm may be from a trajectory's first point when it is sent, rad.
START_TOLERANCE = 0.02

# How long ``~replan`` gives an arm that has just stopped to prove that it stands, s.
MOMENT = 0.5


class NotSentError(YoubotError):
    """There is a trajectory, but it could not, or must not, be handed to the controller."""


class PlannerNode:
    """Topics, service and state of the node; planning itself is in ``planner``.

    Args:
        parameters: of the node.
        joint_states: where the arm is.

    Raises:
        BagError: the bag has no usable targets.
    """

    def __init__(self, parameters: NodeParameters, joint_states: JointStates):
        self.parameters = parameters
        self.targets = load_targets(
            parameters.bag, parameters.topic, parameters.limits, T_base_from
        )
        if self.targets.warning:
            rospy.logwarn("%s", self.targets.warning)
        self._busy = threading.Lock()
        self._joint_states = joint_states
        # Not latched, or the arm would move again each time that a controller connects.
        self._command = rospy.Publisher(COMMAND_TOPIC, JointTrajectory, queue_size=1)
        self._view = View()

    def run(self) -> None:
        """Plans, sends, and serves ``~replan`` until ROS shuts down.

        Raises:
            InputError, PlanningError: there is nothing to send.
            NotSentError: it could not be sent.
        """
        self._plan_and_send(self._first_start())
        rospy.Service(REPLAN.name, Trigger, self._replan)
        rospy.spin()

    def _first_start(self) -> np.ndarray:
        """Where the first trajectory starts, (5,) rad: as given, as measured, or all zeros."""
        if self.parameters.start is not None:
            return np.array(self.parameters.start)
        states, timeout = self._joint_states, self.parameters.start_timeout
        here = wait_for(states.standing, timeout)
        if here is not None:
            return here
        if states.position() is not None:
            raise NotSentError(f"the arm has not stood still in {timeout:g} s: nothing is planned")
        if states.problem:
            raise NotSentError(f"the arm's joint states are of no use: {states.problem}")
        came = f"{states.others} without all of the arm's" if states.others else "no"
        rospy.logwarn("%s joint states in %g s: assuming that all are zero", came, timeout)
        return np.zeros(arm.DOF)

    def _plan_and_send(self, start: np.ndarray) -> Plan:
        with logged(rospy.loginfo):
            planned = plan(self.targets, start, self.parameters)
        for line in summary(planned):
            rospy.loginfo("%s", line)
        self._view.show(planned)
        self._send(planned)
        return planned

    def _send(self, planned: Plan) -> None:
        """Publishes the trajectory once a controller listens, if the arm is where it starts."""
        topic, timeout = self._command.resolved_name, self.parameters.subscriber_timeout
        if not wait_for(lambda: self._command.get_num_connections() or None, timeout):
            raise NotSentError(f"no controller listened on {topic} within {timeout:g} s: not sent")
        self._require_at(planned.start)
        others = other_publishers(topic)
        if others:
            rospy.logwarn("%s can move the arm too: the last one heard does", ", ".join(others))
        self._joint_states.expect_motion()
        self._command.publish(trajectory_message(planned.trajectory))
        rospy.loginfo("sent %d points to %s", len(planned.trajectory.times), topic)

    def _require_at(self, start: np.ndarray) -> None:
        """Raises NotSentError if the arm is known to move, or to be somewhere else."""
        here = wait_for(self._joint_states.standing, MOMENT)
        if here is None and self._joint_states.position() is not None:
            raise NotSentError("not sent: the arm has begun to move, by another's command")
        if here is not None and np.abs(here - start).max() > START_TOLERANCE:
            i = int(np.argmax(np.abs(here - start)))
            raise NotSentError(
                f"not sent: {arm.JOINT_NAMES[i]} is at {here[i]:.4f} rad, and the trajectory starts"
                f" at {start[i]:.4f} rad"
            )

    def _replan(self, _request) -> TriggerResponse:
        """Serves ``~replan``: the tour again, from where the arm stands now."""
        if not self._busy.acquire(blocking=False):
            return TriggerResponse(False, "refused: already planning")
        try:
            planned = self._plan_and_send(self._measured_start())
        except YoubotError as error:
            rospy.logwarn("replan: %s", error)
            return TriggerResponse(False, str(error))
        except rospy.ROSException:
            return TriggerResponse(False, "the node is ending")
        finally:
            self._busy.release()
        message = f"{len(planned.targets)} targets in {planned.trajectory.duration:.2f} s"
        return TriggerResponse(True, message)

    def _measured_start(self) -> np.ndarray:
        here = wait_for(self._joint_states.standing, MOMENT)
        if here is not None:
            return here
        if self._joint_states.position() is not None:
            raise NotSentError("refused: the arm is moving; ask again when it stands still")
        problem = self._joint_states.problem or "none come"
        raise NotSentError(f"refused: where the arm is is unknown, for its joint states: {problem}")
