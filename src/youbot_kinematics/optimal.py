"""Time-optimal timing of a joint path, sampled so that the controller keeps the limits.

toppra (Pham and Pham, "A new approach to time-optimal path parameterization based on reachability
analysis", IEEE Transactions on Robotics 34 (2018)) finds the highest rate ds/dt at which the path
can be run under velocity and acceleration limits, from rest to rest. That rate has corners, where
the acceleration jumps, and a jump between two samples makes the controller's quintic overshoot. So
the rate is only taken at the samples, and the acceleration of s runs linearly from one to the next:
the quintic follows such a motion to the letter.
"""

from __future__ import annotations

import numpy as np
import toppra
from toppra.algorithm import TOPPRA
from toppra.constraint import (
    DiscretizationType,
    JointAccelerationConstraint,
    JointVelocityConstraint,
)

from .exceptions import PlanningError
from .trajectory import JointPath, Trajectory, interpolate

#: How finely the controller's interpolation is looked at, s.
DENSE = 0.001
_HEADROOM = 1e-9
_MIN_GRID, _MAX_GRID = 100, 1000


def optimal_rate(path: JointPath, velocity, acceleration):
    """The highest rate of a path, from rest to rest.

    Args:
        velocity, acceleration: limits (5,), rad/s and rad/s^2.

    Returns:
        ``(times, rates)``, each (n,): ds/dt in 1/s is linear between the times (s).

    Raises:
        PlanningError: toppra finds no parametrization.
    """
    # toppra counts well where the path is about as long as the joints move.
    length = np.abs(np.diff(path.joints, axis=0)).max(axis=1).sum()
    geometry = toppra.SplineInterpolator(path.s * length, path.joints)
    grid = _grid(path.s * length)
    constraints = [
        JointVelocityConstraint(np.column_stack([-velocity, velocity])),
        JointAccelerationConstraint(
            np.column_stack([-acceleration, acceleration]),
            discretization_scheme=DiscretizationType.Interpolation,
        ),
    ]
    solver = TOPPRA(constraints, geometry, gridpoints=grid, solver_wrapper="seidel")
    rates = solver.compute_parameterization(0.0, 0.0)[1]
    if rates is None or not np.isfinite(rates).all():
        raise PlanningError(f"no time-optimal timing of the {path.kind} was found")
    times = np.append(0.0, np.cumsum(2 * np.diff(grid) / (rates[1:] + rates[:-1])))
    return times, rates / length


def _grid(s: np.ndarray) -> np.ndarray:
    n = int(np.clip(len(s), _MIN_GRID, _MAX_GRID))
    return np.interp(np.linspace(0, len(s) - 1, n), np.arange(len(s)), s)


def sample_path(spline, rates, dt: float) -> np.ndarray:
    """Samples (3, n + 1, 5) of positions, velocities and accelerations along a path, every dt.

    Args:
        spline: joints (rad) as a function of s in 0..1.
        rates: ds/dt wanted at each dt, (n + 1,), from and to rest; the samples have the mean of two
            neighbours, so that ds/dt changes in straight lines between them.
    """
    before = np.append(0.0, rates[:-1])
    ds, dds = (rates + before) / 2, (rates - before) / dt
    steps = dt * ds[:-1] + dt**2 * (2 * dds[:-1] + dds[1:]) / 6
    s = np.append(0.0, np.cumsum(steps))
    ds, dds, s = (x / s[-1] for x in (ds, dds, s))
    ds, dds = ds[:, None], dds[:, None]
    slope = spline(s, 1)
    return np.stack([spline(s), slope * ds, spline(s, 2) * ds**2 + slope * dds])


def time_path(path: JointPath, velocity, acceleration, dt: float) -> np.ndarray:
    """Samples (3, n, 5) of the quickest motion along a path, from rest to rest, every dt."""
    if np.ptp(path.joints, axis=0).max() == 0:
        return np.stack([path.joints[:1], np.zeros((1, 5)), np.zeros((1, 5))])
    spline = path.spline()
    times, rates = optimal_rate(path, velocity, acceleration)
    shortest = times[-1]
    steps = int(np.ceil(shortest / dt - 1e-9)) + 1
    while True:
        stretch = (steps - 1) * dt / shortest
        r = np.interp(np.arange(steps + 1) * dt, times * stretch, rates / stretch, right=0.0)
        samples = sample_path(spline, r, dt)
        load = peak_load(samples, velocity, acceleration, dt)
        if load <= 1.0:
            samples[0, [0, -1]] = path.joints[[0, -1]]
            samples[1:, [0, -1]] = 0.0
            return samples
        steps = max(steps + 1, int(np.ceil((steps - 1) * load)) + 1)


def peak_load(samples, velocity, acceleration, dt: float) -> float:
    """By what factor the time must be stretched for the controller's motion to keep the limits."""
    times = np.arange(samples.shape[1]) * dt
    dense = np.arange(0.0, times[-1] + DENSE / 2, DENSE)
    _, v, a = interpolate(Trajectory(times, *samples), dense)
    return float(max((np.abs(v) / velocity).max(), np.sqrt((np.abs(a) / acceleration).max())))
