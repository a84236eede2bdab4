"""Joint paths, timed trajectories, and how the controller fills in between their points."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.interpolate import CubicSpline

#: What a segment is for: the tool follows its straight line ("line"); the move to where the first
#: begins ("approach"); a change of posture, from and to one point of the tool ("reconfiguration");
#: from where the arm cannot follow the line to where it can again ("detour").
KINDS = ("line", "approach", "reconfiguration", "detour")


class Segment(NamedTuple):
    """A stretch of a trajectory with one purpose, from one checkpoint to the next.

    Checkpoint 0 is where the arm starts; checkpoint i is the i-th target visited.
    """

    kind: str  # one of KINDS
    start: float  # s
    end: float  # s
    from_checkpoint: int
    to_checkpoint: int
    reason: str = ""  # why it is there, where that needs one


class JointPath(NamedTuple):
    """A stretch of the way in joint space with one purpose, not timed yet.

    It begins and ends at rest, and runs through its joints as a cubic spline over ``s``.
    """

    kind: str  # as in Segment
    from_checkpoint: int
    to_checkpoint: int
    s: np.ndarray  # (m,) increasing from 0 to 1, in whatever measure the path is even in
    joints: np.ndarray  # (m, 5) rad
    reason: str = ""  # why there is such a path, where that needs one

    def spline(self) -> CubicSpline:
        """The joints (rad) as a function of s, twice continuously differentiable."""
        return CubicSpline(self.s, self.joints)


class Trajectory(NamedTuple):
    """Points of the five joints at uniformly spaced times; the first is where the arm is."""

    times: np.ndarray  # (n,) s, from 0
    positions: np.ndarray  # (n, 5) rad
    velocities: np.ndarray  # (n, 5) rad/s
    accelerations: np.ndarray  # (n, 5) rad/s^2
    segments: tuple[Segment, ...] = ()

    @property
    def duration(self) -> float:
        """Time of the last point, s."""
        return float(self.times[-1])


def interpolate(trajectory: Trajectory, times):
    """State of the arm at given times, as ``joint_trajectory_controller`` interpolates it.

    Between two points the controller follows the quintic polynomial that meets the position,
    velocity and acceleration of both; before the first point and after the last it stands there.

    Args:
        trajectory: one point or more.
        times: (m,) s.

    Returns:
        ``(positions, velocities, accelerations)``, each (m, 5): rad, rad/s, rad/s^2.
    """
    knots = trajectory.times
    times = np.clip(np.asarray(times, dtype=float), knots[0], knots[-1])
    if len(knots) == 1:
        return tuple(np.repeat(a, len(times), axis=0) for a in trajectory[1:4])
    i = np.clip(np.searchsorted(knots, times, side="right") - 1, 0, len(knots) - 2)
    t = (times - knots[i])[:, None]
    first, last = (i.min(), i.max() + 1) if len(i) else (0, 0)
    between = slice(first, last + 1)
    coefficients = _quintics(knots[between], *(rows[between] for rows in trajectory[1:4]))
    p0, v0, a0, c3, c4, c5 = (c[i - first] for c in coefficients)
    return (
        p0 + t * (v0 + t * (a0 / 2 + t * (c3 + t * (c4 + t * c5)))),
        v0 + t * (a0 + t * (3 * c3 + t * (4 * c4 + t * 5 * c5))),
        a0 + t * (6 * c3 + t * (12 * c4 + t * 20 * c5)),
    )


def _quintics(knots, p, v, a):
    """The polynomials between n points: position, velocity and acceleration at their beginnings,
    and their coefficients from the cubic's on; (n - 1, 5) each."""
    h = np.diff(knots)[:, None]
    p0, v0, a0 = p[:-1], v[:-1], a[:-1]
    # The cubic's and higher coefficients, from what the quadratic start leaves to the end.
    dp = p[1:] - p0 - v0 * h - a0 * h**2 / 2
    dv = (v[1:] - v0 - a0 * h) * h
    da = (a[1:] - a0) * h**2
    c3 = (10 * dp - 4 * dv + da / 2) / h**3
    c4 = (-15 * dp + 7 * dv - da) / h**4
    c5 = (6 * dp - 3 * dv + da / 2) / h**5
    return p0, v0, a0, c3, c4, c5
