"""How long whole processes take to start, beside PyKDL and rospy alone, in turn.

The import; import and first call; and a node, from the start of its script to the trajectory that a
subscriber has received, with a ROS master of its own and an arm that stands still.
"""

from __future__ import annotations

import argparse
import subprocess
import sys
import tempfile
import threading
import time
from pathlib import Path
from statistics import median

from bench import OURS, Line, report

HERE = Path(__file__).parent
ROOT = HERE.parent
URDF, BAG = ROOT / "urdf/youbot_arm.urdf", ROOT / "bags/demo.bag"
PEER = "PyKDL + rospy"
WITHIN = 0.3  # s
TIMEOUT = 60.0  # s, for one node

_OUR_CALL = """
from youbot_kinematics import YoubotKinematics
arm = YoubotKinematics()
arm.inverse_kinematics(arm.forward_kinematics([2.9, 1.0, -1.2, 1.7, 2.9]))
"""
_THEIR_CALL = f"""
import rospy
from urdf_chain import kdl_chain
from minimal_node import forward, PyKDL
chain = kdl_chain({str(URDF)!r})
forward(PyKDL.ChainFkSolverPos_recursive(chain), [2.9, 1.0, -1.2, 1.7, 2.9])
"""
#: Work -> code of the project and of the peer, each for an interpreter of its own.
CODES = {
    "import": ("import youbot_kinematics", "import PyKDL, rospy"),
    "import and first call": (_OUR_CALL, _THEIR_CALL),
}


def run(code):
    """How long an interpreter takes for a piece of code, s."""
    begin = time.perf_counter()
    subprocess.run([sys.executable, "-c", code], cwd=HERE, check=True)
    return time.perf_counter() - begin


def node_times(rounds):
    """Name -> times, s, from the start of a node's script to its trajectory."""
    import rospy  # here, since the other rows need no ROS
    from soak import Arm, own_master, running
    from trajectory_msgs.msg import JointTrajectory

    from youbot_kinematics.nodes.common import COMMAND_TOPIC

    came = threading.Event()
    scripts = {
        OURS: (ROOT / "scripts/planner_node", f"_bag:={BAG}"),
        PEER: (HERE / "minimal_node.py", URDF, COMMAND_TOPIC),
    }
    times = {name: [] for name in scripts}
    with own_master(), tempfile.TemporaryFile() as log:
        rospy.init_node("startup", disable_signals=True)
        rospy.Subscriber(COMMAND_TOPIC, JointTrajectory, lambda message: came.set())
        for name in [*scripts] * (rounds + 1):
            arm = Arm()
            time.sleep(0.5)
            came.clear()
            begin = time.perf_counter()
            command = [sys.executable, *map(str, scripts[name])]
            with running(*command, stderr=log):
                if not came.wait(TIMEOUT):
                    raise SystemExit(f"{name}: no trajectory in {TIMEOUT:g} s")
                times[name].append(time.perf_counter() - begin)
            arm.end()
        rospy.signal_shutdown("measured")
    return {name: values[1:] for name, values in times.items()}  # the first one read from disk


def line(work, times):
    ours, theirs = (median(times[name]) for name in (OURS, PEER))
    more = median(a - b for a, b in zip(times[OURS], times[PEER]))
    goal = f"at most {WITHIN} s more"
    result = Line(f"start: {work}", ours, {PEER: theirs}, goal, more <= WITHIN, best=PEER)
    result.ratio = median(a / b for a, b in zip(times[OURS], times[PEER]))
    result.note = f"{more:+.3f} s"
    return result


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--rounds", type=int, default=9)
    parser.add_argument("--node", action=argparse.BooleanOptionalAction, default=True)
    options = parser.parse_args()
    lines = []
    for work, (ours, theirs) in CODES.items():
        codes = {OURS: ours, PEER: theirs}
        rounds = [{name: run(code) for name, code in codes.items()} for _ in range(options.rounds)]
        lines.append(line(work, {name: [r[name] for r in rounds] for name in codes}))
    if options.node:
        lines.append(line("node to trajectory", node_times(options.rounds)))
    report("startup", lines, **vars(options))


if __name__ == "__main__":
    main()
