"""Pseudo-inverse inverse kinematics: one pose, and a whole path warm-started along it.

A damped Newton iteration on the tool's position, with the orientation followed in the null space.
Sources: Nakamura and Hanafusa (1986) and Sugihara (2011) for the damping; Siciliano and Slotine
(1991) for the order of tasks; Flacco, De Luca and Khatib (2012) for keeping joint limits by
saturation in the null space: a joint that would leave its range is taken out of the solution, and
the others do its work.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.spatial.transform import Rotation

from . import arm
from .exceptions import PlanningError
from .kinematics import Kinematics
from .path import pose_between
from .trajectory import JointPath

#: The position counts as reached when it is this close, m.
POSITION_TOLERANCE = 1e-7
#: Half-way of a step, the straight way of the joints may leave the line by so much, m.
STEP_TOLERANCE = 2.5e-4
#: Between its waypoints a path's spline may leave the line by so much, m.
LINE_TOLERANCE = 2e-5
#: ... and a joint limit by so much, rad.
SPLINE_SWING = 1e-3
#: Steps are not made shorter than this, m: where one fails, the arm is stuck or would jump.
MIN_STEP = 1e-4
#: How fast the tool turns towards the wanted orientation, rad per m of the line.
TURN_PER_METRE = 10.0
#: Iterations for one pose; warm-started waypoints take about five.
MAX_ITERATIONS = 60
#: Longest joint step of an iteration, rad: beyond it the linearisation says little.
MAX_STEP = 0.2
#: Damping of the orientation's solution in the null space, and of that space itself. (The position
#: is damped by its own error, so that it converges quadratically however near a singularity is.)
ORIENTATION_DAMPING, NULL_DAMPING = 0.1, 1e-4
# The iteration ends when the joints move less than this, rad: it is stuck, or, once the position is
# reached, as good as there.
_STUCK, _STILL = 1e-9, 1e-4


class PositionSolution(NamedTuple):
    """What ``ik_position_only`` came to."""

    joints: np.ndarray  # (5,) rad, inside the limits
    residual: float  # distance of the tool from where it should be, m
    angle: float  # angle of the tool's orientation from the wanted one, rad

    @property
    def converged(self) -> bool:
        """Whether the position is reached to ``POSITION_TOLERANCE``."""
        return self.residual <= POSITION_TOLERANCE


def ik_position_only(
    kinematics: Kinematics, pose, q0, limits: arm.JointLimits, max_turn: float = np.inf
) -> PositionSolution:
    """Brings the tool's position to that of a pose, and its orientation as near as that leaves.

    Args:
        kinematics: the arm's forward kinematics and Jacobian.
        pose: wanted pose of the tool in ``base_link``, (4, 4), m.
        q0: joint positions to start from, (5,) rad, inside the limits.
        limits: joint limits; every iterate keeps them.
        max_turn: the tool turns towards the pose's orientation by no more than this, rad; with 0
            the joints move no farther from q0 than the position needs.

    Returns:
        The last iterate and what is left of the error: whether it ``converged`` is the caller's
        to look at.
    """
    q = np.array(q0, dtype=float)
    goal = _turned_at_most(kinematics.forward_kinematics(q), pose, max_turn)
    for _ in range(MAX_ITERATIONS):
        linear, angular = _pose_error(kinematics.forward_kinematics(q), goal)
        step = _limited_step(
            kinematics.get_jacobian(q), linear, angular if max_turn else None, q, limits
        )
        moved = np.abs(step).max()
        if moved < (_STILL if np.linalg.norm(linear) <= POSITION_TOLERANCE / 2 else _STUCK):
            break
        q = q + step
    linear, angular = _pose_error(kinematics.forward_kinematics(q), pose)
    return PositionSolution(q, float(np.linalg.norm(linear)), float(np.linalg.norm(angular)))


def full_checkpoints_to_joints(
    kinematics: Kinematics, poses, q0, limits: arm.JointLimits
) -> np.ndarray:
    """Joint positions along a path of poses, each solved from the one before.

    Args:
        kinematics: the arm's forward kinematics and Jacobian.
        poses: waypoints in ``base_link``, (m, 4, 4), m; the first is where the arm starts.
        q0: joint positions at the first waypoint, (5,) rad, inside the limits.
        limits: joint limits to keep.

    Returns:
        (m, 5) rad.

    Raises:
        PlanningError: a waypoint cannot be reached from the one before inside the limits; the
            sentence names it, the distance left, and the joint that is held by its limit.
    """
    tracks = _tracks(kinematics, poses, q0, limits)
    return np.array([np.asarray(q0, dtype=float), *(joints[-1] for _, joints in tracks)])


def track_line(kinematics: Kinematics, T_a, T_b, q_a, limits: arm.JointLimits, name: str):
    """Follows the straight line between two poses, in as few steps as keep the tool on it.

    A step that fails, or whose joints would leave the line half-way, is taken in two halves: so the
    arm turns round where the line passes close to joint 1's axis, and does not leap over it.

    Args:
        kinematics: the arm's forward kinematics and Jacobian.
        T_a, T_b: poses at the ends of the line, (4, 4), m.
        q_a: joints at its beginning, (5,) rad.
        limits: joint limits to keep.
        name: what the waypoint is called if it cannot be reached.

    Returns:
        ``(s, joints)``: the fractions of the line, (m,), from 0 to 1, and the joints there, (m, 5).

    Raises:
        PlanningError: as ``full_checkpoints_to_joints``.
    """
    length = float(np.linalg.norm(T_b[:3, 3] - T_a[:3, 3]))
    s, joints, goals = [0.0], [q_a], [1.0]
    while goals:
        half_way, pose = pose_between(T_a, T_b, [(s[-1] + goals[-1]) / 2, goals[-1]])
        turn = TURN_PER_METRE * length * (goals[-1] - s[-1])
        solution = ik_position_only(kinematics, pose, joints[-1], limits, turn)
        straight = kinematics.forward_kinematics((joints[-1] + solution.joints) / 2)
        off = np.linalg.norm(straight[:3, 3] - half_way[:3, 3])
        if solution.converged and off <= STEP_TOLERANCE:
            s.append(goals.pop())
            joints.append(solution.joints)
        elif length * (goals[-1] - s[-1]) > MIN_STEP:
            goals.append((s[-1] + goals[-1]) / 2)
        else:
            raise PlanningError(_why_not(name, pose, joints[-1], solution, limits))
    return np.array(s), np.array(joints)


def line_path(kinematics: Kinematics, T_a, T_b, q_a, limits, checkpoint: int, num_points: int):
    """The joints along one straight line between checkpoints as a smooth path.

    Between waypoints the spline of the joints leaves the line a little, or swings past a limit;
    there waypoints are added, solved from where the spline is, until it does not.

    Args:
        kinematics: the arm's forward kinematics and Jacobian.
        T_a, T_b: poses of the checkpoints, (4, 4), m.
        q_a: joints at the first, (5,) rad.
        limits: joint limits to keep.
        checkpoint: number of the first.
        num_points: intermediate waypoints at least, evenly spaced.

    Returns:
        ``JointPath`` of kind ``line``.

    Raises:
        PlanningError: as ``full_checkpoints_to_joints``.
    """
    path = _waypoints(kinematics, T_a, T_b, q_a, limits, checkpoint, num_points)
    length = np.linalg.norm(T_b[:3, 3] - T_a[:3, 3])
    while True:
        between = (path.s[:-1] + path.s[1:]) / 2
        poses, guess = pose_between(T_a, T_b, between), path.spline()(between)
        off = kinematics.forward_kinematics(guess)[:, :3, 3] - poses[:, :3, 3]
        leaves = np.linalg.norm(off, axis=1) > LINE_TOLERANCE
        leaves |= ~limits.contain(guess, SPLINE_SWING)
        add = np.flatnonzero(leaves & (np.diff(path.s) * length > MIN_STEP))
        if not len(add):
            return path
        guess = np.clip(guess, limits.lower, limits.upper)
        solved = [ik_position_only(kinematics, poses[i], guess[i], limits, 0.0) for i in add]
        path = path._replace(
            s=np.insert(path.s, add + 1, between[add]),
            joints=np.insert(path.joints, add + 1, [x.joints for x in solved], axis=0),
        )


def _waypoints(kinematics, T_a, T_b, q_a, limits, checkpoint, num_points) -> JointPath:
    """The path through evenly spaced waypoints, and those that tracking them needed."""
    grid = np.linspace(0.0, 1.0, num_points + 2)
    s, joints = [np.zeros(1)], [np.reshape(q_a, (1, arm.DOF))]
    first = checkpoint * (num_points + 1)
    tracks = _tracks(kinematics, pose_between(T_a, T_b, grid), q_a, limits, first)
    for begin, step, (part, q) in zip(grid, np.diff(grid), tracks):
        s.append(begin + part[1:] * step)
        joints.append(q[1:])
    return JointPath("line", checkpoint, checkpoint + 1, np.concatenate(s), np.concatenate(joints))


def _tracks(kinematics, poses, q, limits, first=0):
    """What ``track_line`` gives for each two successive poses; ``first`` numbers the first pose."""
    for i, (T_a, T_b) in enumerate(zip(poses[:-1], poses[1:]), start=first + 1):
        s, joints = track_line(kinematics, T_a, T_b, q, limits, f"waypoint {i}")
        yield s, joints
        q = joints[-1]


def _turned_at_most(T, T_wanted, max_turn) -> np.ndarray:
    """The wanted pose with its orientation no farther than max_turn (rad) from that of T."""
    turn = _pose_error(T, T_wanted)[1]
    goal = np.array(T_wanted, dtype=float)
    turn *= min(1.0, max_turn / max(np.linalg.norm(turn), 1e-12))
    goal[:3, :3] = Rotation.from_rotvec(turn).as_matrix() @ T[:3, :3]
    return goal


def _pose_error(T, T_wanted):
    """Linear (m) and angular (rotation vector, rad) way from a pose to the wanted one."""
    linear = T_wanted[:3, 3] - T[:3, 3]
    return linear, Rotation.from_matrix(T_wanted[:3, :3] @ T[:3, :3].T).as_rotvec()


def _limited_step(J, linear, angular, q, limits) -> np.ndarray:
    """A joint step (5,) rad that keeps the limits: joints that would leave them are taken out."""
    free = np.ones(arm.DOF, dtype=bool)
    while free.any():
        step = np.zeros(arm.DOF)
        step[free] = _prioritised_step(J[:, free], linear, angular)
        step *= min(1.0, MAX_STEP / max(np.abs(step).max(), _STUCK))
        leaving = free & (np.abs(limits.excess(q + step)) > np.abs(limits.excess(q)))
        if not leaving.any():
            return step
        free &= ~leaving
    return np.zeros(arm.DOF)


def _prioritised_step(J, linear, angular) -> np.ndarray:
    """Joint step for the position, and in its null space for the orientation, unless None."""
    J_linear, J_angular = J[:3], J[3:]
    step = damped_pseudo_inverse(J_linear, float(np.linalg.norm(linear))) @ linear
    if angular is None:
        return step
    null_space = np.eye(J.shape[1]) - damped_pseudo_inverse(J_linear, NULL_DAMPING) @ J_linear
    rotation = damped_pseudo_inverse(J_angular @ null_space, ORIENTATION_DAMPING)
    return step + null_space @ (rotation @ (angular - J_angular @ step))


def damped_pseudo_inverse(J: np.ndarray, damping: float) -> np.ndarray:
    """Pseudo-inverse of J (r, c) whose gain stays below ``1 / (2 damping)`` near singularities.

    Each singular value s is inverted as ``s / (s^2 + damping^2)``, and as 0 where both vanish.
    """
    U, s, Vt = np.linalg.svd(J, full_matrices=False)
    gain = s / np.maximum(s**2 + damping**2, 1e-18)
    return (Vt.T * gain) @ U.T


def _why_not(waypoint, pose, q_before, solution, limits) -> str:
    """One sentence: which waypoint, how far the tool stays from it, and the joint to blame."""
    q = solution.joints
    if solution.converged:
        joint = int(np.argmax(np.abs(q - q_before)))
        name, before, now = arm.JOINT_NAMES[joint], q_before[joint], q[joint]
        what = f"{name} jumps there from {before:.4f} to {now:.4f} rad"
    else:
        to_lower, to_upper = q - limits.lower, limits.upper - q
        joint = int(np.argmin(np.minimum(to_lower, to_upper)))
        side = "lower" if to_lower[joint] <= to_upper[joint] else "upper"
        what = (
            f"the tool stays {solution.residual * 1000:.3g} mm away, with {arm.JOINT_NAMES[joint]}"
            f" at {q[joint]:.4f} rad next to its {side} limit"
            f" {getattr(limits, side)[joint]:.4f} rad"
        )
    x, y, z = pose[:3, 3]
    return (
        f"{waypoint} at ({x:.3f}, {y:.3f}, {z:.3f}) m cannot be tracked inside the joint limits:"
        f" {what}"
    )
