"""Inverse kinematics for the tool's position alone: which orientations it leaves open.

A position takes three of the five joints' freedoms. The roll of the tool, joint 5, does not move
it, and its pitch is free on intervals that are known exactly: see ``intervals``. Pitch and roll are
those of the tool as one sees it, the same whether the arm reaches forward or over its back::

    R = Rz(azimuth of the position) Ry(pitch) Rz(roll)

The pitch is 0 where the tool points up, and pi / 2 where it points away from joint 1's axis.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from . import arm
from .exceptions import InputError
from .formulas import LIMIT_ROUNDING, ON_PLANE
from .intervals import bound_directions, feasible_intervals, turned_next_to
from .inverse import (
    AZIMUTH_0,
    FOREARM,
    ROLL_0,
    SHOULDER_R,
    SHOULDER_Z,
    TOOL_LENGTH,
    TOOL_OFFSET,
    UPPER_ARM,
    plane_joints,
    wrap_into_limits,
)
from .planar import distinct, wrap_between

#: The shoulder in the arm's plane, z + i r in m: angles count from the vertical, towards r.
SHOULDER = complex(SHOULDER_Z, SHOULDER_R)
#: From wrist to tool for pitch 0, m.
TOOL = complex(TOOL_LENGTH, -TOOL_OFFSET)


class PositionSolutions(NamedTuple):
    """The solutions for a position: the intervals of the pitch, and some joints from them."""

    #: For each of the four branches, in the order of ``inverse.BRANCH_NAMES``, every pitch that has
    #: joints inside the limits: a list of intervals (low, high), rad, ends included. An interval
    #: across +-pi has high > pi.
    pitch_intervals: list
    #: Joints (k, 5), rad. For a given pitch: one for each branch that has it. For none given: one
    #: for each interval.
    solutions: np.ndarray


def inverse_position(p, limits: arm.JointLimits, pitch=None, roll=None, seed=None):
    """Solves for the tool's position, with its pitch, its roll, both or neither given.

    Args:
        p: position (3,) of ``arm_link_ee`` in ``base_link``, m.
        limits: the limits that the solutions keep.
        pitch: pitch of the tool, rad. Default: on each interval the seed's pitch, or the nearest to
            it; without a seed, the middle.
        roll: roll of the tool, rad. Default: the seed's joint 5, or the middle of its range.
        seed: joint positions (5,), rad. On joint 1's axis they give joint 1, too.

    Returns:
        ``PositionSolutions``.

    Raises:
        InputError: p is not three finite numbers, or pitch or roll is not one.
    """
    p, pitch, roll = _as_numbers(p, (3,), "p"), _optional(pitch, "pitch"), _optional(roll, "roll")
    start = (limits.lower + limits.upper) / 2 if seed is None else np.asarray(seed)
    reach = float(np.hypot(p[0], p[1]))
    azimuth = np.arctan2(p[1], p[0]) if reach > ON_PLANE else AZIMUTH_0 - start[0]

    pitch_intervals, solutions = [], []
    for sign, turn in ((1, 0.0), (-1, np.pi)):  # forward; over the back, in the plane turned by pi
        q1 = AZIMUTH_0 - azimuth - turn
        q5 = start[4] if roll is None else ROLL_0 - roll - turn
        for elbow, intervals in enumerate(_branch_intervals(q1, q5, sign * reach, p[2], limits)):
            pitch_intervals.append(_as_seen(intervals, sign))
            for low, high in intervals if pitch is None else _only(sign * pitch, intervals):
                beta = (low + high) / 2 if seed is None else _plane_pitch(start, low, high)
                joints, _ = plane_joints(sign * reach, p[2], np.array(beta))
                solutions.append([q1, *joints[elbow], q5])
    q = wrap_into_limits(np.reshape(solutions, (-1, arm.DOF)), limits)
    return PositionSolutions(pitch_intervals, distinct(q[limits.contain(q)]))


def plane_pitch_intervals(radius: float, height: float, limits: arm.JointLimits) -> list:
    """Every pitch at which joints 2, 3 and 4 reach a point of the arm's plane inside their limits.

    Args:
        radius, height: signed reach r and height z of the tool, m.

    Returns:
        Two lists, for elbow + and -, of intervals (low, high) of the pitch beta of the arm's plane,
        in rad, as ``intervals.feasible_intervals`` has them.
    """
    bounds = [(limit + arm.OFFSET)[1:4] for limit in (limits.lower, limits.upper)]
    target = complex(height, radius) - SHOULDER
    directions = bound_directions(target, TOOL, UPPER_ARM, FOREARM, *bounds)

    def feasible(pitch):
        joints, beyond = plane_joints(radius, height, pitch)
        lower, upper = limits.lower[1:4], limits.upper[1:4]
        joints = wrap_between(joints, lower, upper)
        inside = ((joints >= lower) & (joints <= upper)).all(axis=-1)
        return inside & (beyond == 0)[:, None]

    return feasible_intervals(directions, feasible)


def _branch_intervals(q1, q5, radius, height, limits):
    """The two elbows' intervals of the plane's pitch; none if joint 1 or 5 is out of its limits."""
    lower, upper = limits.lower[[0, 4]], limits.upper[[0, 4]]
    turned = wrap_between(np.array([q1, q5]), lower, upper)
    if not ((turned >= lower) & (turned <= upper)).all():
        return [], []
    return plane_pitch_intervals(radius, height, limits)


def _as_seen(intervals, sign):
    """Intervals of the plane's pitch as ones of the pitch that one sees: minus that at the back."""
    if sign > 0:
        return intervals
    turns = [2 * np.pi if high > np.pi else 0.0 for _, high in intervals]
    return sorted((turn - high, turn - low) for turn, (low, high) in zip(turns, intervals))


def _only(pitch, intervals):
    """The given pitch as the only interval, if the intervals contain it."""
    for low, high in turned_next_to(pitch, intervals):
        if low - LIMIT_ROUNDING <= pitch <= high + LIMIT_ROUNDING:
            return [(pitch, pitch)]
    return []


def _plane_pitch(q, low, high):
    """The pitch of the arm's plane of joints q (5,), or else the nearest between low and high."""
    ((turned_low, turned_high),) = turned_next_to((q + arm.OFFSET)[1:4].sum(), [(low, high)])
    return np.clip((q + arm.OFFSET)[1:4].sum(), turned_low, turned_high)


def _optional(angle, name: str):
    return None if angle is None else float(_as_numbers(angle, (), name))


def _as_numbers(value, shape: tuple, name: str) -> np.ndarray:
    """``value`` as finite numbers of a shape."""
    try:
        array = np.asarray(value, dtype=float)
    except (TypeError, ValueError, OverflowError):
        array = np.array([np.nan])
    if array.shape != shape or not np.isfinite(array).all():
        raise InputError(f"{name} must be finite and of shape {shape}, not {value!r}")
    return array
