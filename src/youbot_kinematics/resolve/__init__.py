"""The whole tour at once: straight lines of the tool -> joint paths inside the limits.

    paths = resolve(start, points, limits)

The tool moves on straight lines from checkpoint to checkpoint. Its position leaves the arm one free
angle on each of its four branches, so there are infinitely many joint paths: the ``search``
over a grid of pitches (``graph``) finds one with the fewest reconfigurations and, among those, the
least time. Then the pitch is smoothed (``pitch``), the roll chosen (``roll``), and the joints are
computed in closed form again, so that the tool stays on its lines.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.interpolate import CubicSpline, PchipInterpolator
from scipy.spatial.transform import Rotation, Slerp

from .. import arm
from ..exceptions import PlanningError
from ..trajectory import JointPath
from .graph import Tour, lay_out
from .itinerary import DETOUR_MOVE, LINE, NONE, RECONFIGURATION, Itinerary, Run, runs_of
from .itinerary import itinerary as line_up
from .lines import straight_line
from .pitch import joints_on, smooth_pitch
from .roll import smooth_roll, wanted_roll
from .route import Route, route_along
from .search import Walk, best_walk

# Joints are computed at so many points of a step between waypoints; a spline runs through them.
_SAMPLES_PER_STEP = 4
_SPACING = 0.5  # steps between two waypoints that a curve goes through
# A joint that the smooth pitch brings nearer to its limit than the waypoints' margin, rad.
_BESIDE_LIMITS = 1e-9


class Options(NamedTuple):
    """What ``resolve`` may do, and what it minds."""

    reconfigure: bool = True  # whether it may stop on the way to change the arm's posture
    detour: bool = True  # whether the tool may leave a line that the arm cannot follow
    orientation_weight: float = 0.0  # s: what a radian off along a whole line is worth
    acceleration: float = 3.0  # rad/s^2, for the time of stops and moves


def resolve(
    start,
    points,
    limits: arm.JointLimits,
    exact=None,
    rotations=None,
    options=Options(),  # noqa: B008
) -> list[JointPath]:
    """Finds the best joint paths along a tour.

    Args:
        start: where the arm is, joints (5,) rad; its tool is at the first point.
        points: checkpoints (n + 1, 3) in visiting order, in ``base_link``, m.
        exact: for each checkpoint None, or joint positions (k, 5) rad, one of which it demands.
        rotations: orientations of the tool at the checkpoints (n + 1, 3, 3), followed by slerp with
            ``options.orientation_weight``.
        options: what it may do.

    Returns:
        Joint paths, the end of each being the beginning of the next, all from rest to rest: of the
        kinds ``line``, ``reconfiguration`` (the tool begins and ends at one point), ``approach``
        (one before the first line), and ``detour`` (the tool leaves its line and comes back).

    Raises:
        PlanningError: a checkpoint is out of reach, or there is no way without a reconfiguration or
            a detour and the options forbid it.
    """
    start, points = np.asarray(start, dtype=float), np.asarray(points, dtype=float)
    exact = [start[None], *(exact[1:] if exact is not None else [None] * (len(points) - 1))]
    lines = _lines(start, points)
    tour = lay_out(lines, exact, limits, options.acceleration / limits.velocity.max())
    rotations = None if options.orientation_weight == 0 else rotations
    if rotations is not None:
        R, weight = _slerped(rotations, tour.route), options.orientation_weight
        tour = tour._replace(graph=tour.graph._replace(penalty=_penalty(tour, R, weight)))
    walk = _walk(tour)
    runs = runs_of(walk, tour.graph.links)
    _refuse_what_is_forbidden(tour, runs, options)
    way = line_up(tour, runs)
    hold = 0.0 if rotations is None else options.orientation_weight
    pitch = smooth_pitch(way, limits, hold)
    roll = _roll(way, pitch, rotations, options.orientation_weight, limits)
    return _joint_paths(tour, runs, way, pitch, roll, limits)


def _lines(start, points):
    """The straight lines between points; where a line leaves joint 1 free, it stays where it is."""
    azimuth = arm.OFFSET[0] - start[0]
    lines = []
    for a, b in zip(points[:-1], points[1:]):
        lines.append(straight_line(a, b, azimuth))
        azimuth = float(lines[-1].azimuth(1.0))
    return lines


def _walk(tour: Tour) -> Walk:
    """The best walk; the search without reconfigurations is the quicker one, and goes first."""
    walk = best_walk(tour.graph, reconfigure=False) or best_walk(tour.graph)
    if walk is None:
        raise PlanningError("no joint path along the tour was found")
    return walk


def _refuse_what_is_forbidden(tour: Tour, runs: list[Run], options: Options):
    forbidden = {RECONFIGURATION: not options.reconfigure, DETOUR_MOVE: not options.detour}
    for before, run in zip(runs, runs[1:]):
        if not forbidden.get(run.move, False):
            continue
        k = run.waypoints[0] if run.move == RECONFIGURATION else before.waypoints[-1]
        i, u = int(tour.route.line[k]), tour.route.u[k]
        x, y, z = tour.lines[i].point(u)
        where = f"segment {i} to {i + 1}, at ({x:.3f}, {y:.3f}, {z:.3f}) m"
        if run.move == RECONFIGURATION:
            raise PlanningError(f"{where}: the arm must reconfigure there, and may not")
        raise PlanningError(f"{where}: the line leaves what the arm can reach, and may not detour")


def _roll(way: Itinerary, pitch, rotations, weight, limits) -> np.ndarray:
    if rotations is None:
        return smooth_roll(way, np.zeros(len(pitch)), 0.0, limits)
    R = _slerped(rotations, way.route)
    wanted = wanted_roll(R, way.route.azimuth + np.pi * way.track, pitch)
    return smooth_roll(way, wanted, weight, limits)


def _slerped(rotations, route: Route) -> np.ndarray:
    """Orientations (K, 3, 3) at waypoints, by slerp between those of the checkpoints."""
    slerp = Slerp(np.arange(len(rotations)), Rotation.from_matrix(rotations))
    return slerp(route.line + route.u).as_matrix()


def _penalty(tour: Tour, R, weight: float) -> np.ndarray:
    """What the orientation's error at each waypoint costs (K, 4, P), in s.

    ``weight`` times its mean along each line. The angle that the best roll leaves follows from the
    quaternion (w, x, y, z) of ``Rz(-azimuth) R``: see ``inverse``.
    """
    share = weight / np.bincount(tour.route.line)[tour.route.line]
    azimuth = tour.route.azimuth[:, None] + np.pi * np.array([0, 0, 1, 1])
    turned = Rotation.from_euler("z", -azimuth.ravel()) * Rotation.from_matrix(
        np.repeat(R, 4, axis=0)
    )
    x, y, z, w = turned.as_quat().T.reshape(4, *azimuth.shape, 1)
    cos, sin = np.cos(tour.pitch / 2), np.sin(tour.pitch / 2)
    half = np.arccos(np.minimum(np.hypot(cos * w + sin * y, cos * z + sin * x), 1.0))
    return 2 * half * share[:, None, None]


def _joint_paths(tour, runs, way, pitch, roll, limits) -> list[JointPath]:
    paths, last = [], None
    for number, run in enumerate(runs):
        on_run = way.run == number
        s, joints = _along(tour, way, on_run, pitch[on_run], roll[on_run], limits)
        for end in (0, -1):
            demanded = tour.demanded.get((run.waypoints[end], run.cells[end]))
            joints[end] = joints[end] if demanded is None else demanded
        i, u = int(tour.route.line[run.waypoints[0]]), tour.route.u[run.waypoints[0]]
        if run.move != NONE:
            there = run.move == DETOUR_MOVE or 0 < u < 1
            ends = (i, i + 1) if there else (i + int(u), i + int(u))
            both = np.array([last, joints[0]])
            paths.append(JointPath(run.move, *ends, np.array([0.0, 1.0]), both))
        elif last is not None:
            joints[0] = last
        if len(s) > 1:
            paths.append(JointPath(LINE, i, i + 1, s, joints))
        last = joints[-1]
    return paths


def _along(tour: Tour, way: Itinerary, on_run, pitch, roll, limits):
    """Joints (m, 5) along a run, closely sampled, and how far along they are: s (m,) in 0..1."""
    every = np.flatnonzero(on_run)
    curve = CubicSpline
    for knots in (_spaced(way.route.progress[every]), np.arange(len(every))):
        chosen, at = every[knots], way.route.progress[every[knots]]
        fine = _densely(tour, way, chosen)
        progress = fine.route.progress
        if len(every) == 1:
            return np.zeros(1), np.column_stack([joints_on(fine, pitch, limits)[0], roll])
        joints, excess = joints_on(fine, curve(at, pitch[knots])(progress), limits)
        if (excess <= _BESIDE_LIMITS).all():
            break
        curve = PchipInterpolator  # in a narrow tube a curve must not swing
    s = (progress - at[0]) / (at[-1] - at[0])
    return s, np.column_stack([joints, CubicSpline(at, roll[knots])(progress)])


def _spaced(at: np.ndarray) -> np.ndarray:
    """Which waypoints of a run a curve goes through: the ends, and what is not close to others.

    At the end of a detour waypoints crowd, and a curve through all of them would quiver.
    """
    kept = [0]
    for i in range(1, len(at) - 1):
        if min(at[i] - at[kept[-1]], at[-1] - at[i]) >= _SPACING:
            kept.append(i)
    return np.array(kept if len(at) == 1 else [*kept, len(at) - 1])


def _densely(tour: Tour, way: Itinerary, chosen) -> Itinerary:
    """The itinerary of one run with ``_SAMPLES_PER_STEP`` as many waypoints, up to the limits."""
    u = way.route.u[chosen]
    n = (len(u) - 1) * _SAMPLES_PER_STEP + 1
    dense = np.interp(np.linspace(0, len(u) - 1, n), np.arange(len(u)), u)
    route = route_along([tour.lines[way.route.line[chosen[0]]]], [dense])
    return way._replace(
        route=route._replace(margin=np.zeros(n)),
        track=np.full(n, way.track[chosen[0]]),
        elbow=np.full(n, way.elbow[chosen[0]]),
    )
