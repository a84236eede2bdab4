"""The quickest way along a joint path, by toppra.

Pham and Pham, "A new approach to time-optimal path parameterization based on reachability
analysis", IEEE Transactions on Robotics 34 (2018).
"""

from __future__ import annotations

import sys
from contextlib import contextmanager
from functools import lru_cache
from types import ModuleType

import numpy as np

from .exceptions import PlanningError
from .trajectory import JointPath


@contextmanager
def _empty_modules(*names):
    """Empty modules in the place of those that are not loaded, for as long as this lasts."""
    added = [name for name in names if name not in sys.modules]
    sys.modules.update({name: ModuleType(name) for name in added})
    try:
        yield
    finally:
        for name in added:
            del sys.modules[name]


# For pictures of its own, toppra imports what takes longer to load than all that is used here.
with _empty_modules("matplotlib", "matplotlib.pyplot"):
    import toppra
    from toppra.algorithm import TOPPRA
    from toppra.constraint import (
        DiscretizationType,
        JointAccelerationConstraint,
        JointVelocityConstraint,
    )

# Points at which toppra looks at a path.
_MIN_GRID, _MAX_GRID = 100, 1000


def optimal_rate(path: JointPath, velocity, acceleration):
    """The highest rate of a path, from rest to rest.

    Args:
        path: from rest to rest.
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
    constraints = _constraints(tuple(velocity), tuple(acceleration))
    solver = TOPPRA(constraints, geometry, gridpoints=grid, solver_wrapper="seidel")
    rates = solver.compute_parameterization(0.0, 0.0)[1]
    if rates is None or not np.isfinite(rates).all():
        raise PlanningError(f"no time-optimal timing of the {path.kind} was found")
    times = np.append(0.0, np.cumsum(2 * np.diff(grid) / (rates[1:] + rates[:-1])))
    return times, rates / length


@lru_cache(maxsize=1)  # a plan has many paths, and toppra describes its constraints at length
def _constraints(velocity: tuple, acceleration: tuple) -> list:
    """toppra's constraints for limits of each joint, rad/s and rad/s^2."""
    v, a = np.array(velocity), np.array(acceleration)
    return [
        JointVelocityConstraint(np.column_stack([-v, v])),
        JointAccelerationConstraint(
            np.column_stack([-a, a]),
            discretization_scheme=DiscretizationType.Interpolation,
        ),
    ]


def _grid(s: np.ndarray) -> np.ndarray:
    """As many points as the path has, spread as its own are, within reason."""
    n = int(np.clip(len(s), _MIN_GRID, _MAX_GRID))
    return np.interp(np.linspace(0, len(s) - 1, n), np.arange(len(s)), s)
