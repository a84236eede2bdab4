"""./run soak: does the planner's node stay as small as it is over many plans?

It starts a ROS master of its own, planner_node, and an arm that is at once where it is sent, and
asks for plan after plan by ``~replan``. Once the node is warm, its memory must stay flat, and the
numbers of its threads and open files the same.
"""

from __future__ import annotations

import argparse
import os
import re
import signal
import socket
import subprocess
import sys
import tempfile
import threading
import time
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import NamedTuple
from xmlrpc.client import ServerProxy

import rosgraph
import rospy
from sensor_msgs.msg import JointState
from std_srvs.srv import Trigger
from trajectory_msgs.msg import JointTrajectory

from youbot_kinematics import arm
from youbot_kinematics.make_bag import make_bag, random_joints
from youbot_kinematics.nodes.common import COMMAND_TOPIC, JOINT_STATES_TOPIC
from youbot_kinematics.state_messages import joint_state_message
from youbot_kinematics.targets import Targets

NODE = "planner_node"
FLAT = 0.05  # by how much the memory may differ between the warm node and any later moment
TARGETS, SEED = 2, 7


class Usage(NamedTuple):
    """What a process holds."""

    megabytes: float  # resident
    threads: int
    files: int

    @classmethod
    def of(cls, pid: int) -> Usage:
        status = Path(f"/proc/{pid}/status").read_text()
        kilobytes, threads = (
            int(re.search(rf"^{name}:\s*(\d+)", status, re.MULTILINE)[1])
            for name in ("VmRSS", "Threads")
        )
        return cls(kilobytes / 1000, threads, len(os.listdir(f"/proc/{pid}/fd")))


class Arm:
    """An arm with its controller, of infinite speed."""

    def __init__(self):
        self._position, self.commands = [0.0] * arm.DOF, 0
        self._ended = False
        self._states = rospy.Publisher(JOINT_STATES_TOPIC, JointState, queue_size=10)
        self._subscriber = rospy.Subscriber(COMMAND_TOPIC, JointTrajectory, self._take)
        self._thread = threading.Thread(target=self._publish, daemon=True)
        self._thread.start()

    def end(self) -> None:
        self._ended = True
        self._thread.join()
        self._subscriber.unregister()
        self._states.unregister()

    def _take(self, message: JointTrajectory) -> None:
        self._position = list(message.points[-1].positions)
        self.commands += 1

    def _publish(self) -> None:
        while not (self._ended or rospy.is_shutdown()):
            state = joint_state_message(rospy.Time.now(), self._position, [0.0] * arm.DOF)
            self._states.publish(state)
            time.sleep(0.02)


def soak(plans: int, arm_: Arm, shown=print) -> list[str]:
    """Asks a running node for plans; what is wrong with it afterwards, a sentence each."""
    rospy.wait_for_service(f"{NODE}/replan", timeout=60)
    replan = rospy.ServiceProxy(f"{NODE}/replan", Trigger)
    pid = _pid(NODE)
    warm, step = max(plans // 10, 5), max(plans // 10, 1)
    refused, usages = [], []
    shown(f"{'plans':>6} {'MB':>8} {'threads':>8} {'files':>6}")
    for done in range(1, plans + warm + 1):
        answer = replan()
        if not answer.success:
            refused.append(answer.message)
        if done >= warm and (done - warm) % step == 0:
            time.sleep(0.5)  # what the last call needed is closed by then
            usages.append(Usage.of(pid))
            shown("{:6d} {:8.1f} {:8d} {:6d}".format(done, *usages[-1]))
    return _problems(usages, refused, arm_.commands, plans + warm + 1)


def _problems(usages, refused, commands: int, expected: int) -> list[str]:
    warm = usages[0]
    worst = max(abs(usage.megabytes / warm.megabytes - 1.0) for usage in usages)
    problems = [f"a plan was refused: {message}" for message in refused]
    if commands != expected:
        problems.append(f"{commands} trajectories came, not {expected}")
    if worst > FLAT:
        problems.append(f"the memory changed by {worst:.1%}, more than {FLAT:.0%}")
    for name in ("threads", "files"):
        if getattr(usages[-1], name) > getattr(warm, name):
            problems.append(f"the node has more {name} than when it was warm")
    return problems


def _pid(node: str) -> int:
    uri = rosgraph.Master("/soak").lookupNode(f"/{node}")
    return ServerProxy(uri).getPid("/soak")[2]


@contextmanager
def running(*command, stderr=None):
    """A program, which ends with the block."""
    process = subprocess.Popen(
        command, stdout=subprocess.DEVNULL, stderr=stderr, start_new_session=True
    )
    try:
        yield process
    finally:
        process.send_signal(signal.SIGINT)
        try:
            process.wait(20)
        except subprocess.TimeoutExpired:
            process.kill()


@contextmanager
def own_master():
    """A ROS master that no one else uses, on a free port of this computer, as a process."""
    with socket.socket() as probe:
        probe.bind(("localhost", 0))
        port = probe.getsockname()[1]
    os.environ.update(ROS_MASTER_URI=f"http://localhost:{port}", ROS_HOSTNAME="localhost")
    with running("rosmaster", "--core", "-p", str(port)) as master:
        deadline = time.monotonic() + 30
        while not rosgraph.is_master_online() and time.monotonic() < deadline:
            time.sleep(0.1)
        yield master


def main() -> int:
    parser = argparse.ArgumentParser(prog="./run soak", description=__doc__.splitlines()[0])
    parser.add_argument("--plans", type=int, default=1000, help="how many (default: 1000)")
    plans = parser.parse_args().plans
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(1))  # ends what was started, as Ctrl-C does
    with ExitStack() as stack:
        folder = stack.enter_context(tempfile.TemporaryDirectory())
        bag = f"{folder}/soak.bag"
        targets = random_joints(TARGETS, SEED, arm.joint_limits("urdf"))
        make_bag(bag, Targets.from_joints(targets))
        stack.enter_context(own_master())
        rospy.init_node("soak", disable_signals=True)
        arm_ = Arm()
        stack.enter_context(running("rosrun", "youbot_kinematics", NODE, f"_bag:={bag}"))
        began = time.monotonic()
        problems = soak(plans, arm_)
        print(f"{plans} plans in {time.monotonic() - began:.0f} s")
        arm_.end()
        rospy.signal_shutdown("the soak is over")
    print("\n".join(problems) or "memory flat, no thread and no file left open")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
