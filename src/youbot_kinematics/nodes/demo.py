"""``rosrun youbot_kinematics demo``: the bundled bag on a simulated arm, from start to end.

It starts ``demo.launch`` on a ROS master of its own, records where the simulated arm really goes,
and says how near the tool came to each target. The tour and its figures are planned here once more,
from the same bag and the same start; what the arm did comes from its joint states.
"""

from __future__ import annotations

import argparse
import os
import signal
import socket
import subprocess
import sys
import tempfile
import threading
from pathlib import Path

import numpy as np
import rosgraph
import rospy
from sensor_msgs.msg import JointState

from ..exceptions import YoubotError
from ..kinematics import YoubotKinematics
from ..planner import Plan, plan
from ..plot import plot_plan
from ..resources import resource_path
from ..state_messages import joints_from_message
from ..summary import summary
from ..targets import load_targets
from ..trajectory import Trajectory, interpolate
from .common import FAILED, JOINT_STATES_TOPIC, wait_for

#: How near the tool must come to a target, m. Joint states are 10 ms apart, so it is seen not quite
#: where it turns; the check of the plan itself is a thousand times stricter.
TOLERANCE = 0.001
# s. For the nodes to come up; for the motion, beyond its duration; for the arm to stand after it.
START_UP, GRACE, STANDS = 60.0, 20.0, 0.5
STILL = 1e-5  # rad
ENDING = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)


class DemoError(YoubotError):
    """The demonstration did not come to its end."""


class Launch:
    """``demo.launch`` as a process on a port of its own, which ends with the ``with`` block.

    Args:
        arguments: of the launch file, such as ``"rviz:=true"``.
    """

    def __init__(self, *arguments: str):
        with socket.socket() as probe:
            probe.bind(("localhost", 0))
            port = probe.getsockname()[1]
        # This computer only: the demonstration needs no network, and disturbs no other ROS on it.
        os.environ["ROS_MASTER_URI"] = f"http://localhost:{port}"
        os.environ["ROS_HOSTNAME"] = "localhost"
        for name in ("ROS_IP", "ROS_NAMESPACE"):
            os.environ.pop(name, None)
        self._log = tempfile.TemporaryFile("w+", errors="replace")
        self._process = subprocess.Popen(
            ["roslaunch", "-p", str(port), str(resource_path("launch/demo.launch")), *arguments],
            stdin=subprocess.DEVNULL,
            stdout=self._log,
            stderr=subprocess.STDOUT,
            start_new_session=True,  # Ctrl-C is for us, who end it in order
        )

    def __enter__(self) -> Launch:
        return self

    def __exit__(self, *_):
        for number in ENDING:  # a second Ctrl-C must not leave it running
            signal.signal(number, signal.SIG_IGN)
        rospy.signal_shutdown("the demonstration is over")
        for _ in range(20):  # once is not enough: roslaunch loses a signal while it starts
            self._process.send_signal(signal.SIGINT)
            try:
                self._process.wait(2)
                return
            except subprocess.TimeoutExpired:
                pass
        self._process.kill()

    def wait_for(self, get, timeout: float, what: str):
        """What ``get`` gives once that is not None.

        Raises:
            DemoError: the launched nodes have ended, or it has not come in ``timeout`` s.
        """
        ended = object()
        result = wait_for(lambda: get() if self._process.poll() is None else ended, timeout)
        if result is None or result is ended:
            problem = "ended early" if result is ended else f"gave no {what} in {timeout:g} s"
            raise DemoError(f"the launched nodes {problem}. They said:\n{self._said()}")
        return result

    def _said(self) -> str:
        self._log.seek(0)
        lines = self._log.read().splitlines()
        return "\n".join([line for line in lines if "[FATAL]" in line] or lines[-15:])


class Recorder:
    """Where the arm has been: times in s and joints (5,) in rad, from its joint states."""

    def __init__(self):
        self._samples: list[tuple[float, np.ndarray]] = []
        self._lock = threading.Lock()
        rospy.Subscriber(JOINT_STATES_TOPIC, JointState, self._take)

    def _take(self, message: JointState) -> None:
        joints = joints_from_message(message)
        if joints is not None:
            with self._lock:
                self._samples.append((message.header.stamp.to_sec(), joints))

    def first(self) -> np.ndarray | None:
        """The joints (5,) of the first state, or None as long as there is none."""
        return self._samples[0][1] if self._samples else None

    def motion(self) -> tuple[np.ndarray, np.ndarray]:
        """Times (n,) in s from the moment when the arm began to move, and joints (n, 5) in rad."""
        with self._lock:
            samples = list(self._samples)
        joints = np.array([q for _, q in samples])
        moved = np.flatnonzero(np.abs(joints - joints[0]).max(axis=1) > STILL)
        begin = max(moved[0] - 1, 0) if moved.size else len(samples) - 1
        times = np.array([t for t, _ in samples])
        return times[begin:] - times[begin], joints[begin:]


def demonstrate(picture: Path) -> bool:
    """Runs the demonstration; whether the tool reached every target.

    Raises:
        YoubotError: the tour could not be planned, or the nodes did not run.
    """
    print("starting a ROS master, the simulated arm and the planner", flush=True)
    with Launch() as launch:
        launch.wait_for(lambda: rosgraph.is_master_online() or None, START_UP, "ROS master")
        rospy.init_node("demo", disable_signals=True)
        recorder = Recorder()
        start = launch.wait_for(recorder.first, START_UP, "joint states")
        planned = plan(load_targets(str(resource_path("bags/demo.bag"))), start)
        print("\n".join(summary(planned)), flush=True)
        follow_motion(launch, recorder, planned.trajectory.duration)
        times, joints = recorder.motion()
    lag, error = fit(planned.trajectory, times, joints)
    times = times - lag
    show("simulated arm", f"followed the plan to within {error:.4f} rad")
    reached = print_outcome(planned, times, joints)
    plot_plan(planned, picture, recorded=(times, joints), force=True)
    show("picture", picture)
    return reached


def follow_motion(launch: Launch, recorder: Recorder, duration: float) -> None:
    """Waits for the arm to have moved and to stand again, and shows how far it is."""
    progress = Progress(duration)

    def stands_again():
        times, joints = recorder.motion()
        progress(times[-1])
        last = joints[times > times[-1] - STANDS]
        return True if times[-1] > duration and np.ptp(last, axis=0).max() < STILL else None

    launch.wait_for(stands_again, START_UP + duration + GRACE, "motion that ends")
    progress.end()


class Progress:
    """How far the motion is: a line that is updated on a terminal, a line a quarter elsewhere."""

    WIDTH = 30

    def __init__(self, duration: float):
        self._duration, self._shown = duration, 0
        self._terminal = sys.stdout.isatty()

    def __call__(self, seconds: float) -> None:
        done = min(int(100 * seconds / self._duration), 100)
        if done - self._shown < (1 if self._terminal else 25):
            return
        self._shown = done
        text = f"{done} % of {self._duration:.1f} s"
        if self._terminal:
            bar = "#" * (done * self.WIDTH // 100)
            print(f"\r{'moving':<19} {bar:.<{self.WIDTH}} {text}", end="", flush=True)
        else:
            show("moving", text)

    def end(self) -> None:
        if self._terminal:
            print()


def print_outcome(planned: Plan, times: np.ndarray, joints: np.ndarray) -> bool:
    """Says how near the tool came to each target; whether that was near enough for all."""
    distances, moments = closest_approaches(joints, planned.checkpoints[1:])
    for number, distance, moment in zip(planned.order + 1, distances, times[moments]):
        verdict = "passed" if distance <= TOLERANCE else "MISSED"
        show(f"target {number}", f"{verdict} at {distance * 1000:.4f} mm after {moment:.2f} s")
    passed = int((distances <= TOLERANCE).sum())
    show("simulated arm", f"passed {passed} of {len(distances)} targets")
    return passed == len(distances)


def show(name: str, value) -> None:
    """A line in the columns of ``summary``."""
    print(f"{name:<19} {value}", flush=True)


def fit(trajectory: Trajectory, times: np.ndarray, joints: np.ndarray) -> tuple[float, float]:
    """By how many s what the arm did, (m, 5) rad, is behind a trajectory, and the rad off it."""
    lags = np.arange(-0.05, 0.05, 0.001)
    errors = [np.abs(interpolate(trajectory, times - s)[0] - joints).max() for s in lags]
    best = int(np.argmin(errors))
    return float(lags[best]), float(errors[best])


def closest_approaches(joints: np.ndarray, checkpoints: np.ndarray):
    """How near the tool came to each checkpoint, and when.

    Args:
        joints: where the arm was, (m, 5), rad.
        checkpoints: poses (n, 4, 4), m.

    Returns:
        Distances (n,) in m, and indices (n,) of the joints.
    """
    tool = YoubotKinematics().forward_kinematics(joints)[:, :3, 3]
    distances = np.linalg.norm(tool[None] - checkpoints[:, None, :3, 3], axis=-1)
    return distances.min(axis=1), distances.argmin(axis=1)


def _interrupt(number, _frame) -> None:
    sys.exit(128 + number)


def main() -> None:
    argparse.ArgumentParser(prog="demo", description=__doc__).parse_args(rospy.myargv()[1:])
    for number in ENDING:
        signal.signal(number, _interrupt)
    home = Path(os.environ.get("ROS_HOME", Path.home() / ".ros"))
    try:
        sys.exit(0 if demonstrate(home / "youbot_demo.png") else FAILED)
    except YoubotError as error:
        print(f"\ndemo: {error}", file=sys.stderr)
        sys.exit(FAILED)
