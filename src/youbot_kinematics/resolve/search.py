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

from .. import formulas
from ..progress import with_progress

# The pitch moves by no more than this many cells from a waypoint to the next.
REACH = 3
# A joint that moves for longer than this from a waypoint to the next (s, at full speed) is torn
# from one side of its gap to the other, or passes a straight elbow.
TEAR = 0.3
# In seconds: more than any motion lasts, and not too much for float64 to count beside them.
RECONFIGURATION_COST, APPROACH_COST = 1e6, 1e4

#: How a waypoint follows another: smoothly along a line; as the same place on the next line, with
#: front and back the same or swapped; there, but with joint 1 turned, on its axis; off the line.
SMOOTH, SAME, SWAPPED, TURNED, DETOUR = range(5)


class Graph(NamedTuple):
    """What the search walks over: cells, 4 branches x P pitches, at each of K waypoints.

    A cell is numbered branch * P + pitch.
    """

    joints: np.ndarray  # (K, 4, P, 4) s: joints 1 to 4 over their velocities; NaN if not possible
    valid: np.ndarray  # (K, 4, P) bool: where they are possible
    links: np.ndarray  # (K - 1,): SMOOTH ... DETOUR
    start: int  # the cell of waypoint 0 in which the arm stands
    confined: dict  # waypoint: list of the only cells in which it may be left
    apart: dict  # waypoint: list of cells that no smooth step leads to or from
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
    for k in with_progress(range(K), "searching the joints along the tour", K):
        cost, came_from[k] = _advance(graph, k, cost)
        cost, changed_from[k] = _change(graph, k, cost, reconfigure)
        if not cost.min() < np.inf:
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


def smooth_step(graph: Graph, k: int, cost):
    """Costs (n_cells,) of waypoint k by smooth steps from k - 1, and the cells that they come from.

    Args:
        cost: of the cells of k - 1, (n_cells,) s.
    """
    cost = _without(cost, graph.apart.get(k - 1))
    cost, cells = formulas.smooth_step(graph.joints[k - 1], graph.joints[k], cost, REACH, TEAR)
    return _without(cost, graph.apart.get(k)), cells


def _without(cost, cells):
    """Costs (n_cells,) with some cells, if any, impossible."""
    if cells:
        cost = cost.copy()
        cost[cells] = np.inf
    return cost


def _advance(graph: Graph, k: int, cost):
    """Costs (n_cells,) of reaching waypoint k from k - 1, and the cells that they come from."""
    cells = np.arange(len(cost))
    if k == 0:
        return cost, cells
    link, valid = graph.links[k - 1], graph.valid[k].ravel()
    if link == SMOOTH:
        cost, cells = smooth_step(graph, k, cost)
    elif link in (SAME, SWAPPED):
        cells = np.roll(cells, len(cells) // 2) if link == SWAPPED else cells
        cost = np.where(valid, cost[cells], np.inf)
    else:
        extra = RECONFIGURATION_COST if link == TURNED else 0.0
        cost, cells = _move(graph, (k - 1, k), cost, np.isfinite(cost), valid, extra)
    if graph.penalty is not None:
        cost = cost + graph.penalty[k].ravel()
    return cost, cells


def _change(graph: Graph, k: int, cost, reconfigure: bool):
    """Costs (n_cells,) of leaving waypoint k in each cell, and the cells before a change there."""
    before = np.arange(len(cost))
    if reconfigure or k == 0:
        extra = RECONFIGURATION_COST if k > 0 else APPROACH_COST
        if not graph.checkpoint[k]:
            extra += 1 / graph.rate  # stopping and starting again
        # Only from the fewest reconfigurations so far to more: from more to more it never pays.
        few = cost < cost.min() + RECONFIGURATION_COST / 2
        changed, origin = _move(graph, (k, k), cost, few, graph.valid[k].ravel() & ~few, extra)
        better = changed < cost
        cost, before = np.where(better, changed, cost), np.where(better, origin, before)
    if k in graph.confined:
        kept = np.full(len(cost), np.inf)
        kept[graph.confined[k]] = cost[graph.confined[k]]
        cost = kept
    return cost, before


def _move(graph: Graph, waypoints, cost, sources, targets, extra: float):
    """Costs of the cells after moves from rest to rest, and the cells that they come from.

    Args:
        waypoints: two of them, of the sources and of the targets.
        sources, targets: cells, bool (n_cells,).
        extra: cost of each move beside its time, s.
    """
    before, after = (graph.joints[k] for k in waypoints)
    return formulas.move(before, after, cost, sources, targets, graph.rate, extra)
