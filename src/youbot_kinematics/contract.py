"""What a trajectory must be like for any controller of the arm to run it as it was meant.

Two receivers with different contracts are met at once. ROS's ``joint_trajectory_controller`` checks
neither NaN nor limits, drops points that lie in the past, and fills in accelerations it is not
given. The real arm's driver refuses points without accelerations, uses values by index whatever
their names, and ignores the stamp. The rules here are the stricter of both in each case.
"""

from __future__ import annotations

from typing import NamedTuple, Sequence

import numpy as np

from . import arm
from .trajectory import Trajectory

NANOSECONDS = 1_000_000_000  # in a second

_ROUNDING = 1e-9  # rad, rad/s, rad/s^2: how far a value may be off through rounding alone
_QUANTITIES = ("position", "velocity", "acceleration")


class Command(NamedTuple):
    """What a ``JointTrajectory`` message says, with its rows as they came: of any length."""

    joint_names: Sequence[str]
    times: Sequence[int]  # (n,) ns from the start
    positions: Sequence[Sequence[float]] | np.ndarray  # (n, 5) rad, if it is well formed
    velocities: Sequence[Sequence[float]] | np.ndarray  # (n, 5) rad/s
    accelerations: Sequence[Sequence[float]] | np.ndarray  # (n, 5) rad/s^2
    stamp: int = 0  # ns, when to start; 0 is now


def command_from_trajectory(trajectory: Trajectory) -> Command:
    """The command that runs a trajectory from now on: all joints in order, times in whole ns."""
    return Command(
        arm.JOINT_NAMES,
        [round(t * NANOSECONDS) for t in trajectory.times.tolist()],
        trajectory.positions,
        trajectory.velocities,
        trajectory.accelerations,
    )


def trajectory_from_command(command: Command) -> Trajectory:
    """The arrays of a command that has no ``acceptance_problems``; its stamp is left out."""
    q, v, a = (np.array(rows, dtype=float).reshape(-1, arm.DOF) for rows in command[2:5])
    return Trajectory(np.array(command.times, dtype=np.int64) / NANOSECONDS, q, v, a)


def motion_problems(command: Command) -> list[str]:
    """Why a command is no motion of the arm at all: a sentence each, none if it is one.

    All five joints in order; a finite position, velocity and acceleration of each in every point;
    times that increase, from zero or later.
    """
    return _form_problems(command) or _time_problems(command.times)


def acceptance_problems(command: Command, limits: arm.JointLimits) -> list[str]:
    """Why a controller or the driver refuses a command: a sentence each, none if it is accepted.

    All five joints in order; a finite position, velocity and acceleration of each in every point;
    times that increase, from zero or later; positions and velocities inside their limits.
    """
    problems = _form_problems(command)
    return problems or [*_time_problems(command.times), *_limit_problems(command, limits)]


def shape_problems(command: Command, limits: arm.JointLimits) -> list[str]:
    """In what a command differs from those that this package publishes: a sentence each.

    Beyond what controllers accept: it starts now, its first point is at time zero, its points are
    evenly spaced (to the nanosecond), and the arm is at rest in the first and in the last of them.
    """
    problems = acceptance_problems(command, limits)
    if problems:
        return problems
    if command.stamp != 0:
        problems.append(f"the stamp is {command.stamp} ns, not zero, which means now")
    if command.times[0] != 0:
        problems.append(f"the first point is at {command.times[0]} ns, not at zero")
    steps = np.diff(command.times)
    if len(steps) and np.ptp(steps) > 1:
        problems.append(f"the points are between {steps.min()} and {steps.max()} ns apart")
    return problems + _rest_problems(command)


def _form_problems(command: Command) -> list[str]:
    """Whether there are numbers for every joint in every point."""
    if tuple(command.joint_names) != arm.JOINT_NAMES:
        given = ", ".join(command.joint_names) or "unnamed"
        return [f"the joints are {given}; they must be {', '.join(arm.JOINT_NAMES)} in this order"]
    if len(command.times) == 0:
        return ["there are no points"]
    for quantity, rows in zip(_QUANTITIES, command[2:5]):
        problem = _row_problem(quantity, rows)
        if problem:
            return [problem]
    return []


def _row_problem(quantity: str, rows) -> str:
    """The first row that does not hold a finite number for each joint, as a sentence, or ''."""
    if isinstance(rows, np.ndarray) and rows.shape[1:] == (arm.DOF,) and np.isfinite(rows).all():
        return ""
    for point, row in enumerate(rows):
        if len(row) != arm.DOF:
            return f"point {point} has {len(row)} values of {quantity}, not {arm.DOF}"
        finite = np.isfinite(row)
        if not finite.all():
            i = int(np.argmin(finite))
            return f"point {point}: the {quantity} of {arm.JOINT_NAMES[i]} is {row[i]}"
    return ""


def _time_problems(times: Sequence[int]) -> list[str]:
    if times[0] < 0:
        return [f"point 0 is at {times[0] / NANOSECONDS:g} s, before the start"]
    late = np.flatnonzero(np.diff(times) <= 0)
    if late.size == 0:
        return []
    i = int(late[0]) + 1
    here, before = times[i] / NANOSECONDS, times[i - 1] / NANOSECONDS
    return [f"point {i} at {here:.9g} s does not come after point {i - 1} at {before:.9g} s"]


def _limit_problems(command: Command, limits: arm.JointLimits) -> list[str]:
    problems = []
    positions = np.asarray(command.positions, dtype=float)
    outside = ~limits.contain(positions, _ROUNDING)
    if outside.any():
        point = int(np.argmax(outside))
        problems.append(f"point {point}: {limits.describe_violation(positions[point])}")
    speeds = np.abs(np.asarray(command.velocities, dtype=float))
    fast = np.argwhere(speeds > limits.velocity + _ROUNDING)
    if fast.size:
        point, i = fast[0]
        problems.append(
            f"point {point}: {arm.JOINT_NAMES[i]} moves at {speeds[point, i]:.4f} rad/s,"
            f" above its limit {limits.velocity[i]:.4f} rad/s"
        )
    return problems


def _rest_problems(command: Command) -> list[str]:
    problems = []
    for where, point in (("first", 0), ("last", -1)):
        for quantity, rows in zip(_QUANTITIES[1:], command[3:5]):
            if np.abs(rows[point]).max() > _ROUNDING:
                problems.append(f"the {quantity} of the {where} point is not zero")
    return problems
