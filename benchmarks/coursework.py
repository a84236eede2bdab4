"""The coursework's method, as a student writes it: what the package is compared with.

Denavit-Hartenberg matrices multiplied one by one; all permutations for the order; straight lines of
evenly spaced points; and at each the pseudo-inverse of the position's Jacobian, warm-started from
the point before, ``while error > 1e-4``. No limits, no damping. The loop has a cap here, which is
generous, and the last checkpoint, which the draft of the course drops, is visited.
"""

from __future__ import annotations

import itertools
from math import cos, sin

import numpy as np

from youbot_kinematics import arm

TOLERANCE = 1e-4  # m
MAX_ITERATIONS = 200  # where it converges, it takes fewer than 20
#: A joint that moves more than this from one point to the next has jumped, rad.
JUMP = 1.0


def dh_matrix(a, alpha, d, theta):
    return np.array(
        [
            [cos(theta), -sin(theta) * cos(alpha), sin(theta) * sin(alpha), a * cos(theta)],
            [sin(theta), cos(theta) * cos(alpha), -cos(theta) * sin(alpha), a * sin(theta)],
            [0.0, sin(alpha), cos(alpha), d],
            [0.0, 0.0, 0.0, 1.0],
        ]
    )


def frames(q):
    """The base's frame and those behind the five joints, 6 times (4, 4)."""
    theta = arm.THETA_0 + arm.OFFSET + arm.SIGN * q
    T = [np.eye(4)]
    for i in range(5):
        T.append(T[-1] @ dh_matrix(arm.A[i], arm.ALPHA[i], arm.D[i], theta[i]))
    return T


def position_jacobian(T):
    columns = []
    for i in range(5):
        lever = T[5][:3, 3] - T[i][:3, 3]
        columns.append(arm.SIGN[i] * np.cross(T[i][:3, 2], lever))
    return np.array(columns).T


def solve(position, q):
    """Joints (5,) whose tool is at a position (3,), and whether they were found, from joints q."""
    q = q.copy()
    for _ in range(MAX_ITERATIONS):
        T = frames(q)
        error = position - T[5][:3, 3]
        if np.linalg.norm(error) <= TOLERANCE:
            return q, True
        q = q + np.linalg.pinv(position_jacobian(T)) @ error
    return q, False


def shortest_order(start, positions):
    """The best of all permutations: order, (n,)."""
    best, shortest = None, np.inf
    for order in itertools.permutations(range(len(positions))):
        length, here = 0.0, start
        for i in order:
            length += np.linalg.norm(positions[i] - here)
            here = positions[i]
        if length < shortest:
            best, shortest = order, length
    return best


def plan(start, positions, num_points, order=None):
    """Joints at all points of the tour (m, 5), and whether each was found, (m,).

    Args:
        start: joints where the arm starts, (5,) rad.
        positions: of the targets, (n, 3), m.
        num_points: intermediate points between two checkpoints.
        order: in which to visit them, (n,); the best of all permutations, if not given.
    """
    first = frames(start)[5][:3, 3]
    if order is None:
        order = shortest_order(first, positions)
    checkpoints = [first] + [positions[i] for i in order]
    q, joints, found = start, [start], [True]
    for a, b in zip(checkpoints[:-1], checkpoints[1:]):
        for s in np.linspace(0.0, 1.0, num_points + 2)[1:]:
            q, converged = solve(a + s * (b - a), q)
            joints.append(q)
            found.append(converged)
    return np.array(joints), np.array(found)


def judge(joints, found, limits):
    """What is wrong with such a tour: numbers of its points, and how far a joint has turned."""
    steps = np.abs(np.diff(joints, axis=0)).max(axis=1)
    return {
        "points": len(joints),
        "not_converged": int((~found).sum()),
        "outside": int((~limits.contain(joints, 1e-6)).sum()),
        "jumps": int((steps > JUMP).sum()),
        "largest_joint": float(np.abs(joints).max()),
    }


def is_usable(verdict):
    """Whether an arm could run it at all."""
    return not (verdict["not_converged"] or verdict["outside"] or verdict["jumps"])
