"""Straight lines between checkpoints, with slerped orientation."""

from __future__ import annotations

import numpy as np
from scipy.spatial.transform import Rotation, Slerp


def pose_between(T_a, T_b, s) -> np.ndarray:
    """Poses on the way from one pose to another.

    The position moves on the straight line, the orientation turns about a fixed axis at constant
    rate (slerp: Shoemake 1985); both at once, and evenly.

    Args:
        T_a, T_b: the two poses, (4, 4), m.
        s: fractions of the way, (m,), 0 to 1.

    Returns:
        (m, 4, 4), m.
    """
    T_a, T_b, s = np.asarray(T_a, dtype=float), np.asarray(T_b, dtype=float), np.asarray(s)
    poses = np.tile(np.eye(4), (len(s), 1, 1))
    poses[:, :3, 3] = T_a[:3, 3] + s[:, None] * (T_b[:3, 3] - T_a[:3, 3])
    if len(s):
        slerp = Slerp([0.0, 1.0], Rotation.from_matrix([T_a[:3, :3], T_b[:3, :3]]))
        poses[:, :3, :3] = slerp(s).as_matrix()
    return poses


def decoupled_rot_and_trans(T_a, T_b, num_points: int) -> np.ndarray:
    """Evenly spaced poses from one checkpoint to the next, without the two themselves.

    Args:
        T_a, T_b: poses of the checkpoints, (4, 4), m.
        num_points: how many poses between them.

    Returns:
        (num_points, 4, 4), m.
    """
    return pose_between(T_a, T_b, np.linspace(0.0, 1.0, num_points + 2)[1:-1])


def intermediate_tfs(order, poses, num_points: int) -> np.ndarray:
    """The whole way through checkpoints in an order, checkpoints included, each once.

    Args:
        order: indices of the checkpoints in visiting order, (n,).
        poses: poses of the checkpoints, (n, 4, 4), m.
        num_points: intermediate poses between two checkpoints.

    Returns:
        ((n - 1) * (num_points + 1) + 1, 4, 4), m: the checkpoints are every (num_points + 1)-th,
        from the first to the last.
    """
    checkpoints = np.asarray(poses, dtype=float)[np.asarray(order, dtype=int)]
    way = [checkpoints[:1]]
    for T_a, T_b in zip(checkpoints[:-1], checkpoints[1:]):
        way += [decoupled_rot_and_trans(T_a, T_b, num_points), T_b[None]]
    return np.concatenate(way)
