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

from . import arm
from .exceptions import InputError
from .planar import inverse_2r, wrap_between

N_BRANCHES = 4
BRANCH_NAMES = ("front, elbow +", "front, elbow -", "back, elbow +", "back, elbow -")

#: How far a pose may be tilted out of the arm's plane and still count as asked for exactly, rad.
POSE_TOLERANCE = 1e-9
#: A position counts as in a plane, or on joint 1's axis, that it is this near to (m).
ON_PLANE = 1e-9
# A tool whose z axis has a smaller horizontal part is vertical.
_VERTICAL = 1e-9

# The same numbers as in the table above, from their one definition.
SHOULDER_R, SHOULDER_Z = -arm.A[0], arm.D[0]
UPPER_ARM, FOREARM = arm.A[1], arm.A[2]
TOOL_OFFSET, TOOL_LENGTH = arm.A[3], -arm.D[4]
AZIMUTH_0, ROLL_0 = arm.OFFSET[0], -arm.OFFSET[4]


class PlanePose(NamedTuple):
    """A pose as seen from the arm's plane, reaching forward (index 0) and over the back (1)."""

    azimuth: np.ndarray  # phi, (..., 2) rad
    radius: np.ndarray  # r, signed, (..., 2) m
    height: np.ndarray  # z, (...) m
    pitch: np.ndarray  # beta of the nearest rotation that the arm can give the tool, (..., 2) rad
    roll: np.ndarray  # gamma of it, (..., 2) rad
    tilt: np.ndarray  # angle between that rotation and the one asked for, (..., 2) rad


class Branches(NamedTuple):
    """The whole answer of the inverse kinematics: a row for each of the four branches.

    A branch is valid if it has no reason against it: all of ``out_of_reach``, ``limit_excess`` and
    ``tilt`` are zero to rounding. Where one of them is not, the others are those of the nearest
    configuration: stretched or folded towards the wrist, turned back into the plane.
    """

    joints: np.ndarray  # (..., 4, 5) rad; solutions only where ``valid``, else what comes nearest
    valid: np.ndarray  # (..., 4) bool
    out_of_reach: (
        np.ndarray
    )  # (..., 4) m: wrist beyond the stretched arm (+), inside the folded (-)
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
    T = as_transforms(T)
    pose = seeded_plane_pose(T, limits, seed)
    arm_joints, beyond = plane_joints(pose.radius, pose.height[..., None], pose.pitch)

    joints = np.empty((*T.shape[:-2], 2, 2, arm.DOF))  # front/back, elbow +/-
    joints[..., 0] = (AZIMUTH_0 - pose.azimuth)[..., None]
    joints[..., 1:4] = arm_joints
    joints[..., 4] = (ROLL_0 - pose.roll)[..., None]
    joints = wrap_into_limits(joints.reshape(*T.shape[:-2], N_BRANCHES, arm.DOF), limits)

    beyond, tilt = np.repeat(beyond, 2, axis=-1), np.repeat(pose.tilt, 2, axis=-1)
    excess = limits.excess(joints)
    valid = (beyond == 0) & (tilt <= POSE_TOLERANCE) & (excess == 0).all(axis=-1)
    return Branches(joints, valid, beyond, excess, tilt)


def seeded_plane_pose(T: np.ndarray, limits: arm.JointLimits, seed=None) -> PlanePose:
    """``plane_pose`` with the azimuth from the seed where it is free; see ``inverse_branches``."""
    q1 = (limits.lower[0] + limits.upper[0]) / 2 if seed is None else seed[0]
    free = _azimuth_is_free(T).any()
    return plane_pose(T, free_azimuth=_free_azimuth(T, limits, q1) if free else 0.0)


def plane_pose(T: np.ndarray, free_azimuth) -> PlanePose:
    """Finds the arm's plane for each pose, and the tool's pitch and roll in it.

    The nearest rotation ``Ry(beta) Rz(gamma)`` turns the tool's z axis into the plane on the
    shortest way; the angle of that turn is the tilt. (It is the rotation that the singular value
    decomposition of the quaternion's 2x2 matrix [[w, z], [y, x]] gives, in closed form.)

    Args:
        T: poses (..., 4, 4) in ``base_link``, m.
        free_azimuth: azimuths, a number or (...) rad, for poses that leave it free: tool vertical
            on joint 1's axis.
    """
    x, y, R = T[..., 0, 3], T[..., 1, 3], T[..., :3, :3]
    front = np.where(_azimuth_is_free(T), free_azimuth, _front_azimuth(x, y, R[..., :, 2]))
    azimuth = np.stack([front, front + np.pi], axis=-1)
    cos, sin = np.cos(azimuth), np.sin(azimuth)
    radius = x[..., None] * cos + y[..., None] * sin

    # B = Rz(-azimuth) R, row by row: along the plane, across it, up.
    R = R[..., None, :, :]
    along = cos[..., None] * R[..., 0, :] + sin[..., None] * R[..., 1, :]
    across = cos[..., None] * R[..., 1, :] - sin[..., None] * R[..., 0, :]
    up = R[..., 2, :]
    pitch = np.arctan2(along[..., 2], up[..., 2])
    # A = Ry(-pitch) B turns about z by the roll, as nearly as it can: maximise trace(Rz(-roll) A).
    c, s = np.cos(pitch)[..., None], np.sin(pitch)[..., None]
    a0, a1 = c * along - s * up, across
    roll = np.arctan2(a1[..., 0] - a0[..., 1], a0[..., 0] + a1[..., 1])
    tilt = np.arcsin(np.minimum(np.abs(across[..., 2]), 1.0))
    return PlanePose(azimuth, radius, T[..., 2, 3], pitch, roll, tilt)


def _azimuth_is_free(T):
    """Whether poses (..., 4, 4) have the tool on joint 1's axis, and vertical: bool (...)."""
    radius, horizontal = (np.hypot(T[..., 0, i], T[..., 1, i]) for i in (3, 2))
    return (radius < ON_PLANE) & (horizontal <= _VERTICAL)


def _free_azimuth(T, limits, q1):
    """Azimuths (...) nearest to joint 1 at q1 that keep joints 1 and 5 inside, tool vertical.

    Only the sum of the two angles is given if the tool points up, their difference if it points
    down: ``q5 = k - up * q1``. So either joint 1 can stay at q1, or one of the two is on a limit.
    """
    up = np.where(T[..., 2, 2] > 0, 1.0, -1.0)
    turn = up * np.arctan2(up * T[..., 1, 0], up * T[..., 0, 0])
    k = ROLL_0 + up * AZIMUTH_0 - turn
    lower, upper = limits.lower[[0, 4]], limits.upper[[0, 4]]
    choices = [
        np.full(up.shape, value) for value in (np.clip(q1, lower[0], upper[0]), lower[0], upper[0])
    ]
    choices += [up * (k - lower[1]), up * (k - upper[1])]
    first = np.stack(choices, axis=-1)
    pair = np.stack([first, k[..., None] - up[..., None] * first], axis=-1)
    pair = wrap_between(pair, lower, upper)
    inside = ((pair >= lower) & (pair <= upper)).all(axis=-1)
    best = np.argmin(np.where(inside, np.abs(pair[..., 0] - q1), np.inf), axis=-1)
    return AZIMUTH_0 - np.take_along_axis(pair[..., 0], best[..., None], axis=-1)[..., 0]


def _front_azimuth(x, y, tool_z):
    """Azimuth (...) of the plane of an arm that reaches forward to (x, y), m."""
    by_position, by_tool = np.arctan2(y, x), np.arctan2(tool_z[..., 1], tool_z[..., 0])
    radius, horizontal = np.hypot(x, y), np.hypot(tool_z[..., 0], tool_z[..., 1])
    off_plane = np.abs(y * np.cos(by_tool) - x * np.sin(by_tool))
    # The tool may lean back over the axis: to the front is where the position is.
    leans_back = x * np.cos(by_tool) + y * np.sin(by_tool) < -ON_PLANE
    by_tool = np.where(leans_back, by_tool + np.pi, by_tool)
    # The nearer to joint 1's axis, the more rounding blurs the azimuth of the position; the more
    # upright the tool, that of its z axis. The longer arrow tells the plane better.
    return np.where((horizontal > radius) & (off_plane < ON_PLANE), by_tool, by_position)


def plane_joints(radius, height, pitch):
    """Joints 2, 3 and 4 that bring the tool to a point of the arm's plane at a pitch.

    Args:
        radius, height, pitch: r and z (m) and beta (rad) as above, broadcast to one shape (...).

    Returns:
        ``(joints, beyond)``: (..., 2, 3) rad, not wrapped, elbow + and -; and by how much the wrist
        is out of reach, (...) m, as ``planar.inverse_2r`` has it.
    """
    sin, cos = np.sin(pitch), np.cos(pitch)
    wrist_r = radius - SHOULDER_R + TOOL_OFFSET * cos - TOOL_LENGTH * sin
    wrist_z = height - SHOULDER_Z - TOOL_OFFSET * sin - TOOL_LENGTH * cos
    # Angles count from the vertical, towards r: z is the planar arm's x axis, r its y axis.
    t2, elbow, beyond = inverse_2r(wrist_z, wrist_r, UPPER_ARM, FOREARM)
    t23 = t2 + elbow
    t4 = np.broadcast_to(pitch, beyond.shape)[..., None] - t23
    return np.stack([t2, elbow, t4], axis=-1) - arm.OFFSET[1:4], beyond


def wrap_into_limits(q: np.ndarray, limits: arm.JointLimits) -> np.ndarray:
    """Joint positions (..., 5) turned by whole turns to where they are next to their range (rad).

    A value outside of its limit by no more than rounding is set on the limit.
    """
    return wrap_between(q, limits.lower, limits.upper)


def as_transforms(T, tolerance: float = 1e-6) -> np.ndarray:
    """``T`` as a float array (..., 4, 4) of rigid transforms.

    Raises:
        InputError: wrong shape, a value that is not finite, or not a rotation to the tolerance.
    """
    try:
        T = np.asarray(T, dtype=float)
    except (TypeError, ValueError):
        raise InputError(f"a pose must be an array (4, 4) of numbers, not {T!r}") from None
    if T.shape[-2:] != (4, 4):
        raise InputError(f"a pose must have shape (4, 4) or (..., 4, 4); got {T.shape}")
    if not np.isfinite(T).all():
        raise InputError("a pose must be finite; it has NaN or infinity in it")
    R = T[..., :3, :3]
    error = np.abs(np.swapaxes(R, -1, -2) @ R - np.eye(3)).max(initial=0.0)
    if error > tolerance or (np.linalg.det(R) < 0).any():
        raise InputError(
            f"a pose must hold a rotation matrix; R^T R is off the identity by {error:.2g}"
            " or the frame is left-handed: normalise it, or ask for nearest_reachable_pose"
        )
    if np.abs(T[..., 3, :] - [0, 0, 0, 1]).max(initial=0.0) > 1e-9:
        raise InputError("the last row of a pose must be 0 0 0 1")
    return T
