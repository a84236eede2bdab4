"""What the nodes share: how they start, read their parameters, wait and end."""

from __future__ import annotations

import http.client
import sys
import time
import xmlrpc.client
from typing import Callable, TypeVar

import rosgraph
import rospy

from ..exceptions import InputError, YoubotError
from ..interface import COMMAND, JOINT_STATES, PATH
from .ending import Ending
from .master import MasterWatch

#: Where the controller of the course's simulation listens; relative, so that it can be remapped.
COMMAND_TOPIC = COMMAND.name
JOINT_STATES_TOPIC = JOINT_STATES.name
#: The planned way of the tool, for RViz.
PATH_TOPIC = PATH.name

T = TypeVar("T")

# Exit statuses; a node that is told to end while all is well exits with 0.
FAILED, BAD_INPUT = 1, 2

# What calls of rospy raise when the master goes in the middle of them.
_MASTER_ERRORS = (
    rospy.ROSException,
    rosgraph.MasterException,
    OSError,
    http.client.HTTPException,
    xmlrpc.client.Error,
)


class ShutdownError(YoubotError):
    """The node was told to end before its work was done."""


def run_node(name: str, body: Callable[[], None]) -> None:
    """Runs the body of a node and exits: what cannot be done is one logged sentence, no traceback.

    Exits with status 2 if what the node was given cannot be used, 1 for any other ``YoubotError``
    and where there is no ROS master, or none any more.
    """
    ending = Ending()
    ending.on_signals()
    watch = MasterWatch(name, FAILED, ending)
    if not rosgraph.is_master_online():
        watch.exit(f"there is no ROS master at {watch.uri}; roscore starts one")
    watch.start()
    try:
        rospy.init_node(name, disable_signals=True)  # ``Ending`` sees to them
        if not rospy.is_shutdown():
            body()
    except YoubotError as error:
        if not watch.lost:
            rospy.logfatal("%s", error)
            sys.exit(BAD_INPUT if isinstance(error, InputError) else FAILED)
    except _MASTER_ERRORS:
        # ROS raises these as well when it is told to end, which is no failure.
        if not rospy.is_shutdown() and rosgraph.is_master_online():
            raise
        if not rospy.is_shutdown():
            watch.exit_since_lost()
    finally:
        ending.wait()
    if watch.lost:
        watch.exit_since_lost()


def read_parameters(make: Callable[[dict], object]):
    """This node's private parameters through ``make``, which checks them.

    The parameter server keeps what a command line sets (``_name:=value``) after the node has ended.
    A run that is refused takes its own back, so that the next one is not refused for them as well.

    Raises:
        InputError: from ``make``.
    """
    try:
        return make(rospy.get_param("~", {}))
    except InputError:
        for argument in sys.argv[1:]:
            name, assignment, _ = argument.partition(":=")
            if assignment and name.startswith("_") and rospy.has_param("~" + name[1:]):
                rospy.delete_param("~" + name[1:])
        raise


def wait_for(get: Callable[[], T | None], timeout: float) -> T | None:
    """What ``get`` gives once that is not None, or None after ``timeout`` s.

    The seconds are the wall's: a simulated clock that stands still must not make a wait endless.

    Raises:
        ShutdownError: ROS shuts down.
    """
    deadline = time.monotonic() + timeout
    while True:
        result = get()
        if result is not None or time.monotonic() >= deadline:
            return result
        if rospy.is_shutdown():
            raise ShutdownError("told to end while waiting: nothing more is done")
        time.sleep(0.02)
