"""Kinematics of the arm: Denavit-Hartenberg forward kinematics, Jacobian, singularities, inverse.

Everything broadcasts: joints are (5,) or (..., 5), results (4, 4) or (..., 4, 4), and so on.
Sources: Siciliano et al., "Robotics: Modelling, Planning and Control" (2009), sections 2.8
(Denavit-Hartenberg), 3.1 (geometric Jacobian) and 3.3 (singularities).
"""

from __future__ import annotations

import operator

import numpy as np

from . import arm, formulas, posture, singularity
from .exceptions import InputError
from .inverse import Branches, inverse_branches, solutions
from .nearest import NearestPose, nearest_reachable_pose
from .position import PositionSolutions, inverse_position
from .selection import select_solution
from .singularity import SINGULARITY_THRESHOLD


def as_joints(q) -> np.ndarray:
    """``q`` as a float array (..., 5) in rad.

    Raises:
        InputError: the last axis is not 5 long, or a value is not a finite number.
    """
    try:
        joints = np.asarray(q, dtype=float)
    except (TypeError, ValueError, OverflowError):
        raise InputError(
            f"joint positions must be numbers in an array (..., 5), not {q!r}"
        ) from None
    if joints.ndim == 0 or joints.shape[-1] != arm.DOF:
        raise InputError(
            f"joint positions must have shape (5,) or (..., 5), one a joint; got {joints.shape}"
        )
    if not np.isfinite(joints).all():
        bad = np.argwhere(~np.isfinite(joints))[0]
        raise InputError(
            f"joint positions must be finite; {arm.JOINT_NAMES[bad[-1]]} is {joints[tuple(bad)]}"
        )
    return joints


def as_joint_number(number) -> int:
    """``number`` as an index of the frames of the arm, 0 (the base) to 5 (the tool).

    Raises:
        InputError: it is not an integer from 0 to 5.
    """
    try:
        index = operator.index(number)
    except TypeError:
        index = -1
    if not 0 <= index <= arm.DOF:
        raise InputError(f"up_to_joint must be an integer 0 to {arm.DOF}, not {number!r}")
    return index


def dh_frames(q) -> np.ndarray:
    """Poses of the base and of the five Denavit-Hartenberg frames in ``base_link``.

    Args:
        q: joint positions (..., 5), rad.

    Returns:
        (..., 6, 4, 4): index 0 is the base (identity), 5 the tool; translations in m.

    Raises:
        InputError: q has another shape, or is not finite.
    """
    frames = formulas.dh_frames(q)
    return formulas.dh_frames(as_joints(q)) if frames is None else frames


def tool_pose(q) -> np.ndarray:
    """Pose (..., 4, 4) of the tool in ``base_link``, the last of ``dh_frames(q)``; m.

    Raises:
        InputError: q has another shape than (..., 5), or is not finite.
    """
    T = formulas.tool_pose(q)
    return formulas.tool_pose(as_joints(q)) if T is None else T


def jacobian(q) -> np.ndarray:
    """Geometric Jacobian of the tool, linear (m/rad) over angular velocity (rad/rad).

    Args:
        q: joint positions (..., 5), rad.

    Returns:
        (..., 6, 5) in ``base_link``.

    Raises:
        InputError: q has another shape, or is not finite.
    """
    J = formulas.jacobian(q)
    return formulas.jacobian(as_joints(q)) if J is None else J


def smallest_singular_value(q) -> np.ndarray:
    """Smallest singular value (...) of ``jacobian(q)``, from its two blocks: see ``singularity``.

    Args:
        q: joint positions (..., 5), rad.

    Raises:
        InputError: q has another shape, or is not finite.
    """
    value = formulas.smallest_singular_value(q)
    return formulas.smallest_singular_value(as_joints(q)) if value is None else value


class Kinematics:
    """What any kinematic model of the arm offers, over its forward kinematics and Jacobian."""

    def forward_kinematics(self, q, up_to_joint: int = arm.DOF) -> np.ndarray:
        """Pose of the frame after joint ``up_to_joint`` in ``base_link``, for joints q in rad."""
        raise NotImplementedError

    def get_jacobian(self, q) -> np.ndarray:
        """Geometric Jacobian (..., 6, 5) of the tool in ``base_link``, for joints q in rad."""
        raise NotImplementedError

    def smallest_singular_value(self, q, position_only: bool = False) -> np.ndarray:
        """Smallest singular value of the Jacobian: (...) for q of (..., 5) rad.

        Args:
            q: joint positions, (5,) or (..., 5), rad.
            position_only: of the 3x5 part that moves the tool's position, not of the whole 6x5.

        Raises:
            InputError: q has another shape, or is not finite.
        """
        return singularity.smallest_singular_value(self._task_jacobian(q, position_only))

    def manipulability(self, q, position_only: bool = False) -> np.ndarray:
        """Yoshikawa's measure, the product of the singular values: (...) for q of (..., 5) rad.

        The arguments are those of ``smallest_singular_value``.
        """
        return singularity.manipulability(self._task_jacobian(q, position_only))

    def _task_jacobian(self, q, position_only):
        J = self.get_jacobian(q)
        return J[..., :3, :] if position_only else J

    def check_singularity(self, q, position_only: bool = False):
        """Whether the arm is singular: a singular value below ``SINGULARITY_THRESHOLD``.

        The whole Jacobian (rank below 5) is singular with a straight (or fully folded) elbow, and
        with the tool vertical on joint 1's axis. Its position part (rank below 3) is singular with
        the tool on joint 1's axis, and with shoulder, elbow, wrist and tool all in one line: a
        straight elbow alone is not singular for the position. ``singularity`` derives this.

        Args:
            q: joint positions, (5,) or (..., 5), rad.
            position_only: judge only the 3x5 part that moves the tool's position.

        Returns:
            A bool for q of (5,), an array (...) of bool for a batch.

        Raises:
            InputError: q has another shape, or is not finite.
        """
        singular = self.smallest_singular_value(q, position_only) < SINGULARITY_THRESHOLD
        return bool(singular) if np.ndim(singular) == 0 else singular

    def classify_singularity(self, q) -> singularity.Singularities:
        """Kinds of singularity that joints q, (5,) or (..., 5) rad, are in: see ``singularity``."""
        q = as_joints(q)
        return singularity.classify(q, self.get_jacobian(q))


class YoubotKinematics(Kinematics):
    """Kinematics of the youBot arm from its Denavit-Hartenberg table, with closed-form inverse.

    Args:
        limits: the profile of joint limits that solutions keep, ``"urdf"`` or ``"hardware"``, or a
            ``JointLimits``.

    Raises:
        InputError: there is no such profile.
    """

    def __init__(self, limits="urdf"):
        self.limits = arm.joint_limits(limits)

    def forward_kinematics(self, q, up_to_joint: int = arm.DOF) -> np.ndarray:
        """Pose of a Denavit-Hartenberg frame in ``base_link``: the product of its DH transforms.

        Args:
            q: joint positions, (5,) or (..., 5), rad.
            up_to_joint: the frame, 0 (``base_link``) to 5 (``arm_link_ee``).

        Returns:
            Homogeneous transform, (4, 4) or (..., 4, 4), translation in m.

        Raises:
            InputError: q has another shape or is not finite, or there is no such frame.
        """
        if up_to_joint == arm.DOF:
            return tool_pose(q)
        return dh_frames(q)[..., as_joint_number(up_to_joint), :, :].copy()

    def get_jacobian(self, q) -> np.ndarray:
        """Geometric Jacobian of the tool, linear over angular velocity, in ``base_link``.

        Args:
            q: joint positions, (5,) or (..., 5), rad.

        Returns:
            (6, 5) or (..., 6, 5): m/rad and rad/rad.

        Raises:
            InputError: q has another shape, or is not finite.
        """
        return jacobian(q)

    def smallest_singular_value(self, q, position_only: bool = False) -> np.ndarray:
        """Smallest singular value of the Jacobian: (...) for q of (..., 5) rad.

        The arguments are those of ``Kinematics.smallest_singular_value``.
        """
        if position_only:
            return super().smallest_singular_value(q, position_only)
        return smallest_singular_value(q)

    def inverse_kinematics(self, T, seed=None) -> np.ndarray:
        """Every joint position inside the limits that brings the tool to a pose, in closed form.

        The arm has five joints and a pose six coordinates: only poses whose tool z axis lies in the
        arm's vertical plane (to ``inverse.POSE_TOLERANCE``) have solutions. No other pose than the
        one asked for is ever answered; ``inverse_branches`` says why there is no answer.

        Args:
            T: pose of ``arm_link_ee`` in ``base_link``, (4, 4), translation in m.
            seed: joint positions (5,), rad; see ``inverse_branches``.

        Returns:
            (k, 5) rad with 0 <= k <= 4, in the order of the branches, each solution once: where the
            elbow is straight, two branches are one.

        Raises:
            InputError: T is not one rigid transform.
        """
        return solutions(T, self.limits, None if seed is None else _as_seed(seed))

    def inverse_branches(self, T, seed=None) -> Branches:
        """The whole answer for poses (..., 4, 4): see ``inverse.inverse_branches``."""
        return inverse_branches(T, self.limits, _as_seed(seed))

    def inverse_position(self, p, pitch=None, roll=None, seed=None) -> PositionSolutions:
        """The solutions for the tool's position p (3,) alone: see ``position.inverse_position``."""
        return inverse_position(p, self.limits, pitch, roll, _as_seed(seed))

    def nearest_reachable_pose(self, T, seed=None) -> NearestPose:
        """The nearest pose to T (4, 4) with solutions: see ``nearest.nearest_reachable_pose``."""
        return nearest_reachable_pose(T, self.limits, _as_seed(seed))

    def select_solution(self, solutions, criterion="movement", seed=None, previous=None):
        """The best (5,) of some solutions (k, 5), rad: see ``selection.select_solution``.

        Args:
            solutions: joint positions (k, 5), rad, k >= 1.
            criterion: ``"movement"``, ``"limits"``, ``"singularity"``, ``"smoothness"``, a name of
                ``configuration``, or weights of several, ``{"limits": 1.0, "elbow_up": 0.5}``.
            seed, previous: joint positions (5,) where the arm is, and where it was before, rad.

        Raises:
            InputError: there are no solutions, no such criterion, or what it needs is not given.
        """
        return select_solution(solutions, criterion, self, _as_seed(seed), _as_seed(previous))

    def configuration(self, q) -> dict[str, np.ndarray]:
        """Which named configurations joints q, (5,) or (..., 5) rad, are in: see ``posture``."""
        return posture.configuration(as_joints(q))


def _as_seed(q):
    """Joint positions (5,) in rad, or None."""
    if q is None:
        return None
    q = as_joints(q)
    if q.ndim != 1:
        raise InputError(f"a seed is one configuration, of shape (5,); got {q.shape}")
    return q
