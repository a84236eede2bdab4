"""From a walk through the graph to the runs that the arm makes and the moves between them."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from .graph import Tour
from .route import Route
from .search import DETOUR, SAME, SMOOTH, SWAPPED, TURNED, Walk

#: The kinds of joint paths; ``NONE`` where a run goes on where the one before it ended.
LINE, APPROACH, DETOUR_MOVE, NONE = "line", "approach", "detour", ""
RECONFIGURATION = "reconfiguration"
_KIND = {SAME: NONE, SWAPPED: NONE, TURNED: RECONFIGURATION, DETOUR: DETOUR_MOVE}


class Run(NamedTuple):
    """Waypoints of one line that the arm passes without a stop, on one branch."""

    waypoints: list  # numbers, one or more
    cells: list
    move: str  # kind of the move that leads to it from the run before


class Itinerary(NamedTuple):
    """The waypoints of all runs one after the other, (n,) each."""

    route: Route
    track: np.ndarray  # 0 front, 1 back
    elbow: np.ndarray  # 0 for +, 1 for -
    pitch: np.ndarray  # rad, continuous
    run: np.ndarray  # number of the run
    joined: np.ndarray  # bool: the arm stands as at the waypoint before, at a checkpoint
    fixed: np.ndarray  # bool: the pitch is demanded
    roll: np.ndarray  # joint 5 where it is given, rad, NaN elsewhere
    standing: np.ndarray  # (n, P) bool: where the arm can stand on the branch


def runs_of(walk: Walk, links: np.ndarray) -> list[Run]:
    """The runs of a walk, in order."""
    runs: list[Run] = []
    for k, (arrive, leave) in enumerate(zip(walk.arrive.tolist(), walk.leave.tolist())):
        if k > 0 and links[k - 1] == SMOOTH:
            runs[-1].waypoints.append(k)
            runs[-1].cells.append(arrive)
        else:
            runs.append(Run([k], [arrive], _KIND[links[k - 1]] if k else NONE))
        if leave != arrive:
            runs.append(Run([k], [leave], RECONFIGURATION if k else APPROACH))
    return runs


def itinerary(tour: Tour, runs: list[Run]) -> Itinerary:
    """Lines the runs of a tour up."""
    n_pitches = tour.pitch.shape[-1]
    k = np.concatenate([run.waypoints for run in runs])
    cell = np.concatenate([run.cells for run in runs])
    number = np.repeat(np.arange(len(runs)), [len(run.cells) for run in runs])
    first = np.append(True, number[1:] != number[:-1])
    moved = np.array([run.move != NONE for run in runs])[number] & first
    joined = first & ~moved
    joined[0] = False
    branch, column = divmod(cell, n_pitches)
    given = [tour.demanded.get(node) for node in zip(k.tolist(), cell.tolist())]
    demanded = np.array([q is not None for q in given])
    fixed = demanded.copy()
    fixed |= joined & np.append(False, fixed[:-1])
    fixed |= np.append((joined & fixed)[1:], False)
    return Itinerary(
        route=tour.route.take(k),
        track=branch // 2,
        elbow=branch % 2,
        pitch=np.unwrap(tour.pitch[k, branch, column].astype(float)),
        run=number,
        joined=joined,
        fixed=fixed,
        roll=np.array([np.nan if q is None else q[4] for q in given]),
        standing=tour.graph.valid[k, branch],
    )
