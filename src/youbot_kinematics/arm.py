"""The KUKA youBot arm as data: frames, Denavit-Hartenberg table, joint limits.

SI units and radians. The base frame is ``base_link``, the tool frame ``arm_link_ee``. Joint
positions are the URDF's (and the driver's): zero on all joints is the folded arm.

Every number about the arm that the Python code uses is defined here, once; ``urdf/youbot_arm.urdf``
says the same in its own language, and a test holds the two together.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from .exceptions import InputError

BASE_FRAME = "base_link"
TOOL_FRAME = "arm_link_ee"
JOINT_NAMES = ("arm_joint_1", "arm_joint_2", "arm_joint_3", "arm_joint_4", "arm_joint_5")
DOF = len(JOINT_NAMES)

# Standard Denavit-Hartenberg parameters: T_i = Rz(theta_i) Tz(d_i) Tx(a_i) Rx(alpha_i), with
# theta_i = THETA_0_i + OFFSET_i + SIGN_i * q_i. The first term is the upright arm, the second how
# far the URDF's zero is from it. Joint 1 turns about -z, hence its sign (joint 5 does as well, but
# its DH axis points back along the tool).
A = np.array([-0.033, 0.155, 0.135, 0.002, 0.0])  # m
ALPHA = np.array([np.pi / 2, 0.0, 0.0, np.pi / 2, np.pi])  # rad
D = np.array([0.145, 0.0, 0.0, 0.0, -0.185])  # m
THETA_0 = np.array([np.pi, np.pi / 2, 0.0, -np.pi / 2, np.pi])  # rad
OFFSET = np.deg2rad([170.0, -65.0, 146.0, -102.5, -167.5])  # rad
SIGN = np.array([-1.0, 1.0, 1.0, 1.0, 1.0])

#: Joint positions (rad) of the upright arm, the pose from which ``OFFSET`` counts.
UPRIGHT = -SIGN * OFFSET


class JointLimits(NamedTuple):
    """Limits of the five joints, each an array (5,)."""

    lower: np.ndarray  # rad
    upper: np.ndarray  # rad
    velocity: np.ndarray  # rad/s
    effort: np.ndarray  # N m

    def excess(self, q) -> np.ndarray:
        """How far each joint is outside: (..., 5) rad, negative below, positive above, 0 inside."""
        q = np.asarray(q, dtype=float)
        return np.minimum(q - self.lower, 0.0) + np.maximum(q - self.upper, 0.0)

    def contain(self, q, tolerance: float = 0.0) -> np.ndarray:
        """Whether all joints are inside, to ``tolerance`` rad: bool (...) for q of (..., 5)."""
        return (np.abs(self.excess(q)) <= tolerance).all(axis=-1)

    def shrunk(self, margin: float) -> JointLimits:
        """These limits with their range smaller by ``margin`` rad at both ends."""
        return self._replace(lower=self.lower + margin, upper=self.upper - margin)

    def describe_violation(self, q) -> str:
        """Names the joint of q (5,) that is farthest outside: joint, value, limit, in rad."""
        excess = self.excess(q)
        i = int(np.argmax(np.abs(excess)))
        bound = self.lower[i] if excess[i] < 0 else self.upper[i]
        side = "below its lower" if excess[i] < 0 else "above its upper"
        beyond = f"{abs(excess[i]):.2g} rad {side}"
        return f"{JOINT_NAMES[i]} at {q[i]:.4f} rad is {beyond} limit {bound:.4f} rad"


_VELOCITY = np.full(DOF, np.pi / 2)
_EFFORT = np.array([9.5, 9.5, 6.0, 2.0, 1.0])

# No public source gives acceleration limits: acceleration is a parameter of the planner.
LIMITS = {
    # The limits of the public robot description (and of the course).
    "urdf": JointLimits(
        lower=np.array([0.0, 0.0, -5.18362787842, 0.0, 0.0]),
        upper=np.array([5.89921287174, 2.70526034059, 0.0, 3.57792496659, 5.84685299418]),
        velocity=_VELOCITY,
        effort=_EFFORT,
    ),
    # What the real arm's driver accepts; it refuses anything beyond.
    "hardware": JointLimits(
        lower=np.array([0.01007, 0.01007, -5.02655, 0.02212, 0.11062]),
        upper=np.array([5.84014, 2.61799, -0.01571, 3.42920, 5.64159]),
        velocity=_VELOCITY,
        effort=_EFFORT,
    ),
}


def from_upright(readings) -> np.ndarray:
    """Joint positions (..., 5), rad, from readings that count from the upright arm.

    Some sources use those, with limits of +-169, -65 to 90, -151 to 146, +-102.5 and +-167.5
    degrees. The sense of each joint is the same. Sources disagree on joint 1's zero by a degree:
    this is the URDF's, 170 degrees from its limit, in place of 169.
    """
    return np.asarray(readings, dtype=float) + UPRIGHT


def to_upright(q) -> np.ndarray:
    """Readings (..., 5), rad, that count from the upright arm: the inverse of ``from_upright``."""
    return np.asarray(q, dtype=float) - UPRIGHT


def joint_limits(profile) -> JointLimits:
    """Limits of a profile, ``"urdf"`` or ``"hardware"``; a ``JointLimits`` passes through.

    Raises:
        InputError: there is no profile of that name, or a joint's own limits are out of order or a
            whole turn apart.
    """
    if isinstance(profile, JointLimits):
        lower, upper = np.array(profile.lower), np.array(profile.upper)
        if not lower.shape == upper.shape == (DOF,) or not (lower < upper).all():
            raise InputError(
                f"limits must be {DOF} lower ones, each below its upper one; got {profile}"
            )
        if (upper - lower >= 2 * np.pi).any():
            raise InputError(f"limits must be less than a whole turn apart; got {lower}, {upper}")
        return profile
    if profile not in LIMITS:
        raise InputError(f"no limit profile {profile!r}: choose one of {', '.join(LIMITS)}")
    return LIMITS[profile]
