"""What the test nodes share: running the package's programs, recording a topic, waiting."""

import os
import subprocess
import threading
import time
from contextlib import contextmanager
from socketserver import ThreadingMixIn
from xmlrpc.server import SimpleXMLRPCServer

import rospy

COMMAND_TOPIC = "EffortJointInterface_trajectory_controller/command"
#: Joint positions (rad) from which the bundled bag's tour can be tracked; tour.test has them too.
START = [0.5, 0.2, -0.5, 0.3, 0.5]


def start_program(name, *arguments):
    """Starts one of the package's programs; what it prints is piped, as text."""
    return subprocess.Popen(
        ["rosrun", "youbot_kinematics", name, *arguments],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )


def run_program(name, *arguments, timeout=60):
    """Runs one of the package's programs to its end: its exit status and what it said on stderr."""
    process = start_program(name, *arguments)
    try:
        _, errors = process.communicate(timeout=timeout)
    finally:
        process.kill()
    return process.returncode, errors


def wait_until(condition, timeout=30.0):
    """Whether a condition comes true in time."""
    deadline = time.monotonic() + timeout
    while not condition() and time.monotonic() < deadline:
        time.sleep(0.02)
    return bool(condition())


class _Master(ThreadingMixIn, SimpleXMLRPCServer):
    daemon_threads = True


@contextmanager
def slow_master(slow, seconds=2.0):
    """A ROS master that says yes to everything, and takes its time for the calls named ``slow``.

    Yields an event that is set once there is such a call.
    """
    called = threading.Event()

    def answer(method, _arguments):
        if method == slow:
            called.set()
            time.sleep(seconds)
        return [1, "", {}]

    with _Master(("localhost", 0), logRequests=False) as server:
        server.register_instance(type("Calls", (), {"_dispatch": staticmethod(answer)})())
        threading.Thread(target=server.serve_forever, daemon=True).start()
        uri = f"http://localhost:{server.server_address[1]}"
        os.environ.update(ROS_MASTER_URI=uri, ROS_HOSTNAME="localhost")
        yield called
        server.shutdown()


class Recorder:
    """Keeps every message of a topic."""

    def __init__(self, topic, kind):
        self.messages = []
        self.subscriber = rospy.Subscriber(topic, kind, self.messages.append)

    def wait_for(self, count=1, timeout=30.0):
        """Whether so many messages come in time."""
        return wait_until(lambda: len(self.messages) >= count, timeout)
