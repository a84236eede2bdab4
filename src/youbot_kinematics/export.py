"""Plans as files: JSON, CSV, or a bag that ``rosbag play`` sends to a controller."""

from __future__ import annotations

import csv
import json
import math
from pathlib import Path

import numpy as np

from . import arm
from .bag_writer import make, make_duration, make_header, write_bag
from .contract import NANOSECONDS, command_from_trajectory
from .exceptions import InputError
from .files import new_file
from .interface import COMMAND

COMMAND_TOPIC = "/" + COMMAND.name


def write_plan(path, plan, force: bool = False) -> None:
    """Writes a plan, whole or not at all, in the format that the file's name says.

    Args:
        path: a name that ends in ``.json``, ``.csv`` or ``.bag``.
        plan: a ``planner.Plan``.
        force: whether it may replace a file.

    Raises:
        InputError: another suffix, the file exists already, or it cannot be written.
    """
    writer(path)(path, plan, force)


def writer(path):
    """The function that writes a plan to a file of that name.

    Raises:
        InputError: there is none for its suffix.
    """
    suffix = Path(path).suffix.lower()
    if suffix not in WRITERS:
        raise InputError(f"cannot write {path}: its name must end in {' or '.join(WRITERS)}")
    return WRITERS[suffix]


def write_json(path, plan, force: bool = False) -> None:
    """Writes all of a plan; numbers are in SI units and rad, and NaN is null."""
    with new_file(path, force) as unfinished:
        text = json.dumps(as_dict(plan), indent=1, allow_nan=False)
        unfinished.write_text(text + "\n", encoding="utf-8")


def write_csv(path, plan, force: bool = False) -> None:
    """Writes the points of a plan's trajectory, with names and units in the first line."""
    t = plan.trajectory
    columns = np.column_stack([_seconds(t), t.positions, t.velocities, t.accelerations])
    with new_file(path, force) as unfinished, unfinished.open("w", newline="") as file:
        rows = csv.writer(file)
        rows.writerow(csv_header())
        rows.writerows(columns.tolist())


def write_command_bag(path, plan, force: bool = False) -> None:
    """Writes the JointTrajectory that a controller takes, as one message in a bag."""
    write_bag(path, COMMAND_TOPIC, [_message(plan.trajectory)], force=force)


#: Suffix of a file's name -> the function that writes it.
WRITERS = {".json": write_json, ".csv": write_csv, ".bag": write_command_bag}


def csv_header() -> list[str]:
    """Names of the columns: time, then positions, velocities and accelerations of all joints.

    They are words that pandas and MATLAB take as they are.
    """
    quantities = ("position_rad", "velocity_rad_s", "acceleration_rad_s2")
    return ["time_s"] + [f"{joint}_{name}" for name in quantities for joint in arm.JOINT_NAMES]


def as_dict(plan) -> dict:
    """A plan as JSON knows it: dicts, lists, numbers, strings."""
    return _plain(
        {
            "joint_names": arm.JOINT_NAMES,
            "points": _points(plan.trajectory),
            "order": plan.order,
            "length": plan.length,
            "segments": [
                {
                    "kind": segment.kind,
                    "start": segment.start,
                    "end": segment.end,
                    "from": segment.from_checkpoint,
                    "to": segment.to_checkpoint,
                    "reason": segment.reason,
                }
                for segment in plan.trajectory.segments
            ],
            "report": {
                **plan.report.as_dict(),
                "solver": plan.solver,
                "solver_reason": plan.solver_reason,
                "met_in_position_only": plan.met_in_position_only,
            },
            "frame": arm.BASE_FRAME,
            "tool_frame": arm.TOOL_FRAME,
            "start": plan.start,
            "targets": {
                "source": plan.targets.source,
                "poses": plan.targets.poses,
                "joints": plan.targets.joints,
            },
            "parameters": vars(plan.parameters),
        }
    )


def _points(trajectory) -> list[dict]:
    keys = ("time_from_start", "positions", "velocities", "accelerations")
    rows = zip(_seconds(trajectory), *trajectory[1:4])
    return [dict(zip(keys, row)) for row in rows]


def _seconds(trajectory) -> list[float]:
    """Times as the message has them, whole nanoseconds, in s."""
    return [time / NANOSECONDS for time in command_from_trajectory(trajectory).times]


def _plain(value):
    """``value`` with arrays as lists, and as null whatever number is not finite."""
    if isinstance(value, dict):
        return {key: _plain(each) for key, each in value.items()}
    if isinstance(value, (np.ndarray, np.generic)):
        return _plain(value.tolist())
    if isinstance(value, (list, tuple)):
        return [_plain(each) for each in value]
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value


def _message(trajectory):
    """A trajectory as the message that ``contract`` describes."""
    command = command_from_trajectory(trajectory)
    no_effort = np.empty(0)
    points = [
        make("trajectory_msgs/JointTrajectoryPoint", q, v, a, no_effort, make_duration(time))
        for time, q, v, a in zip(*command[1:5])
    ]
    names = list(command.joint_names)
    return make("trajectory_msgs/JointTrajectory", make_header(), names, points)
