"""The ROS master, which may be missing at first and gone at any moment."""

from __future__ import annotations

import threading
import time

import rosgraph
import rospy

# The master is gone when it has not answered so many times, so many s apart.
_MISSES, _PERIOD = 2, 1.0


class MasterWatch:
    """Ends the node once its master is gone: no one could find the node any more.

    A node that is registering would wait for a new master for ever.
    """

    def __init__(self):
        self.uri = rosgraph.get_master_uri()
        self._lost = threading.Event()

    @property
    def lost(self) -> bool:
        """Whether the node was ended for that."""
        return self._lost.is_set()

    def start(self) -> None:
        threading.Thread(target=self._watch, daemon=True).start()

    def _watch(self) -> None:
        misses = 0
        while misses < _MISSES and not rospy.is_shutdown():
            time.sleep(_PERIOD)
            misses = 0 if rosgraph.is_master_online() else misses + 1
        if misses == _MISSES and not rospy.is_shutdown():
            self._lost.set()
            rospy.signal_shutdown("the ROS master is gone")


def other_publishers(topic: str) -> list[str]:
    """Names of the nodes that publish on a topic besides this one; none if no master answers."""
    try:
        publishers, _, _ = rosgraph.Master(rospy.get_name()).getSystemState()
    except (OSError, rosgraph.MasterException):
        return []
    return sorted(set(dict(publishers).get(topic, [])) - {rospy.get_name()})
