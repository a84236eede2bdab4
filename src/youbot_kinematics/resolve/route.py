"""The waypoints of a tour, and where the arm can stand at each of them.

At a waypoint the tool's position is given, and the arm has four branches: its front or its back
towards the tool (the ``track``), the elbow to one side or the other. On each the pitch of the tool
is free, within the joint limits.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from .. import arm, formulas
from .lines import Line

# The search keeps this far from the joint limits along a line (rad), and closes up to them towards
# checkpoints (rad/m): the curves through its waypoints need room to swing.
_MARGIN, _MARGIN_RISE = 1e-3, 0.05


class Route(NamedTuple):
    """Waypoints (K,) of the lines of a tour, in order; one between two lines comes twice."""

    line: np.ndarray  # number of the line
    u: np.ndarray  # fraction of it that is done
    progress: np.ndarray  # along it: see ``lines``
    azimuth: np.ndarray  # phi of the front track, rad; the back track's is half a turn on
    radius: np.ndarray  # r of the front track, m; the back track's is -r
    height: np.ndarray  # z, m
    margin: np.ndarray  # distance to keep from the joint limits, rad

    def take(self, index) -> Route:
        """The waypoints of an index, a slice or a mask."""
        return Route(*(column[index] for column in self))

    def places(self) -> np.ndarray:
        """What decides where the arm can stand: azimuth, radius, height and margin, (K, 4)."""
        return np.stack([self.azimuth, self.radius, self.height, self.margin], axis=-1)


def route_along(lines: list[Line], fractions: list[np.ndarray]) -> Route:
    """The route with waypoints at the given fractions u (n_i,) of each line."""
    columns = []
    for i, (line, u) in enumerate(zip(lines, fractions)):
        to_end = np.minimum(u, 1 - u) * line.length
        margin = np.minimum(_MARGIN, _MARGIN_RISE * to_end)
        seen = line.progress(u), line.azimuth(u), line.radius(u), line.height(u)
        columns.append((np.full(len(u), i), u, *seen, margin))
    return Route(*(np.concatenate(column) for column in zip(*columns)))


def arm_joints(route: Route, branch, pitch, limits: arm.JointLimits):
    """Joints 1 to 4 at waypoints in closed form.

    Args:
        route: K waypoints.
        branch: (K,) 2 * track (0 front, 1 back) + elbow (0 for +, 1 for -).
        pitch: beta (K,), rad.

    Returns:
        ``(joints, excess)``: (K, 4) rad, and by how much each passes its limits less the margin,
        NaN where the wrist is out of reach.
    """
    return formulas.stand(route.places(), branch, pitch, limits.lower, limits.upper)


def pitch_grid(n_cells: int) -> np.ndarray:
    """Pitches (rad) in the middle of the cells into which the circle is cut."""
    return (np.arange(n_cells) + 0.5) * (2 * np.pi / n_cells) - np.pi


def cell_of(pitch, n_cells: int) -> np.ndarray:
    """The cell of ``pitch_grid`` in which each pitch (rad) lies."""
    return np.floor((np.asarray(pitch) + np.pi) * (n_cells / (2 * np.pi))).astype(int) % n_cells


def standings(route: Route, limits: arm.JointLimits, n_cells: int, finer: int = 1):
    """Where the arm can stand at each waypoint, on each branch and in each cell of the pitch.

    Args:
        route: K waypoints.
        finer: how many pitches are tried in a cell, odd. The valid one next to its middle is taken.

    Returns:
        ``(cells, pitch)``, both float32, to save memory: joints 1 to 4 over their velocities,
        (K, 4, n_cells, 4) s, NaN where the arm cannot stand; the pitch there, (K, 4, n_cells) rad.
    """
    tried = pitch_grid(n_cells * finer)
    bounds = limits.lower, limits.upper, limits.velocity
    return formulas.standings(route.places(), tried, finer, *bounds)


def branch_of(route: Route, k: int, q: np.ndarray):
    """The branch of waypoint k on which joints q (5,) stand, and whether its plane is q's.

    It is not where the tool is on joint 1's axis, and joint 1 stands elsewhere than the line asks.
    """
    turn = arm.OFFSET[0] - q[0] - route.azimuth[k]
    track, elbow = int(np.cos(turn) < 0), int(q[2] + arm.OFFSET[2] < 0)
    return 2 * track + elbow, abs(np.sin(turn)) < SAME_PLANE


#: Two azimuths whose difference has a smaller sine are those of one plane.
SAME_PLANE = 1e-5


def pitch_of(q: np.ndarray):
    """Pitch beta (...) of the tool, rad, for joints q (..., 5)."""
    return (q[..., 1:4] + arm.OFFSET[1:4]).sum(axis=-1)
