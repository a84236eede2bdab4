"""The command ``check_trajectory``: does a trajectory keep its promises, whoever made it?"""

from __future__ import annotations

import argparse
import os
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np

from . import arm
from .bag_reader import choose_topic, one_sentence, open_bag, printable
from .check import check_command
from .contract import NANOSECONDS, Command, motion_problems
from .exceptions import InputError, YoubotError
from .kinematics import dh_frames
from .parameters import Parameters
from .plan_reader import Subject, read_plan
from .targets import load_targets

_KEPT, _BROKEN, _BAD_INPUT, _INTERRUPTED = 0, 1, 2, 130

_TYPE = "trajectory_msgs/msg/JointTrajectory"

_DESCRIPTION = """\
Judges trajectories of the youBot arm, as the controller will run them: each JointTrajectory message
in a bag, or the plan in a JSON file of plan_bag. Needs no ROS."""

_EPILOG = """\
exit status: 0 every promise is kept, 1 one is broken, 2 bad input

A plan's JSON says on which lines the tool is and which checkpoints it visits. A message does not,
but the bag of its targets can be given: then each must be met, in any order.

examples:
  check_trajectory plan.json
  check_trajectory recorded.bag --topic arm_1/arm_controller/command --limits hardware
  check_trajectory command.bag --targets targets.bag"""


def main(argv=None) -> int:
    """Runs the command; results go to standard output, what is wrong with the input to the other.

    Args:
        argv: its arguments; those of the process if not given.

    Returns:
        The exit status: 0 kept, 1 broken, 2 bad input, 130 interrupted.
    """
    options = _parser().parse_args(argv)
    try:
        kept = [_judge(name, subject, options) for name, subject in _subjects(options)]
    except YoubotError as error:
        print(f"check_trajectory: {error}", file=sys.stderr)
        return _BAD_INPUT
    except KeyboardInterrupt:
        print("check_trajectory: interrupted", file=sys.stderr)
        return _INTERRUPTED
    return _KEPT if all(kept) else _BROKEN


def _subjects(options) -> list[tuple[str, Subject]]:
    """Everything to judge in the file, with a name for people."""
    path = Path(os.path.expanduser(options.file))
    if path.suffix.lower() == ".json":
        return [(path.name, read_plan(path))]
    with one_sentence(path), open_bag(path) as reader:
        connections = choose_topic(reader.connections, options.topic, [_TYPE], "trajectories")
        topic = f"{path.name}, {connections[0].topic}"
        messages = [reader.deserialize(raw, _TYPE) for *_, raw in reader.messages(connections)]
        return [
            (printable(f"{topic}, message {i} of {len(messages)}"), Subject(_command(message)))
            for i, message in enumerate(messages, start=1)
        ]


def _command(message) -> Command:
    """What rosbags' JointTrajectory says."""
    points = message.points
    return Command(
        message.joint_names,
        [_nanoseconds(point.time_from_start) for point in points],
        [point.positions for point in points],
        [point.velocities for point in points],
        [point.accelerations for point in points],
        _nanoseconds(message.header.stamp),
    )


def _nanoseconds(time) -> int:
    return time.sec * NANOSECONDS + time.nanosec


def _judge(name: str, subject: Subject, options) -> bool:
    """Prints the report of a trajectory, and returns whether it keeps all promises."""
    parameters = _parameters(subject, options)
    limits, acceleration = arm.joint_limits(parameters.limits), parameters.acceleration
    checkpoints = _checkpoints(subject, options, parameters)
    report = check_command(subject.command, limits, acceleration, subject.segments, checkpoints)
    print(f"{'trajectory':20}{name}")
    print(f"{'points':20}{len(subject.command.times)}")
    print(f"{'held against':20}limits {parameters.limits}, acceleration {acceleration:g} rad/s^2")
    for line in report.lines():
        print(line)
    for failure in report.failures:
        print(f"{'broken':20}{printable(failure)}")
    if report.passed:
        print(f"{'kept':20}every promise")
    return report.passed


def _parameters(subject: Subject, options) -> Parameters:
    """The plan's own parameters, or the defaults, where the options do not say otherwise."""
    asked = {"limits": options.limits, "acceleration": options.acceleration}
    return replace(subject.parameters, **{k: v for k, v in asked.items() if v is not None})


def _checkpoints(subject: Subject, options, parameters: Parameters) -> np.ndarray | None:
    """Poses of the tool at the start and at all that is visited, (n + 1, 4, 4), m, if known."""
    visited = subject.visited
    if options.targets:
        visited = load_targets(options.targets, limits=parameters.limits).poses
        if subject.order is not None:
            if len(visited) != len(subject.order):
                raise InputError(f"{len(visited)} targets, but {len(subject.order)} were planned")
            visited = visited[subject.order]
    if visited is None or motion_problems(subject.command):
        return None
    T_start = dh_frames(np.array(subject.command.positions[0], dtype=float))[-1:]
    checkpoints = np.concatenate([T_start, visited, T_start[: parameters.return_home]])
    for segment in subject.segments:
        if segment.to_checkpoint >= len(checkpoints):
            raise InputError(
                f"a segment leads to checkpoint {segment.to_checkpoint},"
                f" and there are {len(checkpoints) - 1} behind the start"
            )
    return checkpoints


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="check_trajectory",
        description=_DESCRIPTION,
        epilog=_EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
        allow_abbrev=False,
    )
    add = parser.add_argument
    add("file", metavar="BAG|JSON", help="ROS 1 bag (or a ROS 2 bag's folder), or a plan's JSON")
    add(
        "--limits",
        choices=tuple(arm.LIMITS),
        help="joint limits to hold it against (default: the plan's own, else urdf)",
    )
    add(
        "--acceleration",
        type=float,
        metavar="A",
        help="limit of every joint's acceleration, rad/s^2 (default: the plan's own, else 3.0)",
    )
    add("--targets", metavar="BAG", help="bag of the targets that must be visited")
    add("--topic", default="", help="topic of the trajectories; needed only if several fit")
    return parser
