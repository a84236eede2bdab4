"""Closed-form inverse kinematics: every branch of every pose, and the reason for each without one.

The arm is a planar arm (joints 2, 3, 4) in a vertical plane that joint 1 turns and in which joint 5
rolls the tool. With the azimuth ``phi = 170 deg - q1`` of that plane, the angles from the vertical
``t2 = q2 - 65 deg``, ``t23 = t2 + q3 + 146 deg`` and ``beta = t23 + q4 - 102.5 deg`` (the pitch of
the tool), and the roll ``gamma = 167.5 deg - q5``, the pose of the tool in ``base_link`` is::

    r = 0.033 + 0.155 sin t2 + 0.135 sin t23 - 0.002 cos beta + 0.185 sin beta
    z = 0.145 + 0.155 cos t2 + 0.135 cos t23 + 0.002 sin beta + 0.185 cos beta
    p = (r cos phi, r sin phi, z)        R = Rz(phi) Ry(beta) Rz(gamma)

``r`` is signed: negative where the arm reaches over its back. A pose has four branches, in this
order: front with the elbow angle ``q3 + 146 deg`` >= 0, front with it <= 0, and the same two over
the back. No joint's range reaches a whole turn, so a branch has one solution at most.

Derived from the Denavit-Hartenberg table of ``arm``; the method is that of Pieper (1968).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from . import arm, formulas
from .exceptions import InputError
from .formulas import LAST_ROW_TOLERANCE, POSE_TOLERANCE, ROTATION_TOLERANCE
from .planar import wrap_between

BRANCH_NAMES = ("front, elbow +", "front, elbow -", "back, elbow +", "back, elbow -")

# The same numbers as in the table above, from their one definition.
SHOULDER_R, SHOULDER_Z = -arm.A[0], arm.D[0]
UPPER_ARM, FOREARM = arm.A[1], arm.A[2]
TOOL_OFFSET, TOOL_LENGTH = arm.A[3], -arm.D[4]
AZIMUTH_0, ROLL_0 = arm.OFFSET[0], -arm.OFFSET[4]


class Branches(NamedTuple):
    """The whole answer of the inverse kinematics: a row for each of the four branches.

    A branch is valid if it has no reason against it: all of ``out_of_reach``, ``limit_excess`` and
    ``tilt`` are zero to rounding. Where one of them is not, the others are those of the nearest
    configuration: stretched or folded towards the wrist, turned back into the plane.
    """

    joints: np.ndarray  # (..., 4, 5) rad; solutions only where ``valid``, else what comes nearest
    valid: np.ndarray  # (..., 4) bool
    out_of_reach: np.ndarray  # (..., 4) m: wrist beyond the stretched arm (+), in the folded (-)
    limit_excess: np.ndarray  # (..., 4, 5) rad: below (-) or above (+) the limit, 0 inside
    tilt: np.ndarray  # (..., 4) rad: the tool's z axis out of the arm's plane

    def reasons(self) -> list[str]:
        """One sentence for each branch of a single pose: why it has no solution, or that it has."""
        if self.valid.ndim != 1:
            raise InputError(f"reasons are for one pose; this is a batch {self.valid.shape[:-1]}")
        return [f"{name}: {self._reason(i)}" for i, name in enumerate(BRANCH_NAMES)]

    def _reason(self, i: int) -> str:
        if self.valid[i]:
            return "solved"
        if abs(self.tilt[i]) > POSE_TOLERANCE:
            return f"tool tilted {self.tilt[i]:.3g} rad out of the arm's plane"
        if self.out_of_reach[i] > 0:
            return f"out of reach by {self.out_of_reach[i]:.3g} m"
        if self.out_of_reach[i] < 0:
            return f"too close to the shoulder by {-self.out_of_reach[i]:.3g} m"
        joint = int(np.argmax(np.abs(self.limit_excess[i])))
        excess = self.limit_excess[i, joint]
        side = "above its upper" if excess > 0 else "below its lower"
        return f"{arm.JOINT_NAMES[joint]} would be {abs(excess):.3g} rad {side} limit"


def inverse_branches(T, limits: arm.JointLimits, seed=None) -> Branches:
    """Solves each of the four branches for poses of the tool.

    Args:
        T: poses of ``arm_link_ee`` in ``base_link``, (4, 4) or (..., 4, 4), translations in m.
        limits: the limits that the solutions keep.
        seed: joint positions (5,) in rad that choose joint 1 where the pose leaves it free, tool
            vertical on joint 1's axis: the two front branches take the nearest value to it for
            which joint 5 is inside its limits as well, the two at the back half a turn from that.
            Default: the middle of joint 1's range.

    Raises:
        InputError: T is not an array of rigid transforms.
    """
    answer = formulas.branches(T, limits.lower, limits.upper, seed)
    if answer is None:
        answer = formulas.branches(as_transforms(T), limits.lower, limits.upper, seed)
    return Branches(*answer)


def solutions(T, limits: arm.JointLimits, seed=None) -> np.ndarray:
    """The valid joints (k, 5) of ``inverse_branches`` for one pose (4, 4), each once.

    Raises:
        InputError: T is not one rigid transform.
    """
    found = formulas.solutions(T, limits.lower, limits.upper, seed)
    if found is None:
        found = formulas.solutions(as_transform(T), limits.lower, limits.upper, seed)
    return found


def plane_azimuths(T, limits: arm.JointLimits, seed=None) -> tuple[float, float]:
    """Azimuths (rad) of the arm's plane for a pose (4, 4): reaching forward, and over the back.

    Raises:
        InputError: T is not one rigid transform.
    """
    front = formulas.azimuth(as_transform(T), limits.lower, limits.upper, seed)
    return front, front + np.pi


def plane_joints(radius, height, pitch):
    """Joints 2, 3 and 4 that bring the tool to a point of the arm's plane at a pitch.

    Args:
        radius, height, pitch: r and z (m) and beta (rad) as above, broadcast to one shape (...).

    Returns:
        ``(joints, beyond)``: (..., 2, 3) rad, not wrapped, elbow + and -; and by how much the wrist
        is out of reach, (...) m, as ``planar.inverse_2r`` has it.
    """
    return formulas.bend(np.stack(np.broadcast_arrays(radius, height, pitch), axis=-1))


def wrap_into_limits(q: np.ndarray, limits: arm.JointLimits) -> np.ndarray:
    """Joint positions (..., 5) turned by whole turns to where they are next to their range (rad).

    A value outside of its limit by no more than rounding is set on the limit.
    """
    return wrap_between(q, limits.lower, limits.upper)


def as_transforms(T, tolerance: float = ROTATION_TOLERANCE) -> np.ndarray:
    """``T`` as a float array (..., 4, 4) of rigid transforms.

    Raises:
        InputError: wrong shape, a value that is not finite, or not a rotation to the tolerance.
    """
    try:
        T = np.asarray(T, dtype=float)
    except (TypeError, ValueError, OverflowError):
        raise InputError(f"a pose must be an array (4, 4) of numbers, not {T!r}") from None
    if T.shape[-2:] != (4, 4):
        raise InputError(f"a pose must have shape (4, 4) or (..., 4, 4); got {T.shape}")
    finite, error, left_handed, last_row = formulas.flaws(T)
    if not finite:
        raise InputError("a pose must be finite; it has NaN or infinity in it")
    if error > tolerance or left_handed:
        raise InputError(
            f"a pose must hold a rotation matrix; R^T R is off the identity by {error:.2g}"
            " or the frame is left-handed: normalise it, or ask for nearest_reachable_pose"
        )
    if last_row > LAST_ROW_TOLERANCE:
        raise InputError("the last row of a pose must be 0 0 0 1")
    return T


def as_transform(T) -> np.ndarray:
    """``T`` as one rigid transform (4, 4); raises InputError if it is none, or several."""
    T = as_transforms(T)
    if T.ndim != 2:
        raise InputError(f"this takes one pose (4, 4), not {T.shape}; inverse_branches takes many")
    return T
