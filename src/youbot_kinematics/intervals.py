"""Exact intervals of the one free angle of a planar arm with three joints.

With the tip p given, such an arm keeps one freedom: the direction s of its last link. In complex
numbers, with the last link m (a link with an offset has an imaginary part),

    p = l1 e^(ia) + l2 e^(i(a + b)) + m e^(is),    s = a + b + c.

A joint on a bound makes one rigid body of the links that it joins: what is left is a triangle, and
the law of cosines gives s. So the directions at which anything changes are known in closed form,
and between two neighbours of them one test decides.
"""

from __future__ import annotations

import numpy as np

# Boundaries closer together than this (rad) are one boundary, computed twice.
_SAME_ANGLE = 1e-10
# By how much rounding may push a cosine beyond 1, as a part of the squares it is made of.
_COSINE_ROUNDING = 1e-14


def bound_directions(p: complex, m: complex, l1: float, l2: float, lower, upper) -> np.ndarray:
    """Every direction s (n,) in rad of the last link at which a joint can meet a bound.

    Args:
        p: tip from the first joint (m).
        m: last link (m) for s = 0.
        l1, l2: lengths of the first two links (m).
        lower, upper: bounds (3,) of the joints a, b, c (rad).
    """
    a, b, c = np.stack([lower, upper], axis=-1)
    b = np.array([*b, 0.0, np.pi])  # 0 and pi: the edges of the wrist's reach
    elbow_fixed = p - l1 * np.exp(1j * a), np.full(2, m), np.full(2, l2)
    wrist_distance_fixed = np.full(4, p), np.full(4, m), np.abs(l1 + l2 * np.exp(1j * b))
    last_links_fixed = np.full(2, p), m + l2 * np.exp(-1j * c), np.full(2, l1)
    triangles = zip(elbow_fixed, wrist_distance_fixed, last_links_fixed)
    return _directions_at(*(np.concatenate(sides) for sides in triangles))


def _directions_at(p, m, distance):
    """The angles s with |p - m e^(is)| = distance: two or none for each of p, m, distance (n,)."""
    squares, product = np.abs(p) ** 2 + np.abs(m) ** 2, 2 * np.abs(p) * np.abs(m)
    excess = np.abs(squares - distance**2) - product  # of the cosine, times the product
    exist = (product > 0) & (excess <= _COSINE_ROUNDING * squares)
    p, m, distance, squares, product = (x[exist] for x in (p, m, distance, squares, product))
    half = np.arccos(np.clip((squares - distance**2) / product, -1.0, 1.0))
    middle = np.angle(p / m)
    return np.concatenate([middle - half, middle + half])


def feasible_intervals(boundaries, feasible) -> list[list[tuple[float, float]]]:
    """The intervals of an angle on which each of several conditions holds.

    Args:
        boundaries: angles (n,) in rad; nowhere else may a condition change.
        feasible: says for angles (n,) whether each of m conditions holds, (n, m) bool.

    Returns:
        For each condition a list of intervals (low, high) in rad, ends included, with
        -pi <= low < pi and low <= high. An interval across +-pi has high > pi; a single angle has
        high = low; the whole circle is (-pi, pi).
    """
    starts = np.unique(np.mod(np.asarray(boundaries, dtype=float) + np.pi, 2 * np.pi) - np.pi)
    starts = starts[np.diff(starts, prepend=-np.inf) > _SAME_ANGLE]
    if len(starts) == 0:
        starts = np.array([-np.pi])
    widths = np.diff(starts, append=starts[0] + 2 * np.pi)
    holds = feasible(np.concatenate([starts, starts + widths / 2])).T
    n = len(starts)
    return [
        _joined(starts, widths, touched, inside)
        for touched, inside in zip(holds[:, :n], holds[:, n:])
    ]


def _joined(starts, widths, touched, inside) -> list[tuple[float, float]]:
    """Joins the arcs of the circle that are inside, and adds lonely points that are touched."""
    if inside.all():
        return [(-np.pi, np.pi)]
    intervals: list[tuple[float, float]] = []
    first = int(np.argmin(inside))  # begins behind an arc that is not inside
    for i in np.roll(np.arange(len(starts)), -first - 1):
        if inside[i] and inside[i - 1]:
            low, high = intervals.pop()
            intervals.append((low, high + widths[i]))
        elif inside[i]:
            intervals.append((starts[i], starts[i] + widths[i]))
        elif touched[i] and not inside[i - 1]:
            intervals.append((starts[i], starts[i]))
    return sorted((float(low), float(high)) for low, high in intervals)


def turned_next_to(middle: float, intervals) -> list[tuple[float, float]]:
    """The intervals, each turned by whole turns to where its middle is nearest to a given angle."""
    turns = [
        2 * np.pi * np.round((middle - (low + high) / 2) / (2 * np.pi)) for low, high in intervals
    ]
    return sorted((low + turn, high + turn) for turn, (low, high) in zip(turns, intervals))
