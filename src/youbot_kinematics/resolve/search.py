"""The search for the best joint path along a tour: dynamic programming over closed-form branches.

At each waypoint the arm may stand in any cell of a grid, branches x pitches. From one waypoint to
the next the pitch moves by a few cells on the same branch, smoothly; any other change is a
reconfiguration, at one waypoint. As in Descartes (De Maeyer et al., "Cartesian path planning for
arc welding robots: evaluation of the Descartes algorithm", ETFA 2017), but with the number of
reconfigurations before the time: costs are times in seconds, and a reconfiguration costs ages.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.spatial.distance import cdist

from ..progress import with_progress

# The pitch moves by no more than this many cells from a waypoint to the next.
REACH = 3
# A joint that moves for longer than this from a waypoint to the next (s, at full speed) is torn
# from one side of its gap to the other, or passes a straight elbow.
TEAR = 0.3
# In seconds: more than any motion lasts, and not too much for float64 to count beside them.
RECONFIGURATION_COST, APPROACH_COST = 1e6, 1e4
_CHUNK = 256  # waypoints at once, to bound the memory

#: How a waypoint follows another: smoothly along a line; as the same place on the next line, with
#: front and back the same or swapped; there, but with joint 1 turned, on its axis; off the line.
SMOOTH, SAME, SWAPPED, TURNED, DETOUR = range(5)


class Graph(NamedTuple):
    """What the search walks over: cells, 4 branches x P pitches, at each of K waypoints.

    A cell is numbered branch * P + pitch.
    """

    joints: np.ndarray  # (4, K, 4, P) s: joints 1 to 4 over their velocities; NaN if not possible
    valid: np.ndarray  # (K, 4, P) bool: where they are possible
    links: np.ndarray  # (K - 1,): SMOOTH ... DETOUR
    start: int  # the cell of waypoint 0 in which the arm stands
    confined: dict  # waypoint: list of the only cells in which it may be left
    apart: list  # (waypoint, cell) that no smooth step leads to or from
    checkpoint: np.ndarray  # (K,) bool: the arm stops here in any case
    penalty: np.ndarray | None  # (K, 4, P) s, added in each cell
    rate: float  # acceleration over velocity, 1/s


class Walk(NamedTuple):
    """The best way through a graph."""

    arrive: np.ndarray  # (K,) cell in which each waypoint is reached
    leave: np.ndarray  # (K,) cell in which it is left: another one after a reconfiguration
    cost: float  # s, with RECONFIGURATION_COST and APPROACH_COST for each of them


def best_walk(graph: Graph, reconfigure: bool = True) -> Walk | None:
    """The walk with the fewest reconfigurations and, among those, the least time.

    Args:
        reconfigure: whether reconfigurations are possible at all.

    Returns:
        The walk, or None if there is none; with reconfigurations there is always one unless a
        smooth link has no step.
    """
    K, n_cells = len(graph.valid), graph.valid[0].size
    came_from, changed_from = np.empty((2, K, n_cells), dtype=np.int16)
    cost = np.full(n_cells, np.inf)
    cost[graph.start] = 0.0
    waypoints = with_progress(_steps_into(graph), "searching the joints along the tour", K)
    for k, steps in enumerate(waypoints):
        cost, came_from[k] = _advance(graph, k, cost, steps)
        cost, changed_from[k] = _change(graph, k, cost, reconfigure)
        if not np.isfinite(cost).any():
            return None
    return _trace_back(came_from, changed_from, cost)


def _trace_back(came_from, changed_from, cost) -> Walk:
    arrive, leave = np.empty((2, len(came_from)), dtype=int)
    cell = int(np.argmin(cost))
    for k in range(len(came_from) - 1, -1, -1):
        leave[k] = cell
        arrive[k] = changed_from[k, cell]
        cell = int(came_from[k, arrive[k]])
    return Walk(arrive, leave, float(cost.min()))


def smooth_costs(before, after) -> np.ndarray:
    """Time of each smooth step between neighbouring waypoints.

    Args:
        before, after: joints 1 to 4 over their velocities, (4, n, 4, P) s, NaN where not possible.

    Returns:
        (n, 4, P, 2 REACH + 1) s, inf where there is none: into the cell on the first three axes,
        from the cell of the same branch that is i - REACH pitches on.
    """
    n_pitches = after.shape[-1]
    ring = np.pad(before, ((0, 0), (0, 0), (0, 0), (REACH, REACH)), mode="wrap")
    cost = np.empty((*after.shape[1:], 2 * REACH + 1), dtype=np.float32)
    for i in range(2 * REACH + 1):
        time = np.zeros((), dtype=np.float32)
        for joint in range(4):
            step = after[joint] - ring[joint, ..., i : i + n_pitches]
            time = np.maximum(time, np.abs(step, out=step))
        cost[..., i] = np.where(time <= TEAR, time, np.inf)  # NaN is no way either
    return cost


def _steps_into(graph: Graph):
    """Yields the smooth steps (4, P, 2 REACH + 1) into each waypoint; None into the first."""
    yield None
    n = len(graph.links)
    n_pitches = graph.valid.shape[-1]
    for first in range(0, n, _CHUNK):
        last = min(first + _CHUNK, n)
        costs = smooth_costs(graph.joints[:, first:last], graph.joints[:, first + 1 : last + 1])
        for k, cell in graph.apart:
            branch, pitch = divmod(cell, n_pitches)
            if first < k <= last:
                costs[k - 1 - first, branch, pitch] = np.inf
            if first <= k < last:
                near = np.arange(-REACH, REACH + 1)
                costs[k - first, branch, (pitch - near) % n_pitches, near + REACH] = np.inf
        yield from costs


def _advance(graph: Graph, k: int, cost, steps):
    """Costs (n_cells,) of reaching waypoint k from k - 1, and the cells that they come from."""
    cells = np.arange(len(cost))
    if k == 0:
        return cost, cells
    link, valid = graph.links[k - 1], graph.valid[k].ravel()
    if link == SMOOTH:
        cost, cells = _step(cost, steps)
    elif link in (SAME, SWAPPED):
        cells = np.roll(cells, len(cells) // 2) if link == SWAPPED else cells
        cost = np.where(valid, cost[cells], np.inf)
    else:
        extra = RECONFIGURATION_COST if link == TURNED else 0.0
        cost, cells = _jump(graph, (k - 1, k), cost, np.isfinite(cost), valid, extra)
    if graph.penalty is not None:
        cost = cost + graph.penalty[k].ravel()
    return cost, cells


def _step(cost, steps):
    branches, n_pitches, _ = steps.shape
    near = (np.arange(n_pitches)[:, None] + np.arange(-REACH, REACH + 1)) % n_pitches
    total = cost.reshape(branches, n_pitches)[:, near] + steps
    best = total.argmin(axis=-1)
    origin = near[np.arange(n_pitches), best] + n_pitches * np.arange(branches)[:, None]
    return total.min(axis=-1).ravel(), origin.ravel()


def _change(graph: Graph, k: int, cost, reconfigure: bool):
    """Costs (n_cells,) of leaving waypoint k in each cell, and the cells before a change there."""
    before = np.arange(len(cost))
    if reconfigure or k == 0:
        extra = RECONFIGURATION_COST if k > 0 else APPROACH_COST
        if not graph.checkpoint[k]:
            extra += 1 / graph.rate  # stopping and starting again
        # Only from the fewest reconfigurations so far to more: from more to more it never pays.
        few = cost < cost.min() + RECONFIGURATION_COST / 2
        changed, origin = _jump(graph, (k, k), cost, few, graph.valid[k].ravel() & ~few, extra)
        better = changed < cost
        cost, before = np.where(better, changed, cost), np.where(better, origin, before)
    if k in graph.confined:
        kept = np.full(len(cost), np.inf)
        kept[graph.confined[k]] = cost[graph.confined[k]]
        cost = kept
    return cost, before


def _jump(graph: Graph, waypoints, cost, sources, targets, extra):
    """Costs of the cells after moves from rest to rest, and the cells that they come from.

    Args:
        waypoints: two of them, of the sources and of the targets.
        sources, targets: cells, bool (n_cells,).
        extra: cost of each move beside its time, s.
    """
    sources, targets = np.flatnonzero(sources), np.flatnonzero(targets)
    out, origin = np.full(len(cost), np.inf), np.arange(len(cost))
    if len(sources) and len(targets):
        a, b = (graph.joints[:, k].reshape(4, -1).T for k in waypoints)
        time = move_time(cdist(a[sources], b[targets], "chebyshev"), graph.rate)
        total = cost[sources, None] + time + extra
        best = total.argmin(axis=0)
        out[targets] = total[best, np.arange(len(targets))]
        origin[targets] = sources[best]
    return out, origin


def move_time(distance, rate: float) -> np.ndarray:
    """Time (s) from rest to rest over a distance over velocity (s), with the rate as in ``Graph``.

    The trapezoidal profile: Siciliano et al. (2009), section 4.2.1.
    """
    return np.where(distance * rate < 1, 2 * np.sqrt(distance / rate), distance + 1 / rate)
