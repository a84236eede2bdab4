"""Planar arms of two and of four links: closed-form inverse kinematics, and a free angle.

``inverse_2r`` is the law-of-cosines core of the youBot's own inverse kinematics. ``PlanarArm4R``
is the arm of the robotics course's first question: three coordinates of a task for four joints
leave one angle free, so a pose has infinitely many solutions.

Source: Siciliano et al., "Robotics: Modelling, Planning and Control" (2009), section 2.12.2.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from . import formulas
from .exceptions import InputError
from .intervals import bound_directions, feasible_intervals, turned_next_to
from .selection import cost, select_solution

# Samples of the free angle on an interval, before the best one is polished.
_SAMPLES = 91


class Bounds(NamedTuple):
    """The joint limits of a planar arm, each (n,) rad."""

    lower: np.ndarray
    upper: np.ndarray


def inverse_2r(x, y, l1: float, l2: float):
    """Joint angles of a planar two-link arm for points of its plane.

    The arm reaches ``x = l1 cos(a) + l2 cos(a + b)``, ``y = l1 sin(a) + l2 sin(a + b)``.

    Args:
        x, y: coordinates of the points (m), of one shape (...).
        l1, l2: lengths of the links (m), positive.

    Returns:
        ``(a, b, beyond)``: shoulder and elbow angles (rad), each (..., 2), first with the elbow
        angle b >= 0, then with b <= 0, and by how much each point is out of reach (m), (...):
        positive beyond the stretched arm, negative inside the folded one, 0 within reach and up to
        1e-10 m out of it. Out of reach, the angles are those of the nearest point that can be
        reached. At the edge of reach both elbows are the same, exactly straight or folded. On the
        shoulder itself (links of one length), any shoulder angle will do and one is given.
    """
    points = np.stack(np.broadcast_arrays(x, y), axis=-1)
    return formulas.two_links(points, l1, l2)


def wrap_between(q: np.ndarray, lower, upper) -> np.ndarray:
    """Angles (..., n) turned by whole turns to where they are next to their range, rad.

    A value outside of its limit by no more than ``formulas.LIMIT_ROUNDING`` is set on the limit.
    """
    return formulas.turned(q, lower, upper)


def distinct(solutions: np.ndarray) -> np.ndarray:
    """Solutions (k, n) without the second of two equal ones: elbows that merge, straight."""
    return np.array(
        [q for i, q in enumerate(solutions) if not (q == solutions[:i]).all(axis=1).any()]
    ).reshape(-1, solutions.shape[1])


class PlanarArm:
    """Links in a row in the x-y plane; each joint's angle counts from the link before.

    Args:
        lengths: lengths of the n links, m, positive.
        lower, upper: joint limits (n,), rad; default -pi and pi.

    Raises:
        InputError: a length that is not positive, or limits of another number or order.
    """

    def __init__(self, lengths, lower=None, upper=None):
        self.lengths = np.array(lengths, dtype=float)
        whole = np.full(len(self.lengths), np.pi)
        lower = -whole if lower is None else np.array(lower, dtype=float)
        upper = whole if upper is None else np.array(upper, dtype=float)
        self.limits = Bounds(lower, upper)
        if not (np.isfinite(self.lengths).all() and (self.lengths > 0).all()):
            raise InputError(f"links must have positive lengths, in m; got {lengths}")
        if not (lower.shape == upper.shape == whole.shape and (lower < upper).all()):
            raise InputError(
                f"joint limits must be {len(whole)} lower ones, each below its upper one;"
                f" got {lower} and {upper}"
            )

    def _points(self, q):
        """Joints and tip as complex numbers (..., n + 1), m, and directions (..., n) of links."""
        q = np.asarray(q, dtype=float)
        n = len(self.lengths)
        if q.shape[-1:] != (n,) or not np.isfinite(q).all():
            raise InputError(f"joint positions must be finite, of shape (..., {n}); got {q.shape}")
        directions = np.cumsum(q, axis=-1)
        points = np.cumsum(self.lengths * np.exp(1j * directions), axis=-1)
        return np.concatenate([np.zeros_like(points[..., :1]), points], axis=-1), directions

    def forward(self, q):
        """Position of the tip and direction of the last link for joints q, (n,) or (..., n) rad.

        Returns:
            ``(x, y, phi)``, m and rad, each (...). phi is the sum of the joints, not wrapped.

        Raises:
            InputError: q has another shape, or is not finite.
        """
        points, directions = self._points(q)
        return points[..., -1].real, points[..., -1].imag, directions[..., -1]

    def jacobian(self, q) -> np.ndarray:
        """Derivatives of ``forward``: (..., 3, n), rows x and y in m/rad, phi in rad/rad."""
        points, _ = self._points(q)
        turned = 1j * (points[..., -1:] - points[..., :-1])
        return np.stack([turned.real, turned.imag, np.ones_like(turned.real)], axis=-2)

    def smallest_singular_value(self, q) -> np.ndarray:
        """Smallest singular value (...) of the Jacobian's rows of the task, for q of (..., n)."""
        return np.linalg.svd(self.jacobian(q), compute_uv=False)[..., -1]

    def configuration(self, q) -> dict:
        """Names of configurations, and whether the joints (..., n) are in them, bool (...).

        ``elbow_up`` has the elbow on the left of the line from the shoulder to the wrist.
        """
        elbow = np.asarray(q, dtype=float)[..., 1]
        return {"elbow_up": elbow <= 0, "elbow_down": elbow >= 0}


class PlanarArm2R(PlanarArm):
    """A planar arm of two links: each point in its reach has two solutions.

    Args:
        l1, l2: lengths of the links, m.
        lower, upper: joint limits (2,), rad; default -pi and pi.
    """

    def __init__(self, l1, l2, lower=None, upper=None):
        super().__init__([l1, l2], lower, upper)

    def inverse(self, x: float, y: float) -> np.ndarray:
        """Every solution (k, 2), 0 <= k <= 2, inside the limits for the tip at a point (m)."""
        a, b, beyond = inverse_2r(x, y, *self.lengths)
        q = wrap_between(np.stack([a, b], axis=-1), *self.limits)
        inside = ((q >= self.limits.lower) & (q <= self.limits.upper)).all(axis=-1)
        return distinct(q[inside & (beyond == 0)])

    def smallest_singular_value(self, q) -> np.ndarray:
        """Smallest singular value (...) of the Jacobian of the position, for q of (..., 2)."""
        return np.linalg.svd(self.jacobian(q)[..., :2, :], compute_uv=False)[..., -1]


class PlanarArm4R(PlanarArm):
    """A planar arm of four links: position and direction of the last link leave one angle free.

    Args:
        l1, l2, l3, l4: lengths of the links, m.
        lower, upper: joint limits (4,), rad; default -pi and pi.
    """

    def __init__(self, l1, l2, l3, l4, lower=None, upper=None):
        super().__init__([l1, l2, l3, l4], lower, upper)

    def inverse(self, x: float, y: float, phi: float, theta4: float) -> np.ndarray:
        """Every solution inside the limits for a pose and one value of the free angle.

        Args:
            x, y: position of the tip, m.
            phi: direction of the last link, rad.
            theta4: the last joint, rad.

        Returns:
            (k, 4) rad, 0 <= k <= 2: the elbow turned to the left, then to the right.

        Raises:
            InputError: a number that is not finite.
        """
        q, valid = self._solve(x, y, phi, np.asarray(theta4, dtype=float))
        return distinct(q[valid])

    def theta4_intervals(self, x: float, y: float, phi: float) -> list:
        """Every value of the last joint for which a pose has solutions inside the limits.

        Returns:
            Two lists, for the elbow turned to the left and to the right, of intervals (low, high)
            in rad, ends included and exact to rounding. Where joint 4's range is a whole turn, an
            interval may go on beyond it.
        """
        wrist = self._wrist(x, y, phi)
        directions = phi - np.array(self.limits)[:, 3]  # of link 3, with joint 4 on a limit
        bounds = [limit[:3] for limit in self.limits]
        directions = np.append(
            directions, bound_directions(wrist, self.lengths[2], *self.lengths[:2], *bounds)
        )
        by_elbow = feasible_intervals(
            phi - directions, lambda theta4: self._solve(x, y, phi, theta4)[1]
        )
        middle = (self.limits.lower[3] + self.limits.upper[3]) / 2
        return [turned_next_to(middle, intervals) for intervals in by_elbow]

    def best_solution(self, x, y, phi, criterion="limits", seed=None, previous=None) -> np.ndarray:
        """The best of the infinitely many solutions (4,) for a pose: the redundancy resolved.

        Criteria are those of ``selection.select_solution``. Each interval of the free angle is
        sampled, and the best sample polished by a bounded line search.

        Raises:
            InputError: the pose has no solution inside the limits, or no such criterion.
        """

        def price(theta4, elbow):
            q, valid = self._solve(x, y, phi, np.atleast_1d(theta4))
            costs = cost(q[:, elbow], criterion, self, seed, previous)
            return np.where(valid[:, elbow], costs, np.inf)

        best = [
            self._solve(x, y, phi, np.array(_least(price, elbow, *interval)))[0][elbow]
            for elbow, intervals in enumerate(self.theta4_intervals(x, y, phi))
            for interval in intervals
        ]
        if not best:
            raise InputError(f"no joints inside the limits reach ({x}, {y}) m at {phi} rad")
        return select_solution(best, criterion, self, seed, previous)

    def _wrist(self, x, y, phi) -> complex:
        """Where joint 4 is, m."""
        if not np.isfinite([x, y, phi]).all():
            raise InputError(f"a pose must be finite; got x = {x}, y = {y}, phi = {phi}")
        return complex(x, y) - self.lengths[3] * np.exp(1j * phi)

    def _solve(self, x, y, phi, theta4):
        """Both elbows for theta4 (...): joints (..., 2, 4) rad, and whether they are solutions."""
        direction = phi - theta4  # of link 3
        joint_3 = self._wrist(x, y, phi) - self.lengths[2] * np.exp(1j * direction)
        a, b, beyond = inverse_2r(joint_3.real, joint_3.imag, *self.lengths[:2])
        c = direction[..., None] - a - b
        q = np.stack([a, b, c, np.broadcast_to(theta4[..., None], a.shape)], axis=-1)
        q = wrap_between(q, *self.limits)
        inside = ((q >= self.limits.lower) & (q <= self.limits.upper)).all(axis=-1)
        return q, inside & (beyond == 0)[..., None]


def _least(price, elbow: int, low: float, high: float) -> float:
    """The angle between low and high of least price: the best sample, polished."""
    from scipy.optimize import minimize_scalar  # slow to import, and only this needs it

    samples = np.linspace(low, high, _SAMPLES)
    prices = price(samples, elbow)
    i = int(np.argmin(prices))
    ends = samples[max(i - 1, 0)], samples[min(i + 1, _SAMPLES - 1)]
    polished = minimize_scalar(
        lambda theta4: price(theta4, elbow)[0],
        bounds=ends,
        method="bounded",
        options={"xatol": 1e-10},
    )
    return polished.x if polished.fun < prices[i] else samples[i]
