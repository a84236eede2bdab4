"""The ROS master, which may be missing at first and gone at any moment."""

from __future__ import annotations

import sys
import threading
import time

import rosgraph
import rospy

from .ending import Ending

# The master is gone when it has not answered so many times, so many s apart.
_MISSES, _PERIOD = 2, 1.0


class MasterWatch:
    """Ends the node once its master is gone: no one could find the node any more.

    A node that is registering would wait for a new master for ever.

    Args:
        name: of the node.
        status: what it exits with.
        ending: how it is ended.
    """

    def __init__(self, name: str, status: int, ending: Ending):
        self._name, self._status, self._ending = name, status, ending
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
            self._ending.begin("the ROS master is gone", self._say_lost, self._status)

    def exit(self, sentence: str) -> None:
        """Ends the process with a sentence about the master.

        Raises:
            SystemExit: always.
        """
        self._say(sentence)
        sys.exit(self._status)

    def exit_since_lost(self) -> None:
        """Ends the process of a node whose master is gone.

        Raises:
            SystemExit: always.
        """
        self._say_lost()
        sys.exit(self._status)

    def _say_lost(self) -> None:
        self._say(f"the ROS master at {self.uri} is gone: ended")

    def _say(self, sentence: str) -> None:
        print(f"{self._name}: {sentence}", file=sys.stderr, flush=True)


def other_publishers(topic: str) -> list[str]:
    """Names of the nodes that publish on a topic besides this one; none if no master answers."""
    try:
        publishers, _, _ = rosgraph.Master(rospy.get_name()).getSystemState()
    except (OSError, rosgraph.MasterException):
        return []
    return sorted(set(dict(publishers).get(topic, [])) - {rospy.get_name()})
