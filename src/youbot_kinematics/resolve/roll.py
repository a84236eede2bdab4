"""The roll of the tool along a tour: joint 5, which moves the tool on no line.

It follows an orientation as far as its limits let it, as one smooth curve: joint 5 has no whole
turn, and never jumps by one.
"""

from __future__ import annotations

import numpy as np

from .. import arm
from .itinerary import Itinerary
from .smoothing import merged, roughness, solve_box

_SLOPE_WEIGHT = 0.1  # of first differences beside the second
_FOLLOW = 0.03  # of following the orientation beside the second differences, at weight 1
_MARGIN = 1e-3  # rad, kept from the limits: room for the curve through the waypoints


def wanted_roll(R, azimuth, pitch) -> np.ndarray:
    """Joint 5 (n,) rad, not wrapped, that turns the tool as nearly as it can to orientations.

    The roll gamma that maximises the trace of ``R^T Rz(azimuth) Ry(pitch) Rz(gamma)``.

    Args:
        R: wanted rotations of the tool in ``base_link``, (n, 3, 3).
        azimuth, pitch: phi and beta (n,) of the arm, rad, which the roll cannot change.
    """
    cos, sin = np.cos(azimuth)[:, None], np.sin(azimuth)[:, None]
    along, across = cos * R[:, 0] + sin * R[:, 1], cos * R[:, 1] - sin * R[:, 0]
    a0 = np.cos(pitch)[:, None] * along - np.sin(pitch)[:, None] * R[:, 2]
    gamma = np.arctan2(across[:, 0] - a0[:, 1], a0[:, 0] + across[:, 1])
    return -arm.OFFSET[4] - gamma


def smooth_roll(way: Itinerary, wanted, weight: float, limits: arm.JointLimits) -> np.ndarray:
    """Joint 5 (n,) rad along an itinerary: as it is given, near what is wanted, and smooth.

    Args:
        wanted: (n,) rad, modulo whole turns; without meaning if the weight is zero.
        weight: how much it counts beside moving smoothly.
    """
    given = np.isfinite(way.roll)
    lower, upper = limits.lower[4] + _MARGIN, limits.upper[4] - _MARGIN
    wanted = _turned_into(np.unwrap(wanted), way.roll, lower, upper)
    form = roughness(way.route.progress, way.run, _SLOPE_WEIGHT)
    _hold_together(form, way)
    form[0] += weight * _FOLLOW
    bands, gradient = merged(form, -weight * _FOLLOW * wanted, way.joined)
    bands[0] += 1e-9  # definite, even where nothing asks for a roll
    first = np.flatnonzero(~way.joined)
    low = np.maximum.reduceat(np.where(given, way.roll, lower), first)
    high = np.minimum.reduceat(np.where(given, way.roll, upper), first)
    return solve_box(bands, gradient, low, high)[np.cumsum(~way.joined) - 1]


def _hold_together(form, way: Itinerary):
    """Adds the first differences over moves, which shall not turn the tool for nothing."""
    between = ((np.diff(way.run) > 0) & ~way.joined[1:]) * _SLOPE_WEIGHT
    form[0, :-1] += between
    form[0, 1:] += between
    form[1, :-1] -= between


def _turned_into(wanted, given, lower, upper) -> np.ndarray:
    """``wanted``, by whole turns as far inside the limits and as near what is given as it goes."""
    turned = wanted + 2 * np.pi * np.arange(-3, 4)[:, None]
    inside = np.clip(turned, lower, upper)
    missed = np.nansum((turned - given) ** 2, axis=-1)
    return inside[np.argmin(((turned - inside) ** 2).sum(axis=-1) + missed)]
