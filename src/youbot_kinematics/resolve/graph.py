"""The graph of a tour: its waypoints, where the arm can stand at each, and how they follow.

Where a line leaves what the arm can reach, the graph has a detour instead: from the last waypoint
that can be reached to the next one, both found to a tenth of a millimetre.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from .. import arm
from ..exceptions import PlanningError
from .lines import Line
from .route import SAME_PLANE, Route, branch_of, cell_of, pitch_of, route_along, standings
from .search import DETOUR, SAME, SMOOTH, SWAPPED, TURNED, Graph, smooth_step

_N_CELLS = 128
# At the ends of a detour: steps are cut in so many, so often, and the pitch is tried as often.
_CUTS, _CUT_ROUNDS, _FINER = 8, 2, 9


class Tour(NamedTuple):
    """A graph together with what its cells stand for."""

    lines: list[Line]
    route: Route
    graph: Graph
    pitch: np.ndarray  # (K, 4, P) rad, in the middle of each cell or near it
    demanded: dict  # (waypoint, cell): joints (5,) rad that are exactly these
    fine: np.ndarray  # (K,) bool: waypoints at which several pitches were tried in each cell


def lay_out(lines, exact, limits: arm.JointLimits, rate: float) -> Tour:
    """The graph of straight lines, with detours where they leave the arm's reach.

    Args:
        lines: one or more, the end of one being the beginning of the next.
        exact: for each checkpoint None, or joints (k, 5) of which it demands one.
        rate: acceleration over velocity, 1/s.

    Raises:
        PlanningError: a checkpoint is out of reach.
    """
    fractions = [line.waypoints() for line in lines]
    route = route_along(lines, fractions)
    fine = np.zeros(len(route.u), dtype=bool)
    cells = standings(route, limits, _N_CELLS)
    tour = _build(lines, route, fine, cells, exact, limits, rate)
    for _ in range(_CUT_ROUNDS):
        blocked = _blocked(tour.graph)
        if not blocked.any():
            return tour
        route, fine, cells = _cut(tour, blocked, limits)
        tour = _build(lines, route, fine, cells, exact, limits, rate)
    return _with_detours(tour)


def _build(lines, route: Route, fine, cells, exact, limits, rate) -> Tour:
    """The tour over a route, given what ``standings`` finds along it, which this changes."""
    joints, pitch = cells
    velocity = limits.velocity[:4].astype(np.float32)
    demanded: dict = {}
    confined: dict = {}
    apart: dict = {}
    for k in np.flatnonzero((route.u == 0) | (route.u == 1)):
        number = int(route.line[k] + route.u[k])
        if exact[number] is None:
            _must_reach(joints[k], number, lines[route.line[k]].point(route.u[k]))
            continue
        for q in exact[number]:
            branch, in_plane = branch_of(route, k, q)
            cell = branch * _N_CELLS + int(cell_of(pitch_of(q), _N_CELLS))
            demanded[int(k), cell] = q
            joints[k].reshape(-1, 4)[cell] = q[:4].astype(np.float32) / velocity
            pitch[k].reshape(-1)[cell] = pitch_of(q)
            confined.setdefault(int(k), []).append(cell)
            if not in_plane:
                apart.setdefault(int(k), []).append(cell)
    graph = Graph(
        joints=joints,
        valid=np.isfinite(joints[..., 0]),
        links=_links(route),
        start=confined.pop(0)[0],
        confined=confined,
        apart=apart,
        checkpoint=(route.u == 0) | (route.u == 1),
        penalty=None,
        rate=rate,
    )
    return Tour(lines, route, graph, pitch, demanded, fine)


def _must_reach(joints, number, point):
    if np.isnan(joints).all():
        x, y, z = point
        raise PlanningError(
            f"checkpoint {number} at ({x:.4f}, {y:.4f}, {z:.4f}) m is out of reach inside the"
            " joint limits: move it, or leave it out"
        )


def _links(route: Route) -> np.ndarray:
    """How each waypoint follows the one before it: (K - 1,), as ``search`` names it."""
    links = np.full(len(route.u) - 1, SMOOTH)
    for k in np.flatnonzero(np.diff(route.line)):
        turn = route.azimuth[k + 1] - route.azimuth[k]
        if abs(np.sin(turn)) > SAME_PLANE:
            links[k] = TURNED
        else:
            links[k] = SAME if np.cos(turn) > 0 else SWAPPED
    return links


def _blocked(graph: Graph) -> np.ndarray:
    """Steps (K - 1,) along a line that the arm cannot make from any cell to any other."""
    cost = np.zeros(graph.valid[0].size)
    smooth = np.flatnonzero(graph.links == SMOOTH)
    blocked = np.zeros(len(graph.links), dtype=bool)
    blocked[smooth] = [np.isinf(smooth_step(graph, k + 1, cost)[0]).all() for k in smooth]
    return blocked


def _cut(tour: Tour, blocked, limits):
    """The route with the first and last step of each blocked stretch cut in more.

    Returns:
        The route; for each waypoint whether it is at such a stretch and wants finer pitches, (K,)
        bool; and what ``standings`` finds along it.
    """
    route = tour.route
    first = blocked & ~np.append(False, blocked[:-1])
    last = blocked & ~np.append(blocked[1:], False)
    ends = np.flatnonzero(first | last)
    near = tour.fine | np.append(blocked, False) | np.append(False, blocked)
    parts = np.arange(1, _CUTS) / _CUTS
    more = route.u[ends, None] + (route.u[ends + 1] - route.u[ends])[:, None] * parts
    fractions, fine = [], []
    for i in range(len(tour.lines)):
        on_line = route.line == i
        added = more[route.line[ends] == i].ravel()
        u = np.append(route.u[on_line], added)
        order = np.argsort(u)
        fractions.append(u[order])
        fine.append(np.append(near[on_line], np.ones(len(added), dtype=bool))[order])
    route, wants = route_along(tour.lines, fractions), np.concatenate(fine)
    return route, wants, _cells_along(route, wants, limits, tour, np.flatnonzero(~near))


def _cells_along(route: Route, fine, limits, tour: Tour, known):
    """What ``standings`` finds along a route, with finer pitches at the ``fine`` waypoints (K,).

    The others are waypoints of a tour, whose numbers in it are ``known``: they are not asked again.
    """
    index = np.zeros(len(fine), dtype=int)
    index[~fine] = known
    cells = [array.take(index, axis=0) for array in (tour.graph.joints, tour.pitch)]
    for array, found in zip(cells, standings(route.take(fine), limits, _N_CELLS, _FINER)):
        array[fine] = found
    return cells


def _with_detours(tour: Tour) -> Tour:
    """The tour without the waypoints inside of blocked stretches, over which detours lead."""
    blocked = _blocked(tour.graph)
    keep = ~(np.append(blocked, False) & np.append(False, blocked))
    index = np.flatnonzero(keep)
    moved = np.cumsum(keep) - 1
    graph = tour.graph._replace(
        joints=tour.graph.joints[keep],
        valid=tour.graph.valid[keep],
        links=np.where(blocked[index[1:] - 1], DETOUR, tour.graph.links[index[1:] - 1]),
        confined={int(moved[k]): cells for k, cells in tour.graph.confined.items()},
        apart={int(moved[k]): cells for k, cells in tour.graph.apart.items()},
        checkpoint=tour.graph.checkpoint[keep],
    )
    demanded = {(int(moved[k]), cell): q for (k, cell), q in tour.demanded.items()}
    route, pitch, fine = tour.route.take(keep), tour.pitch[keep], tour.fine[keep]
    return Tour(tour.lines, route, graph, pitch, demanded, fine)
