"""The shortest order in which to visit the targets, from where the tool is.

Exact by dynamic programming (Held and Karp 1962; Bellman 1962) while that is quick, by fast-tsp's
local search beyond it. The path ends at the last target, or where it began.
"""

from __future__ import annotations

import numpy as np

#: Up to so many targets the order is exact: Held-Karp takes 2^n n^2 steps, half a second at most.
EXACT_UP_TO = 18
# Sets of targets that are looked at together: what they need stays in the processor's cache.
_CHUNK = 2048
# How long the local search looks, s for each target, and the largest of the integers that it takes.
_SEARCH_TIME, _LARGEST = 2.5e-3, 65535


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
    points = np.vstack([np.reshape(start, (1, 3)), np.reshape(positions, (-1, 3))])
    distances = np.linalg.norm(points[:, None] - points[None, :], axis=-1)
    solve = held_karp if len(points) <= EXACT_UP_TO + 1 else local_search
    order = solve(distances, return_home)
    way = [0, *(order + 1), 0] if return_home else [0, *(order + 1)]
    return order, path_length(points[way])


def path_length(points) -> float:
    """Length in m of the polyline through points (n, 3), m."""
    return float(np.linalg.norm(np.diff(points, axis=0), axis=1).sum())


def held_karp(distances: np.ndarray, return_home: bool = False) -> np.ndarray:
    """Exact shortest path from node 0 through all others, and back if ``return_home``.

    ``cost[S, j]`` is the length of the shortest path from node 0 through the set S of targets that
    ends at target j; a set is a bit mask. Sets are extended by one target each, smaller ones first.

    Args:
        distances: (n + 1, n + 1), m.

    Returns:
        Order of the n targets (node - 1), (n,).
    """
    n = len(distances) - 1
    between = distances[1:, 1:]
    cost = np.full((2**n, n), np.inf)
    cost[1 << np.arange(n), np.arange(n)] = distances[0, 1:]
    for sets in _sets_by_size(n):
        to_end = np.ascontiguousarray(cost[sets].T)
        for j in range(n):
            extended = (to_end + between[:, j, None]).min(axis=0)
            without_j = (sets >> j) & 1 == 0
            cost[sets[without_j] | 1 << j, j] = extended[without_j]

    # Walk back from the full set: the end that costs least, then what it was reached from.
    visited, order = 2**n - 1, []
    to_next = distances[1:, 0] if return_home else np.zeros(n)
    for _ in range(n):
        j = int(np.argmin(cost[visited] + to_next))
        order.append(j)
        visited, to_next = visited ^ (1 << j), between[:, j]
    return np.array(order[::-1], dtype=int)


def _sets_by_size(n: int):
    """Yields all sets of n targets but the empty and the full one, in chunks (m,) of one size."""
    size = np.zeros(1, dtype=np.int8)
    for _ in range(n):
        size = np.concatenate([size, size + 1])
    by_size = np.argsort(size, kind="stable")
    ends = np.searchsorted(size[by_size], np.arange(1, n + 1))
    for begin, end in zip(ends[:-1], ends[1:]):
        for first in range(begin, end, _CHUNK):
            yield by_size[first : min(first + _CHUNK, end)]


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
