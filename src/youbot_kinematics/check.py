"""Does a trajectory keep its promises? Judged from forward kinematics only.

The trajectory is looked at as the controller will run it: its quintic interpolation, every
millisecond; and its points are held against the contract of those who receive them. Nothing here
comes from the planner but the checkpoints to visit, so that the check can judge any trajectory,
whoever made it.
"""

from __future__ import annotations

from dataclasses import asdict, dataclass, fields
from typing import Iterator, NamedTuple

import numpy as np
from scipy.spatial.transform import Rotation

from .arm import JointLimits
from .contract import (
    Command,
    command_from_trajectory,
    motion_problems,
    shape_problems,
    trajectory_from_command,
)
from .kinematics import smallest_singular_value, tool_pose
from .trajectory import Trajectory, interpolate

#: The trajectory is evaluated this often, s; but no more than so many times from point to point.
SAMPLE_TIME, SAMPLES = 0.001, 1000
#: How far the tool may leave a straight line, and miss a checkpoint, m.
LINE_TOLERANCE, CHECKPOINT_TOLERANCE = 1e-4, 1e-6
#: How far the tool may turn away from a checkpoint's orientation where that is demanded, rad.
ANGLE_TOLERANCE = 1e-6
# Roundings that do not count, in fractions of a limit and rad.
_ROUNDING = 1e-9
# So many points are looked at in one go: a long trajectory would fill the memory.
_CHUNK = 100


@dataclass(frozen=True)
class Report:
    """What a trajectory does, at its worst moment each; NaN where that is not known."""

    duration: float  # s
    line_distance: float  # of the tool from its straight line, m
    limit_margin: float  # of the joint nearest to a limit, rad; negative outside
    velocity_fraction: float  # of the velocity limit
    acceleration_fraction: float  # of the acceleration limit
    smallest_singular_value: float  # of the Jacobian
    checkpoint_distances: tuple[float, ...]  # by which each checkpoint is missed, m
    checkpoint_angles: tuple[float, ...]  # of the tool from each checkpoint's orientation, rad
    reconfigurations: float  # stops on the way at which the arm changes its posture
    detours: float  # moves that leave a line where the arm cannot follow it
    failures: tuple[str, ...]  # a sentence for each promise that is broken

    @property
    def passed(self) -> bool:
        """Whether the trajectory may be sent to the arm."""
        return not self.failures

    def as_dict(self) -> dict:
        """The report as JSON knows it."""
        return {**asdict(self), "passed": self.passed}

    def lines(self) -> list[str]:
        """The report for people, a line for each figure that is known."""
        return [f"{name:20}{text}" for name, text in self.rows()]

    def rows(self) -> list[tuple[str, str]]:
        """What each line of the report is about, and what it says."""
        missed = max(self.checkpoint_distances, default=np.nan)
        figures = [
            ("duration", self.duration, "{:.2f} s"),
            ("off the lines", self.line_distance * 1000, "{:.4f} mm at most"),
            ("checkpoints missed", missed * 1000, "{:.6f} mm at most"),
            ("joint limits", self.limit_margin, "{:.4f} rad away at least"),
            ("velocity", self.velocity_fraction, "{:.1%} of its limit at most"),
            ("acceleration", self.acceleration_fraction, "{:.1%} of its limit at most"),
            ("singular value", self.smallest_singular_value, "{:.4f} at least"),
            ("reconfigurations", self.reconfigurations, "{:.0f}"),
            ("detours", self.detours, "{:.0f}"),
        ]
        known = [figure for figure in figures if not np.isnan(figure[1])]
        return [(name, text.format(value)) for name, value, text in known]


def check(
    trajectory: Trajectory, limits: JointLimits, acceleration: float, checkpoints=None, exact=()
) -> Report:
    """Judges a trajectory, as the message that it becomes.

    Args:
        trajectory: with the segments that say where it follows a line, if it has any.
        limits: joint limits to hold it against.
        acceleration: limit of every joint's acceleration, rad/s^2.
        checkpoints: poses to visit in order, the first where the arm starts, (n + 1, 4, 4), m.
        exact: bool for each but the first, (n,): whether its orientation is demanded, not only its
            position; none is if not given.

    Returns:
        The figures, and a sentence for each promise that is broken.
    """
    command = command_from_trajectory(trajectory)
    return check_command(command, limits, acceleration, trajectory.segments, checkpoints, exact)


def check_command(
    command: Command,
    limits: JointLimits,
    acceleration: float,
    segments=(),
    checkpoints=None,
    exact=(),
) -> Report:
    """Judges a message, whoever made it and whatever it is like.

    Args:
        command: what the message says.
        limits, acceleration, checkpoints, exact: as for ``check``.
        segments: ``Segment`` each, in order of time; none if they are not known.

    Returns:
        The figures, which are NaN where the message is no motion at all or nothing is known of its
        lines, and a sentence for each promise that is broken.
    """
    problems = tuple(shape_problems(command, limits))
    if motion_problems(command):
        nothing = dict.fromkeys((f.name for f in fields(Report)), np.nan)
        known: dict = {"checkpoint_distances": (), "checkpoint_angles": (), "failures": problems}
        return Report(**{**nothing, **known})
    trajectory = trajectory_from_command(command)._replace(segments=tuple(segments))
    lines = _lines_of(segments, checkpoints)
    peaks = _Peaks.over(_peaks(trajectory, times, lines) for times in _moments(trajectory))
    distances, angles = _missed(trajectory, checkpoints)
    kinds = [segment.kind for segment in segments]
    figures = {
        "duration": trajectory.duration,
        "line_distance": peaks.line_distance,
        "limit_margin": float(min(*(peaks.lowest - limits.lower), *(limits.upper - peaks.highest))),
        "velocity_fraction": float((peaks.velocity / limits.velocity).max()),
        "acceleration_fraction": float(peaks.acceleration.max() / acceleration),
        "smallest_singular_value": peaks.singular_value,
        "checkpoint_distances": distances,
        "checkpoint_angles": angles,
        "reconfigurations": kinds.count("reconfiguration") if kinds else np.nan,
        "detours": kinds.count("detour") if kinds else np.nan,
    }
    return Report(**figures, failures=(*problems, *_failures(figures, peaks, limits, exact)))


def distance_to_line(points, a, b) -> np.ndarray:
    """Distance (n,) of points (n, 3) from straight lines, in m.

    The lines are between points a and b, (3,) for the same line or (n, 3) for one each.
    """
    along = b - a
    square = np.maximum((along**2).sum(axis=-1), 1e-18)
    s = np.clip(((points - a) * along).sum(axis=-1) / square, 0.0, 1.0)
    return np.linalg.norm(points - a - s[:, None] * along, axis=1)


class _Lines(NamedTuple):
    """When the tool follows straight lines, in order of time, and which."""

    start: np.ndarray  # (m,) s
    end: np.ndarray  # (m,) s
    a: np.ndarray  # where each begins, (m, 3) m
    b: np.ndarray  # where it ends, (m, 3) m


class _Peaks(NamedTuple):
    """The worst of a stretch of time, for each joint (5,) or for the tool."""

    lowest: np.ndarray  # rad
    highest: np.ndarray  # rad
    velocity: np.ndarray  # without its sign, rad/s
    acceleration: np.ndarray  # without its sign, rad/s^2
    singular_value: float  # the smallest
    line_distance: float  # m; NaN on no line

    @classmethod
    def over(cls, stretches) -> _Peaks:
        """The worst of several stretches."""
        lowest, highest, v, a, singular_value, line = (np.array(x) for x in zip(*stretches))
        return cls(
            lowest.min(axis=0),
            highest.max(axis=0),
            v.max(axis=0),
            a.max(axis=0),
            float(singular_value.min()),
            float(np.fmax.reduce(line)),
        )


def _moments(trajectory: Trajectory) -> Iterator[np.ndarray]:
    """The times (m,) to look at, in s, a stretch at a time: all points, and many between them."""
    for first in range(0, max(len(trajectory.times) - 1, 1), _CHUNK):
        points = trajectory.times[first : first + _CHUNK + 1]
        step = np.diff(points)
        n = np.clip(np.ceil(step / SAMPLE_TIME - _ROUNDING), 1, SAMPLES).astype(int)
        i = np.repeat(np.arange(len(n)), n)
        done = (np.arange(n.sum()) - np.repeat(np.cumsum(n) - n, n)) / n[i]
        yield np.append(points[i] + done * step[i], points[-1])


def _peaks(trajectory: Trajectory, times, lines: _Lines) -> _Peaks:
    q, v, a = interpolate(trajectory, times)
    return _Peaks(
        q.min(axis=0),
        q.max(axis=0),
        np.abs(v).max(axis=0),
        np.abs(a).max(axis=0),
        float(smallest_singular_value(q).min()),
        _line_distance(lines, times, tool_pose(q)[:, :3, 3]),
    )


def _lines_of(segments, checkpoints) -> _Lines:
    known = [s for s in segments if s.kind == "line" and checkpoints is not None]
    if not known:
        return _Lines(*np.zeros((2, 0)), *np.zeros((2, 0, 3)))
    start, end = np.array([(s.start, s.end) for s in known]).T
    numbers = np.array([(s.from_checkpoint, s.to_checkpoint) for s in known]).T
    return _Lines(start, end, *checkpoints[numbers, :3, 3])


def _line_distance(lines: _Lines, times, tool) -> float:
    """How far the tool (m, 3) is from its lines at times (m,), at most; NaN if it is on none."""
    i = np.searchsorted(lines.start, times, side="right") - 1
    on_line = i >= 0
    on_line[on_line] = times[on_line] <= lines.end[i[on_line]]
    if not on_line.any():
        return np.nan
    a, b = lines.a[i[on_line]], lines.b[i[on_line]]
    return float(distance_to_line(tool[on_line], a, b).max())


def _missed(trajectory, checkpoints):
    """By how much each checkpoint after the start is missed: distances (m) and angles (rad)."""
    if checkpoints is None:
        return (), ()
    T = tool_pose(trajectory.positions)
    end_times = {segment.to_checkpoint: segment.end for segment in trajectory.segments}
    distances, angles = [], []
    for number, wanted in enumerate(checkpoints[1:], start=1):
        if number in end_times:
            i = int(np.argmin(np.abs(trajectory.times - end_times[number])))
        else:
            i = int(np.argmin(np.linalg.norm(T[:, :3, 3] - wanted[:3, 3], axis=1)))
        turn = Rotation.from_matrix(T[i, :3, :3].T @ wanted[:3, :3])
        distances.append(float(np.linalg.norm(T[i, :3, 3] - wanted[:3, 3])))
        angles.append(float(turn.magnitude()))
    return tuple(distances), tuple(angles)


def _failures(figures, peaks, limits, exact):
    if figures["limit_margin"] < -_ROUNDING:
        low_is_worse = (limits.lower - peaks.lowest).max() > (peaks.highest - limits.upper).max()
        yield limits.describe_violation(peaks.lowest if low_is_worse else peaks.highest)
    for name in ("velocity", "acceleration"):
        if figures[f"{name}_fraction"] > 1 + _ROUNDING:
            yield f"a joint's {name} is {figures[f'{name}_fraction']:.1%} of its limit"
    if figures["line_distance"] > LINE_TOLERANCE:
        yield (
            f"the tool leaves its line by {figures['line_distance'] * 1000:.3f} mm,"
            f" more than {LINE_TOLERANCE * 1000:g} mm"
        )
    for number, distance in enumerate(figures["checkpoint_distances"], start=1):
        if distance > CHECKPOINT_TOLERANCE:
            yield f"checkpoint {number} is missed by {distance * 1000:.4f} mm"
    for number, (angle, demanded) in enumerate(zip(figures["checkpoint_angles"], exact), start=1):
        if demanded and angle > ANGLE_TOLERANCE:
            yield f"the tool is turned from checkpoint {number}'s orientation by {angle:.2g} rad"
