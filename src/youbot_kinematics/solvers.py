"""The two ways to find joint paths along a tour, by the names that the parameters give them."""

from __future__ import annotations

from typing import Callable, NamedTuple

import numpy as np

from .arm import JointLimits
from .differential import line_path
from .exceptions import PlanningError
from .kdl import YoubotKDL
from .kinematics import YoubotKinematics
from .parameters import Parameters
from .progress import with_progress
from .resolve import Options, resolve
from .resolve.explain import explained
from .trajectory import JointPath

#: The pseudo-inverse stays this far inside of the limits, so that the spline through its waypoints,
#: which swings past them a little, stays inside as well (rad).
SPLINE_MARGIN = 2e-3


class Tour(NamedTuple):
    """Where the arm starts, and what it visits in order."""

    start: np.ndarray  # joints, (5,) rad
    checkpoints: np.ndarray  # poses in base_link, the start's first, (n + 1, 4, 4), m
    demanded: list  # for each checkpoint None, or joints (k, 5) rad of which one is demanded

    @property
    def exact(self) -> np.ndarray:
        """Whether more than the position is demanded, for each checkpoint but the start, (n,)."""
        return np.array([joints is not None for joints in self.demanded[1:]])


def pseudo_inverse(tour: Tour, limits: JointLimits, p: Parameters) -> list[JointPath]:
    """The course's way: the pseudo-inverse, from waypoint to waypoint along each straight line.

    Raises:
        PlanningError: it cannot track a line inside the limits, or must meet more than positions.
    """
    if tour.exact.any():
        raise PlanningError(f"it meets positions only, and checkpoint: {p.checkpoint} is asked for")
    if p.orientation_weight:
        raise PlanningError("it follows positions only, and orientation_weight asks for more")
    kinematics = YoubotKDL() if p.kinematics == "kdl" else YoubotKinematics(limits)
    inside = limits.shrunk(SPLINE_MARGIN)
    paths, q = [], tour.start
    lines = list(zip(tour.checkpoints[:-1], tour.checkpoints[1:]))
    for i, (T_a, T_b) in enumerate(with_progress(lines, "tracking the lines", len(lines))):
        paths.append(line_path(kinematics, T_a, T_b, q, inside, i, p.num_points))
        q = paths[-1].joints[-1]
    return paths


def closed_form(tour: Tour, limits: JointLimits, p: Parameters) -> list[JointPath]:
    """The whole tour at once over the branches of the closed form; see ``resolve``.

    Raises:
        PlanningError: a checkpoint is out of reach, or what the way needs is not allowed.
    """
    limits = limits._replace(velocity=p.velocity_scaling * limits.velocity)  # it minds the time
    options = Options(p.reconfigure, p.detour, p.orientation_weight, p.acceleration)
    points, rotations = tour.checkpoints[:, :3, 3], tour.checkpoints[:, :3, :3]
    paths = resolve(tour.start, points, limits, tour.demanded, rotations, options)
    return explained(paths, points, limits)


SOLVERS: dict[str, Callable] = {"pseudo_inverse": pseudo_inverse, "closed_form": closed_form}
