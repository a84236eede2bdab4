"""From targets to a checked trajectory: the recipe of the course, step by step."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .arm import DOF, JointLimits, joint_limits
from .check import Report, check
from .exceptions import InputError, PlanningError
from .kinematics import YoubotKinematics, as_joints
from .parameters import Parameters
from .path import intermediate_tfs
from .solvers import SOLVERS, Tour
from .targets import Targets
from .timing import time_paths
from .tour import path_length, shortest_path
from .trajectory import Trajectory

#: A start this little outside of the limits, by rounding or a sensor's noise, is set on them (rad).
START_TOLERANCE = 1e-3

#: What is planned at once, in some minutes and in memory that a computer has.
MOST_TARGETS, MOST_WAYPOINTS = 2_000, 200_000


@dataclass(frozen=True)
class Plan:
    """A trajectory through all targets, with everything that led to it."""

    targets: Targets
    parameters: Parameters
    start: np.ndarray  # joints where the arm starts, (5,) rad
    order: np.ndarray  # indices of the targets in visiting order, (n,)
    length: float  # of the tool's way through the checkpoints, m
    checkpoints: np.ndarray  # poses: the start's, then the targets' as visited, (n + 1, 4, 4), m
    met_in_position_only: np.ndarray  # indices of targets whose pose was asked for in vain, (m,)
    poses: np.ndarray  # evenly spaced waypoints, checkpoints included, (m, 4, 4), m
    solver: str  # the one that found the joints
    solver_reason: str  # why it was that one
    trajectory: Trajectory
    report: Report


def plan(targets: Targets, start, parameters: Parameters | None = None) -> Plan:
    """Plans a trajectory that visits all targets.

    Args:
        targets: where the tool shall go; see ``load_targets``.
        start: joint positions where the arm is, (5,) rad.
        parameters: how to plan; the defaults if not given.

    Returns:
        The plan; its ``report`` says what the trajectory keeps, and it has passed its check.

    Raises:
        InputError: the start is not five finite numbers inside the limits, there are no targets or
            too many, or they have no joints where these are to be met.
        PlanningError: there is no trajectory through the targets inside the limits, or none that
            the parameters allow.
    """
    p = parameters or Parameters()
    limits = joint_limits(p.limits)
    start = _start_inside(start, limits)
    _require_plannable(len(targets), p)

    kinematics = YoubotKinematics(limits)
    T_start = kinematics.forward_kinematics(start)
    order, length = _visiting_order(T_start[:3, 3], targets.poses[:, :3, 3], p)
    tour = _tour(kinematics, start, T_start, targets, order, p)
    poses = intermediate_tfs(range(len(tour.checkpoints)), tour.checkpoints, p.num_points)
    found = _first_that_passes(tour, limits, p)
    in_vain = order[~tour.exact[: len(order)]] if p.checkpoint == "pose" else order[:0]
    return Plan(targets, p, start, order, length, tour.checkpoints, in_vain, poses, *found)


def _require_plannable(count: int, p: Parameters) -> None:
    """Raises InputError for a number of targets that no one can visit."""
    if not count:
        raise InputError("there are no targets to visit")
    if count > MOST_TARGETS:
        raise InputError(f"{count:,} targets: at most {MOST_TARGETS:,} are planned at once")
    waypoints = count * (p.num_points + 1)
    if waypoints > MOST_WAYPOINTS:
        raise InputError(
            f"{count:,} targets with num_points {p.num_points} give {waypoints:,} waypoints:"
            f" at most {MOST_WAYPOINTS:,} are planned at once"
        )


def _start_inside(start, limits: JointLimits) -> np.ndarray:
    """The start (5,) rad, set on a limit that it passes by no more than noise."""
    start = as_joints(start)
    if start.shape != (DOF,):
        raise InputError(f"the start must be five joint positions, not an array {start.shape}")
    if not limits.contain(start, START_TOLERANCE):
        raise InputError(f"the start is outside of the limits: {limits.describe_violation(start)}")
    return np.clip(start, limits.lower, limits.upper)


def _visiting_order(start, positions, p: Parameters):
    """Indices of the targets as they are visited, and the length of the tool's way in m."""
    if p.order == "shortest":
        return shortest_path(start, positions, p.return_home)
    home = [start] if p.return_home else []
    return np.arange(len(positions)), path_length(np.vstack([start, positions, *home]))


def _tour(kinematics, start, T_start, targets: Targets, order, p: Parameters) -> Tour:
    """The checkpoints in visiting order, and the joints that are demanded at them."""
    if p.checkpoint == "joints" and targets.joints is None:
        raise InputError(
            "the targets are poses, without joints to be met: choose checkpoint pose or position"
        )
    checkpoints, demanded = [T_start], [start[None]]
    for i in order:
        checkpoints.append(targets.poses[i])
        demanded.append(_demanded(kinematics, targets, i, p.checkpoint))
    if p.return_home:
        checkpoints.append(T_start)
        demanded.append(None if p.checkpoint == "position" else start[None])
    return Tour(start, np.stack(checkpoints), demanded)


def _demanded(kinematics, targets: Targets, i: int, checkpoint: str):
    """Joints (k, 5) rad of which one must be met at a target, or None for its position alone."""
    if checkpoint == "joints" and targets.joints is not None:
        return targets.joints[i : i + 1]
    if checkpoint == "pose":
        solutions = kinematics.inverse_kinematics(targets.poses[i])
        return solutions if len(solutions) else None  # a pose out of reach: as near as its position
    return None


def _first_that_passes(tour: Tour, limits: JointLimits, p: Parameters):
    """The first solver whose trajectory passes its check: ``(name, why, trajectory, report)``.

    Raises:
        PlanningError: there is none; what the last one failed for.
    """
    names = list(SOLVERS) if p.solver == "auto" else [p.solver]
    why = "the path is tracked inside the limits" if p.solver == "auto" else "as asked for"
    for name in names:
        try:
            trajectory, report = _timed_and_checked(SOLVERS[name](tour, limits, p), tour, limits, p)
            return name, why, trajectory, report
        except PlanningError as error:
            failure, why = error, f"{name} failed: {error}"
    if p.solver == "pseudo_inverse":
        raise PlanningError(f"{failure}; solver auto may find a way") from failure
    raise failure


def _timed_and_checked(paths, tour: Tour, limits: JointLimits, p: Parameters):
    velocity = p.velocity_scaling * limits.velocity
    trajectory = time_paths(paths, velocity, np.full(DOF, p.acceleration), p.dt, p.timing)
    report = check(trajectory, limits, p.acceleration, tour.checkpoints, tour.exact)
    if report.failures:
        raise PlanningError("the trajectory failed its check: " + "; ".join(report.failures))
    return trajectory, report
