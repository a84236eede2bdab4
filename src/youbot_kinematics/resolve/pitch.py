"""The pitch along a tour: smooth, in the tube where the joints stay inside their limits.

The search leaves stairs, one cell high. Here the pitch moves, at all waypoints at once, to where
the joints' own second differences along the path are least: Gauss-Newton steps over a quadratic
program with bounds. The joints come from the closed form, so that the tool stays in its place.
"""

from __future__ import annotations

import numpy as np

from .. import arm
from .itinerary import Itinerary
from .route import arm_joints
from .smoothing import banded_product, merged, roughness, solve_box

_MAX_STEPS, _HALVINGS = 12, 4
_LONGEST_STEP = 0.3  # rad
_HOLD = 1e-3  # of staying near the searched pitch beside the second differences, at weight 1
_SETTLED = 1e-3  # a step that gains a smaller fraction is the last
_SLOPE_WEIGHT = 0.1  # of first differences beside the second: the path shall be short as well
_BISECTIONS = 18
_EDGE = 0.03  # rad, kept from the tube's edge: the elbow may be straight there
_STRAIGHT = 0.05  # the least sine of the elbow that its slope is computed with


def smooth_pitch(way: Itinerary, limits: arm.JointLimits, hold: float = 0.0) -> np.ndarray:
    """The smooth pitch (n,) rad at the waypoints of an itinerary.

    Args:
        hold: how much staying near the itinerary's pitch counts beside smoothness.
    """
    first = np.flatnonzero(~way.joined)
    lower, upper = tube(way, limits)
    lower, upper = np.maximum.reduceat(lower, first), np.minimum.reduceat(upper, first)
    form = roughness(way.route.progress, way.run, _SLOPE_WEIGHT)
    # Runs that hang together, over checkpoints, are smoothed as far as each of these chains can be.
    chain = np.cumsum(np.append(True, (np.diff(way.run) > 0) & ~way.joined[1:])) - 1
    hold *= _HOLD
    pitch = way.pitch

    def rough_joints(pitch):
        joints, _ = joints_on(way, pitch, limits)
        terms = (joints * banded_product(form, joints)).sum(axis=-1)
        return joints, np.bincount(chain, terms + hold * (pitch - way.pitch) ** 2)

    joints, rough = rough_joints(pitch)
    for _ in range(_MAX_STEPS):
        pull = hold * (pitch - way.pitch)
        slope = slopes(joints, pitch)
        bands, gradient = _normal_form(form, joints[:, 1:], slope, hold, pull, way.joined)
        low = np.maximum(lower - pitch[first], -_LONGEST_STEP)
        high = np.minimum(upper - pitch[first], _LONGEST_STEP)
        step = solve_box(bands, gradient, low, high)[np.cumsum(~way.joined) - 1]
        part, before = np.ones_like(rough), rough
        for _ in range(_HALVINGS):
            joints, rough = rough_joints(pitch + part[chain] * step)
            worse = ~(rough <= before)
            if not worse.any():
                break
            part[worse] /= 4
        part[worse] = 0.0
        pitch = pitch + part[chain] * step
        joints, rough = rough_joints(pitch)
        if (rough > before * (1 - _SETTLED)).all():
            break
    return pitch


def _normal_form(form, joints, slope, hold, pull, joined):
    """Bands and gradient of the roughness of ``joints + slope * step``, as a form of the step."""
    bands = np.zeros_like(form)
    for k in range(len(form)):
        n = len(joints) - k
        bands[k, :n] = form[k, :n] * (slope[:n] * slope[k:]).sum(axis=-1)
    bands[0] += hold + 1e-9  # definite, even where nothing depends on a step
    gradient = (slope * banded_product(form, joints)).sum(axis=-1) + pull
    return merged(bands, gradient, joined)


def joints_on(way: Itinerary, pitch, limits):
    """Joints 1 to 4 on the itinerary's branches at pitches (n,), and their excess: (n, 4) each."""
    return arm_joints(way.route, 2 * way.track + way.elbow, pitch, limits)


def tube(way: Itinerary, limits: arm.JointLimits):
    """Bounds (n,), (n,) in rad of the pitch around its value, inside of which the arm can stand."""
    lower, upper = (_edge_of_tube(way, side, limits) for side in (-1, 1))
    edge = np.minimum(_EDGE, (upper - lower) / 4)
    lower, upper = lower + edge, upper - edge
    return np.where(way.fixed, way.pitch, lower), np.where(way.fixed, way.pitch, upper)


def _edge_of_tube(way: Itinerary, side: int, limits) -> np.ndarray:
    """How far (n,) rad the pitch can go down (side -1) or up (1)."""
    n, n_cells = way.standing.shape
    cell = 2 * np.pi / n_cells
    home = np.floor((way.pitch + np.pi) / cell).astype(int)
    inside, alive = way.pitch.copy(), np.ones(n, dtype=bool)
    for i in range(1, n_cells // 2):
        alive &= way.standing[np.arange(n), (home + side * i) % n_cells]
        if not alive.any():
            break
        inside[alive] = ((home + side * i + 0.5) * cell - np.pi)[alive]
    outside = inside + side * cell
    for _ in range(_BISECTIONS):
        middle = (inside + outside) / 2
        good = (joints_on(way, middle, limits)[1] == 0).all(axis=-1)
        inside, outside = np.where(good, middle, inside), np.where(good, outside, middle)
    return inside


def slopes(joints, pitch) -> np.ndarray:
    """Derivatives (n, 3) of joints 2, 3, 4 by the pitch, with the tool's position held.

    Args:
        joints: joints 1 to 4, (n, 4) rad.
        pitch: (n,) rad.
    """
    offset, length = arm.A[3], -arm.D[4]
    elbow = joints[:, 2] + arm.OFFSET[2]
    t2 = joints[:, 1] + arm.OFFSET[1]
    t23 = t2 + elbow
    # The wrist circles the tool, and the two links follow the wrist: the inverse of the planar
    # two-link Jacobian (Siciliano et al. (2009), section 3.2.1).
    dr = -offset * np.sin(pitch) - length * np.cos(pitch)
    dz = -offset * np.cos(pitch) + length * np.sin(pitch)
    sine = np.copysign(np.maximum(np.abs(np.sin(elbow)), _STRAIGHT), np.sin(elbow))
    d2 = (np.sin(t23) * dr + np.cos(t23) * dz) / (arm.A[1] * sine)
    d23 = -(np.sin(t2) * dr + np.cos(t2) * dz) / (arm.A[2] * sine)
    return np.stack([d2, d23 - d2, 1 - d23], axis=-1)
