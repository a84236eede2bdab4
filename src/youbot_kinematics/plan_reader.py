"""A plan back from its JSON file, as ``export`` writes it, for ``check_trajectory``.

Here a value must be of the type that it should be; whether all of them make a trajectory is for
``contract`` and ``check`` to say.
"""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import NamedTuple

import numpy as np

from .bag_reader import printable
from .contract import NANOSECONDS, Command
from .exceptions import InputError
from .inverse import as_transforms
from .parameters import Parameters
from .trajectory import KINDS, Segment

# The parameters of a plan that its trajectory can be held against.
_JUDGED_BY = ("acceleration", "limits", "return_home")
# What a ROS duration holds, s.
_LONGEST = 2.0**31


class Subject(NamedTuple):
    """A command to judge, and what is known of the plan behind it."""

    command: Command
    segments: tuple[Segment, ...] = ()
    visited: np.ndarray | None = None  # poses of the targets in visiting order, (n, 4, 4), m
    order: list[int] | None = None  # their indices
    parameters: Parameters = Parameters()  # those that a trajectory is judged by


def read_plan(path) -> Subject:
    """Reads the JSON of a plan.

    Raises:
        InputError: it cannot be read, or a value has another type or size than ``export`` writes.
    """
    try:
        return _subject(_load(Path(path)))
    except (InputError, OverflowError) as error:
        raise InputError(printable(f"{path}: {error}")) from error


def _load(path: Path) -> dict:
    try:
        plan = json.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise InputError(error.strerror or str(error)) from error
    except (ValueError, RecursionError) as error:
        raise InputError(f"not JSON ({str(error)[:80]})") from error
    return _typed(plan, dict, "the plan")


def _subject(plan: dict) -> Subject:
    values = _member(plan, "points", list)
    points = [_typed(value, dict, f"point {i}") for i, value in enumerate(values)]
    names = [_typed(name, str, "a joint name") for name in _member(plan, "joint_names", list)]
    times = [_nanoseconds(point, i) for i, point in enumerate(points)]
    quantities = ("positions", "velocities", "accelerations")
    q, v, a = ([_numbers(point, name, i) for i, point in enumerate(points)] for name in quantities)
    given = _member(plan, "parameters", dict) if "parameters" in plan else {}
    parameters = Parameters.from_dict({key: given[key] for key in _JUDGED_BY if key in given})
    order, visited = _visited(plan)
    segments = _segments(_member(plan, "segments", list)) if "segments" in plan else ()
    return Subject(Command(names, times, q, v, a), segments, visited, order, parameters)


def _visited(plan: dict):
    """The order of the targets and their poses as visited, or None and None without them."""
    if "targets" not in plan:
        return None, None
    try:
        poses = np.array(_member(_member(plan, "targets", dict), "poses", list), dtype=float)
    except (TypeError, ValueError, OverflowError):
        raise InputError("the targets' poses must be arrays (4, 4) of numbers") from None
    poses = as_transforms(poses)
    if poses.ndim != 3:
        raise InputError(f"the targets' poses must be an array (n, 4, 4), not {poses.shape}")
    order = [_typed(i, int, "an index of the order") for i in _member(plan, "order", list)]
    if sorted(order) != list(range(len(poses))):
        raise InputError(f"the order must have each of {len(poses)} targets once")
    return order, poses[order]


def _segments(values: list) -> tuple[Segment, ...]:
    segments = tuple(_segment(value, f"segment {i}") for i, value in enumerate(values))
    for i, (before, after) in enumerate(zip(segments, segments[1:]), start=1):
        if after.start < before.start or after.end < before.end:
            raise InputError(f"segment {i} begins or ends before the one before it")
    return segments


def _segment(value, where: str) -> Segment:
    segment = _typed(value, dict, where)
    kind = _member(segment, "kind", str, where)
    if kind not in KINDS:
        raise InputError(f"{where} is of kind {kind!r}, and must be of {', '.join(KINDS)}")
    start, end = (_finite(segment, name, where) for name in ("start", "end"))
    first, last = (_member(segment, name, int, where) for name in ("from", "to"))
    if not 0 <= start <= end or not 0 <= first <= last:
        raise InputError(f"{where} goes backwards: {value}")
    return Segment(kind, start, end, first, last)


def _nanoseconds(point: dict, i: int) -> int:
    seconds = _finite(point, "time_from_start", f"point {i}")
    return round(seconds * NANOSECONDS)


def _finite(values: dict, name: str, where: str) -> float:
    number = _number(_member(values, name, (int, float), where))
    if not abs(number) < _LONGEST:
        raise InputError(f"{where}: {name} must be a time in s, not {number}")
    return number


def _numbers(point: dict, name: str, i: int) -> list[float]:
    """A row of a point's numbers, of any length; JSON's null is not a number."""
    row = _member(point, name, list, f"point {i}")
    return [
        math.nan if x is None else _number(_typed(x, (int, float), f"point {i}: one of the {name}"))
        for x in row
    ]


def _number(value) -> float:
    try:
        return float(value)
    except OverflowError:  # an integer of hundreds of digits
        return math.inf


def _member(values: dict, name: str, kind, where: str = "the plan"):
    if name not in values:
        raise InputError(f"{where} has no {name!r}")
    return _typed(values[name], kind, f"{where}: {name}")


def _typed(value, kind, what: str):
    if not isinstance(value, kind) or isinstance(value, bool):
        raise InputError(f"{what} must be {_WORDS[kind]}, not {str(value)[:40]!r}")
    return value


_WORDS = {
    dict: "an object",
    list: "a list",
    str: "a text",
    int: "a whole number",
    (int, float): "a number",
}
