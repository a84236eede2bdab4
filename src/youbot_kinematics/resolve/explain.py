"""Why a tour is not lines alone: what stops an arm that goes on as it is."""

from __future__ import annotations

import numpy as np

from .. import arm
from ..inverse import plane_joints, wrap_into_limits
from ..kinematics import YoubotKinematics
from ..posture import configuration
from ..trajectory import JointPath

# The way ahead is looked at every so many m, at so many pitches of the tool.
_STEP, _PITCHES = 0.002, 128
_STRETCH = 32  # points
_NO_POSTURE = "between, the arm cannot stand on the line in any posture inside its limits"


def explained(paths: list[JointPath], points, limits: arm.JointLimits) -> list[JointPath]:
    """The paths, with a reason for each that follows no line.

    Args:
        paths: as ``resolve`` gives them.
        points: checkpoints (n + 1, 3), m.
        limits: joint limits that the paths keep.
    """
    moves = [i for i, path in enumerate(paths) if path.kind in ("approach", "reconfiguration")]
    ends = [*(paths[i].to_checkpoint for i in moves[1:]), len(points) - 1]
    paths = [path._replace(reason=_NO_POSTURE) if path.kind == "detour" else path for path in paths]
    for i, end in zip(moves, ends):
        q, following = paths[i].joints[0], paths[i].from_checkpoint + 1
        here = YoubotKinematics(limits).forward_kinematics(q)[:3, 3]
        ahead = _points_along([here, *points[following : max(end, following) + 1]])
        paths[i] = paths[i]._replace(reason=why_not_as_it_is(q, ahead, limits))
    return paths


def why_not_as_it_is(q, ahead, limits: arm.JointLimits) -> str:
    """What stops an arm that follows a way and keeps its posture, as a sentence.

    Args:
        q: joints at the beginning, (5,) rad.
        ahead: positions of the tool, (m, 3), m, close together.
        limits: joint limits to keep.
    """
    posture = _posture(q)
    k, excess = _first_blocked(q, np.asarray(ahead), limits)
    if k is None:
        return f"{posture}, the arm can stand all along the way, but not move along it in one go"
    x, y, z = ahead[k]
    where = f"at ({x:.3f}, {y:.3f}, {z:.3f}) m"
    if np.isnan(excess).any(axis=1).all():
        return f"{posture}, the arm does not reach the line {where}"
    beyond = excess[_worst(excess).argmin()]
    joint = int(np.argmax(np.abs(beyond)))
    side = "upper" if beyond[joint] > 0 else "lower"
    limit = f"{side} limit {getattr(limits, side)[joint]:.4f} rad"
    return f"{posture}, {arm.JOINT_NAMES[joint]} would pass its {limit} {where}"


def _first_blocked(q, ahead, limits):
    """The first point ahead at which no pitch will do, and the excess (pitches, 4) there: or None.

    The way is looked at a stretch at a time, for it is often blocked near its beginning.
    """
    back = "reaching back" in _posture(q)
    azimuth = np.arctan2(ahead[:, 1], ahead[:, 0]) + np.pi * back
    # Joint 1 goes on from where it is: it cannot turn through the gap between its limits.
    turned = np.unwrap(np.append(arm.OFFSET[0] - q[0], azimuth))[1:]
    radius = np.hypot(ahead[:, 0], ahead[:, 1]) * (-1 if back else 1)
    elbow = int(q[2] + arm.OFFSET[2] < 0)
    for first in range(0, len(ahead), _STRETCH):
        rows = slice(first, first + _STRETCH)
        excess = _excess(turned[rows], radius[rows], ahead[rows, 2], elbow, limits)
        blocked = np.flatnonzero(_worst(excess).min(axis=1) > 0)
        if len(blocked):
            return first + int(blocked[0]), excess[blocked[0]]
    return None, None


def _worst(excess) -> np.ndarray:
    """The largest excess (...) of joints (..., 4), rad; infinite out of reach."""
    return np.nan_to_num(np.abs(excess).max(axis=-1), nan=np.inf)


def _excess(azimuth, radius, height, elbow: int, limits) -> np.ndarray:
    """By how much joints 1 to 4 pass their limits, in rad, NaN out of reach: (m, pitches, 4).

    Args:
        azimuth, radius, height: of the tool at m places, (m,), rad and m.
        elbow: 0 for +, 1 for -.
    """
    pitch = np.linspace(-np.pi, np.pi, _PITCHES, endpoint=False)
    bent, beyond = plane_joints(radius[:, None], height[:, None], pitch)
    joints = np.zeros((*beyond.shape, arm.DOF))
    joints[..., 1:4] = bent[..., elbow, :]
    joints = wrap_into_limits(joints, limits)
    joints[..., 0] = (arm.OFFSET[0] - azimuth)[:, None]
    excess = limits.excess(joints)[..., :4]
    excess[beyond != 0] = np.nan
    return excess


def _posture(q) -> str:
    held = configuration(np.asarray(q))
    reach = "reaching forward" if held["front"] else "reaching back"
    return f"{reach} with the elbow {'up' if held['elbow_up'] else 'down'}"


def _points_along(corners) -> np.ndarray:
    """Points (m, 3) along straight lines through corners, m."""
    points = [np.asarray(corners[:1], dtype=float)]
    for a, b in zip(corners[:-1], corners[1:]):
        n = max(int(np.ceil(np.linalg.norm(b - a) / _STEP)), 1)
        points.append(np.linspace(a, b, n + 1)[1:])
    return np.concatenate(points)
