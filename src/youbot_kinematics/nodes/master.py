"""The ROS master, which may be missing at first and gone at any moment."""

from __future__ import annotations

import os
import sys
import threading
import time

import rosgraph
import rospy

# The master is gone when it has not answered so many times, so many s apart.
_MISSES, _PERIOD = 2, 1.0
# s. How long a node may take to end once it is told to, before it is ended.
_GRACE = 5.0


class MasterWatch:
    """Ends the node once its master is gone: no one could find the node any more.

    A node that is registering would wait for a new master for ever, and one that is in the middle
    of a call may not even take notice of being told to end: such a one is ended here.

    Args:
        name: of the node.
        status: what it exits with.
    """

    def __init__(self, name: str, status: int):
        self._name, self._status = name, status
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
            threading.Thread(target=self._end, daemon=True).start()
            rospy.signal_shutdown("the ROS master is gone")

    def exit(self, sentence: str) -> None:
        """Ends the process with a sentence about the master.

        Raises:
            SystemExit: always.
        """
        print(f"{self._name}: {sentence}", file=sys.stderr, flush=True)
        sys.exit(self._status)

    def exit_since_lost(self) -> None:
        """Ends the process of a node whose master is gone.

        Raises:
            SystemExit: always.
        """
        self.exit(f"the ROS master at {self.uri} is gone: ended")

    def _end(self) -> None:
        time.sleep(_GRACE)
        try:
            self.exit_since_lost()
        finally:
            os._exit(self._status)  # a thread cannot end the others any other way


def other_publishers(topic: str) -> list[str]:
    """Names of the nodes that publish on a topic besides this one; none if no master answers."""
    try:
        publishers, _, _ = rosgraph.Master(rospy.get_name()).getSystemState()
    except (OSError, rosgraph.MasterException):
        return []
    return sorted(set(dict(publishers).get(topic, [])) - {rospy.get_name()})
