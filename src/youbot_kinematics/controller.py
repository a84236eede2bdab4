"""A stand-in for the arm and its controller, as arrays: what it refuses, and how it moves.

It follows ``joint_trajectory_controller``: a command replaces the one before as soon as it starts;
points in the past are dropped; from where the arm is it takes a quintic to the first point that is
left; a command without points stops the arm. What it refuses is in ``contract``, with one rule of
its own: an arm cannot jump.
"""

from __future__ import annotations

import numpy as np

from . import arm
from .contract import Command, acceptance_problems, trajectory_from_command
from .exceptions import InputError
from .trajectory import Trajectory, interpolate

#: rad. How far off the first point may be from where the arm is, beyond what the arm can move until
#: then: sensors and messages are late, and controllers have a tolerance for it.
START_TOLERANCE = 0.1
#: s. How long the arm takes to stand still when it is told to stop.
STOP_TIME = 0.2


class Controller:
    """The arm under its controller, over a clock of its own that starts at 0 s.

    Args:
        start: joint positions (5,) rad, inside the limits.
        limits: the arm's limits; a command that passes them is refused.

    Raises:
        InputError: the arm cannot start there.
    """

    def __init__(self, start, limits: arm.JointLimits):
        start = np.asarray(start, dtype=float)
        if not limits.contain(start):
            raise InputError(f"the arm cannot start there: {limits.describe_violation(start)}")
        self.limits = limits
        self._trajectory = standing(start, 0.0)

    def state(self, now: float):
        """Positions, velocities and accelerations at a time in s: each (5,) rad, rad/s, rad/s^2.

        After the last point the arm stands there, whatever velocity the point asks for.
        """
        if now >= self._trajectory.duration:
            return self._trajectory.positions[-1], np.zeros(arm.DOF), np.zeros(arm.DOF)
        return tuple(row[0] for row in interpolate(self._trajectory, [now]))

    def command(self, command: Command, now: float, start: float | None = None) -> int:
        """Take a command from now on, or stop if it has no points.

        Args:
            now: time in s.
            start: when the command starts, in s; now if it is None.

        Returns:
            How many of the points are dropped, for being in the past.

        Raises:
            InputError: it is refused, and why; the arm goes on with what it was doing.
        """
        if len(command.times) == 0:
            self._trajectory = self._stop(now)
            return 0
        problems = acceptance_problems(command, self.limits)
        if problems:
            raise InputError("; ".join(problems))
        start = now if start is None else start
        new = trajectory_from_command(command)
        new = new._replace(times=new.times + start)
        self._trajectory, dropped = self._splice(new, now, start)
        return dropped

    def _splice(self, new: Trajectory, now: float, start: float) -> tuple[Trajectory, int]:
        """The trajectory so far until ``new`` starts (or now), from there on the points of ``new``.

        The first point says where the arm is at the start. The arm knows that better, so its own
        state stands in for a point that is due at the switch.
        """
        switch = max(now, start)
        left = new.times > switch
        if not left.any():
            raise InputError("all of its points are in the past")
        here, rest, old = self._point(switch), _select(new, left), self._trajectory
        self._check_reachable(here.positions[0], rest.positions[0], rest.times[0] - switch)
        since = np.searchsorted(old.times, now, side="right") - 1  # no need for what is long past
        kept = (old.times < switch) & (np.arange(len(old.times)) >= since)
        return _join([_select(old, kept), here, rest]), int(np.count_nonzero(new.times < switch))

    def _point(self, time: float) -> Trajectory:
        """The arm's state at a time in s, as a trajectory of one point."""
        return Trajectory(np.array([time]), *(row[None] for row in self.state(time)))

    def _check_reachable(self, position, target, time):
        distance = np.abs(target - position)
        beyond = distance - (self.limits.velocity * time + START_TOLERANCE)
        i = int(np.argmax(beyond))
        if beyond[i] > 0:
            raise InputError(
                f"it starts {distance[i]:.4f} rad from where {arm.JOINT_NAMES[i]} is"
                f" ({position[i]:.4f} rad), {time:.3f} s from now"
            )

    def _stop(self, now: float) -> Trajectory:
        """Come to rest within ``STOP_TIME``, about where an even deceleration would."""
        here = self._point(now)
        end = here.positions[0] + here.velocities[0] * STOP_TIME / 2
        end = np.clip(end, self.limits.lower, self.limits.upper)
        return _join([here, standing(end, now + STOP_TIME)])


def standing(position: np.ndarray, time: float) -> Trajectory:
    """At rest at joint positions (5,) rad from a time in s on."""
    rest = np.zeros((1, arm.DOF))
    return Trajectory(np.array([time]), position[None], rest, rest)


def _select(trajectory: Trajectory, which: np.ndarray) -> Trajectory:
    """The points of a mask (n,) of bool."""
    times, q, v, a = (array[which] for array in trajectory[:4])
    return Trajectory(times, q, v, a)


def _join(parts: list[Trajectory]) -> Trajectory:
    """One trajectory of the points of several, whose times follow each other."""
    times, q, v, a = (np.concatenate(arrays) for arrays in zip(*(p[:4] for p in parts)))
    return Trajectory(times, q, v, a)
