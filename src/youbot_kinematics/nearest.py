"""The reachable pose that is nearest to any pose: first its position, then its orientation.

**Position.** Where it can be reached inside the limits, it is kept. Otherwise the nearest point of
the workspace is one at which no joint can bring the tool nearer: each joint is on a limit, or sees
the tool and the point in one line. With joint 1 on a limit or the arm's plane through the point,
and three choices (lower limit, upper limit, in line towards or away) for each of joints 2 to 4,
those are finitely many, each in closed form: the nearest of them is the answer.

**Orientation.** In the arm's plane the tool's rotation is ``Ry(beta) Rz(gamma)``, with the rank-one
quaternion (w, x, y, z) = (cb cg, sb sg, sb cg, cb sg) in half angles. For the wanted rotation's
quaternion let M = [[w, z], [y, x]]. With u = (cos beta/2, sin beta/2), v = (cos gamma/2, sin
gamma/2), the angle between the two rotations is ``2 acos |u^T M v|``. It is least for the largest
singular vectors of M, and where these are outside of the intervals of beta and gamma, on an end of
one: with beta given, v is along M^T u, with gamma given, u along M v.
"""

from __future__ import annotations

from itertools import product
from typing import NamedTuple

import numpy as np

from . import arm
from .exceptions import InputError
from .inverse import (
    AZIMUTH_0,
    FOREARM,
    ROLL_0,
    UPPER_ARM,
    as_transforms,
    inverse_branches,
    plane_azimuths,
)
from .planar import distinct, wrap_between
from .position import SHOULDER, TOOL, plane_pitch_intervals

# How far a matrix may be from a rotation, as poses printed to some digits are.
_PRINTED = 1e-2
# Distances that differ by less are equal (m): they differ by rounding.
_TIE = 1e-10
# For joints 2 to 4, every combination of: lower limit, upper limit, in line towards, in line away.
_CHOICES = np.array(list(product(range(4), repeat=3))).T


class NearestPose(NamedTuple):
    """The nearest reachable pose, how far it is from the one asked for, and the joints for it."""

    pose: np.ndarray  # (4, 4) in base_link, m
    position_error: float  # m
    angle_error: float  # rad
    solutions: np.ndarray  # (k, 5) rad, k >= 1


class _Place(NamedTuple):
    """A reachable position in one of the planes of the arm, and an interval of its pitch there."""

    azimuth: float  # phi of the plane, rad
    radius: float  # r, signed, m
    height: float  # z, m
    pitches: tuple[float, float]  # beta, rad


def nearest_reachable_pose(T, limits: arm.JointLimits, seed=None) -> NearestPose:
    """Finds the pose inside the limits whose position, and then whose orientation, is nearest.

    Args:
        T: pose of ``arm_link_ee`` in ``base_link``, (4, 4), m. Its rotation may be rounded to a few
            digits: the rotation nearest to the matrix is meant.
        limits: the limits that the solutions keep.
        seed: joint positions (5,), rad; see ``inverse.inverse_branches``.

    Returns:
        ``NearestPose``. Both errors are 0 if T itself can be reached.

    Raises:
        InputError: T is not one rigid transform.
    """
    T = _orthonormal(T)
    reached = inverse_branches(T, limits, seed)
    if reached.valid.any():
        return NearestPose(T, 0.0, 0.0, distinct(reached.joints[reached.valid]))
    places, distance = _nearest_places(T, plane_azimuths(T, limits, seed), limits)
    pose = _likest(T, places, limits)
    if distance == 0:
        pose[:3, 3] = T[:3, 3]
    solved = inverse_branches(pose, limits, seed)
    turn = _rotations().from_matrix(pose[:3, :3].T @ T[:3, :3])
    solutions = distinct(solved.joints[solved.valid])
    return NearestPose(pose, distance, float(turn.magnitude()), solutions)


def _rotations():
    """SciPy's rotations, which take longer to import than all of the kinematics."""
    from scipy.spatial.transform import Rotation

    return Rotation


def _orthonormal(T) -> np.ndarray:
    """T (4, 4) with the rotation that is nearest to its matrix."""
    T = as_transforms(T, tolerance=_PRINTED).copy()
    if T.ndim != 2:
        raise InputError(f"nearest_reachable_pose takes one pose (4, 4), not {T.shape}")
    u, _, v = np.linalg.svd(T[:3, :3])
    T[:3, :3] = u @ v
    return T


def _nearest_places(T, azimuths, limits) -> tuple[list[_Place], float]:
    """Every way to bring the tool as near to T's position as can be, and how near that is, m."""
    found = []
    on_limits = AZIMUTH_0 - limits.lower[0], AZIMUTH_0 - limits.upper[0]
    for azimuth, radius, aside, height in _planes(T, [*azimuths, *on_limits], limits):
        # In the two planes through the position, it is beside neither.
        aside = 0.0 if azimuth in azimuths else abs(aside)
        for distance, place in _places_in_plane(azimuth, radius, height, limits):
            found.append((float(np.hypot(distance, aside)), place))
    nearest = min(distance for distance, _ in found)
    return [place for distance, place in found if distance <= nearest + _TIE], nearest


def _places_in_plane(azimuth, radius, height, limits):
    """The ways to reach a point of the arm's plane or, if there are none, its nearest candidates.

    Yields:
        ``(distance, place)``: how far the place is from the point, m.
    """
    by_elbow = plane_pitch_intervals(radius, height, limits)
    for pitches in (*by_elbow[0], *by_elbow[1]):
        yield 0.0, _Place(azimuth, radius, height, pitches)
    if not any(by_elbow):
        target = complex(height, radius) - SHOULDER
        for tip, pitch in zip(*_extreme_points(target, limits)):
            tool = tip + SHOULDER
            yield abs(tip - target), _Place(azimuth, tool.imag, tool.real, (pitch, pitch))


def _planes(T, azimuths, limits):
    """Each azimuth that joint 1 allows, with T's position there: along it, across it, and up."""
    lower, upper = limits.lower[0], limits.upper[0]
    x, y, z = T[:3, 3]
    for phi in azimuths:
        if lower <= wrap_between(AZIMUTH_0 - phi, lower, upper) <= upper:
            cos, sin = np.cos(phi), np.sin(phi)
            yield phi, x * cos + y * sin, y * cos - x * sin, z


def _extreme_points(target: complex, limits):
    """Where joints 2 to 4, each on a limit or in line with a target, bring the tool.

    Args:
        target: a point of the arm's plane, z + i r from the shoulder, m.

    Returns:
        Positions (n,) of the tool as such points, m, and its pitches beta (n,), rad, for the
        combinations that are inside the limits.
    """
    links = UPPER_ARM, FOREARM, TOOL
    lower, upper = limits.lower[1:4], limits.upper[1:4]
    on_lower, on_upper, towards, _ = (_CHOICES == i for i in range(4))
    fixed = on_lower | on_upper
    at_limit = np.where(on_lower, lower[:, None], upper[:, None]) + arm.OFFSET[1:4, None]

    # From each joint, the tool as seen in its link's frame, with the fixed joints behind it.
    body = [np.full(fixed.shape[1], TOOL)]
    for i in (1, 0):
        body.insert(0, links[i] + np.where(fixed[i + 1], np.exp(1j * at_limit[i + 1]) * body[0], 0))

    n = fixed.shape[1]
    joint, heading, angles = np.zeros(n, complex), np.ones(n, complex), []
    for i in range(3):
        to_target = np.where(towards[i], 1, -1) * np.exp(1j * np.angle(target - joint))
        in_line = to_target * np.exp(-1j * np.angle(body[i]))
        turned = np.where(fixed[i], heading * np.exp(1j * at_limit[i]), in_line)
        angles.append(np.angle(turned / heading))
        joint, heading = joint + links[i] * turned, turned
    q = wrap_between(np.stack(angles, axis=-1) - arm.OFFSET[1:4], lower, upper)
    inside = ((q >= lower) & (q <= upper)).all(axis=-1)
    return joint[inside], np.angle(heading)[inside]


def _likest(T, places, limits):
    """The pose at one of the places that is turned least from T."""
    rolls = ROLL_0 - limits.upper[4], ROLL_0 - limits.lower[4]
    best = [
        (*_best_orientation(_half_angle_matrix(T, place), place.pitches, rolls), place)
        for place in places
    ]
    _, pitch, roll, place = max(best, key=lambda choice: choice[0])
    pose = np.eye(4)
    pose[:3, :3] = _rotations().from_euler("ZYZ", [place.azimuth, pitch, roll]).as_matrix()
    pose[:3, 3] = [
        place.radius * np.cos(place.azimuth),
        place.radius * np.sin(place.azimuth),
        place.height,
    ]
    return pose


def _half_angle_matrix(T, place) -> np.ndarray:
    """The matrix M (2, 2) of the module's text for T's rotation as seen in a plane of the arm."""
    Rotation = _rotations()
    in_plane = Rotation.from_euler("Z", -place.azimuth) * Rotation.from_matrix(T[:3, :3])
    x, y, z, w = in_plane.as_quat()
    return np.array([[w, z], [y, x]])


def _best_orientation(M, pitches, rolls):
    """The pitch and the roll, each from an interval (low, high), with the largest |u^T M v|.

    Returns:
        ``(|u^T M v|, pitch, roll)``.
    """
    u, _, _ = np.linalg.svd(M)
    choices = [
        (pitch, _into(rolls, M.T @ _half(pitch))) for pitch in (_into(pitches, u[:, 0]), *pitches)
    ]
    choices += [(_into(pitches, M @ _half(roll)), roll) for roll in rolls]
    return max((abs(_half(pitch) @ M @ _half(roll)), pitch, roll) for pitch, roll in choices)


def _half(angle: float) -> np.ndarray:
    return np.array([np.cos(angle / 2), np.sin(angle / 2)])


def _into(interval, half) -> float:
    """The angle with a direction (2,) of its half, or the end of the interval nearest to it."""
    low, high = interval
    angle = 2 * np.arctan2(half[1], half[0])
    turned = angle + 2 * np.pi * np.round(((low + high) / 2 - angle) / (2 * np.pi))
    return float(np.clip(turned, low, high))
