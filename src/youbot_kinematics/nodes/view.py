"""What RViz shows of a plan: checkpoints, path, segments, and the arm's ghost at the goal."""

from __future__ import annotations

import rospy
from nav_msgs.msg import Path
from visualization_msgs.msg import MarkerArray

from ..exceptions import InputError
from ..interface import CHECKPOINTS, GOAL, PATH, SEGMENTS
from ..messages import checkpoint_markers, ghost_markers, path_message, segment_markers
from ..planner import Plan
from ..shapes import arm_shapes, shape_poses
from ..track import tool_tracks


class View:
    """The topics of a plan, latched: whoever looks later sees it as well."""

    def __init__(self):
        def latched(channel, kind):
            return rospy.Publisher(channel.name, kind, queue_size=1, latch=True)

        self._checkpoints = latched(CHECKPOINTS, MarkerArray)
        self._path = latched(PATH, Path)
        self._segments = latched(SEGMENTS, MarkerArray)
        self._goal = latched(GOAL, MarkerArray)

    def show(self, planned: Plan) -> None:
        """Publishes a plan, in the place of the one before."""
        self._checkpoints.publish(checkpoint_markers(planned.checkpoints[1:]))
        self._path.publish(path_message(planned.poses))
        self._segments.publish(segment_markers(tool_tracks(planned.trajectory)))
        try:
            shapes = arm_shapes()
        except InputError as error:  # a plan is as good without
            rospy.logwarn("the arm at the goal is not shown: %s", error)
            return
        poses = shape_poses(shapes, planned.trajectory.positions[-1])
        self._goal.publish(ghost_markers(shapes, poses))
