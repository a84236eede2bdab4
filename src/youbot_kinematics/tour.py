"""The shortest order in which to visit the targets, from where the tool is.

Exact by dynamic programming while that is quick, by fast-tsp's local search beyond it. The path
ends at the last target, or where it began.
"""

from __future__ import annotations

import numpy as np

from . import formulas

#: Up to so many targets the order is exact.
EXACT_UP_TO = formulas.MOST_EXACT
# How long the local search looks, s for each target, and the largest of the integers that it takes.
_SEARCH_TIME, _LARGEST = 1e-3, 65535


def shortest_path(start, positions, return_home: bool = False):
    """The order of least Euclidean length of the tool's path, from the start through all targets.

    Args:
        start: position of the tool where the arm starts, (3,), m.
        positions: positions of the targets, (n, 3), m.
        return_home: whether the path ends where it began.

    Returns:
        ``(order, length)``: indices of the targets in visiting order, (n,), and the length of the
        path in m.
    """
    points = np.concatenate([np.reshape(start, (1, 3)), np.reshape(positions, (-1, 3))])
    steps = points[:, None] - points
    distances = np.sqrt((steps * steps).sum(axis=-1))
    solve = held_karp if len(points) <= EXACT_UP_TO + 1 else local_search
    order = solve(distances, return_home)
    way = np.concatenate([[0], order + 1, [0] if return_home else []]).astype(int)
    return order, float(distances[way[:-1], way[1:]].sum())


def path_length(points) -> float:
    """Length in m of the polyline through points (n, 3), m."""
    return float(np.linalg.norm(np.diff(points, axis=0), axis=1).sum())


def held_karp(distances: np.ndarray, return_home: bool = False) -> np.ndarray:
    """Exact shortest path from node 0 through all others, and back if ``return_home``.

    Held and Karp (1962), in ``src/formulas/tour.c``: for each set of targets and each target of it,
    the shortest path through the set that ends there, sets being extended by one target each.
    It is bounded: a set is left out if the spanning tree of the others (Prim 1957) shows that no
    path through it becomes shorter than one that is known.

    Args:
        distances: (n + 1, n + 1), symmetric, m; n is ``EXACT_UP_TO`` at most.

    Returns:
        Order of the n targets (node - 1), (n,).

    Raises:
        ValueError: there are more.
    """
    return formulas.held_karp(distances, return_home)


def local_search(distances: np.ndarray, return_home: bool = False) -> np.ndarray:
    """A short path from node 0 through all others, for many targets; as ``held_karp`` takes it.

    fast-tsp closes its tours and takes 16-bit integers: distances are scaled to use these. An open
    path is closed by one more node, next to the start at no cost, and far from all others alike.
    """
    import fast_tsp  # here, since few tours are so long

    n = len(distances)
    longest = distances.max() or 1.0
    if not return_home:
        distances = np.pad(distances, (0, 1), constant_values=longest)
        distances[n, [0, n]] = distances[0, n] = 0.0
    integers = np.round(distances * (_LARGEST / longest)).astype(int)
    tour = fast_tsp.find_tour(integers.tolist(), _SEARCH_TIME * n)
    at_start = tour.index(0)
    tour = tour[at_start:] + tour[:at_start]
    if tour[1] == n:  # the closing node comes right after the start: walk the other way round
        tour = tour[:1] + tour[:0:-1]
    return np.array([node - 1 for node in tour[1:] if node != n])
