"""Choosing among the joint positions that all solve the same task.

Each criterion is a cost; the least wins. The criteria are those of the robotics course:

=============  ===================================================================================
movement       the sum over the joints of how far each moves from the seed, rad
limits         1 - the smallest distance of a joint to a limit, as a part of half its range: 0 in
               the middle of all ranges, 1 on a limit
singularity    minus the smallest singular value of the Jacobian
smoothness     the sum over the joints of the change of the previous step, rad: a motion that goes
               on as it came, from ``previous`` to the seed, costs nothing
a name         0 in the arm's configuration of that name, such as ``elbow_up``, 1 out of it
=============  ===================================================================================
"""

from __future__ import annotations

import numpy as np

from .exceptions import InputError

CRITERIA = ("movement", "limits", "singularity", "smoothness")

# Costs that differ by less are equal: they differ by rounding.
_TIE = 1e-9


def select_solution(solutions, criterion, arm, seed=None, previous=None) -> np.ndarray:
    """The best of some solutions.

    Ties are broken by least movement from the seed, where there is one, and then by the smallest
    first joint, second joint, and so on: the order of the solutions plays no part.

    Args:
        solutions: joint positions (k, n), rad, k >= 1.
        criterion: the name of a criterion, or weights by name, ``{"limits": 1, "movement": 0.1}``.
        arm: what has the joints: ``limits.lower`` and ``.upper`` (n,) rad,
            ``smallest_singular_value(q)``, and ``configuration(q)``, which says by name which
            configurations the joints (k, n) are in, as bool (k,).
        seed: joint positions (n,) from which the arm comes, rad.
        previous: joint positions (n,) before the seed, rad.

    Returns:
        One of the solutions, (n,).

    Raises:
        InputError: there are no solutions, no such criterion, or what it needs is not given.
    """
    solutions = np.asarray(solutions, dtype=float)
    n = len(arm.limits.lower)
    if solutions.ndim != 2 or solutions.shape[1] != n or not np.isfinite(solutions).all():
        raise InputError(f"solutions must be finite, of shape (k, {n}); got {solutions.shape}")
    if len(solutions) == 0:
        raise InputError("there are no solutions to choose from")
    costs = cost(solutions, criterion, arm, seed, previous)
    tied = solutions[costs <= costs.min() + _TIE]
    if seed is not None:
        movement = cost(tied, "movement", arm, seed)
        tied = tied[movement <= movement.min() + _TIE]
    return min(tied, key=lambda q: q.round(9).tolist())


def cost(solutions: np.ndarray, criterion, arm, seed=None, previous=None) -> np.ndarray:
    """Cost (k,) of each solution (k, n); the arguments are those of ``select_solution``."""
    weights = {criterion: 1.0} if isinstance(criterion, str) else dict(criterion)
    total = np.zeros(len(solutions))
    for name, weight in weights.items():
        total += weight * _single_cost(solutions, name, arm, seed, previous)
    return total


def _single_cost(solutions, name, arm, seed, previous):
    if name == "movement":
        return np.abs(solutions - _given(seed, "seed", name)).sum(axis=-1)
    if name == "limits":
        lower, upper = arm.limits.lower, arm.limits.upper
        margin = np.minimum(solutions - lower, upper - solutions) / ((upper - lower) / 2)
        return 1.0 - margin.min(axis=-1)
    if name == "singularity":
        return -arm.smallest_singular_value(solutions)
    if name == "smoothness":
        now, before = _given(seed, "seed", name), _given(previous, "previous", name)
        return np.abs((solutions - now) - (now - before)).sum(axis=-1)
    configuration = arm.configuration(solutions)
    if name not in configuration:
        known = ", ".join((*CRITERIA, *configuration))
        raise InputError(f"no criterion {name!r}: choose one of {known}, or weights of some")
    return np.where(configuration[name], 0.0, 1.0)


def _given(joints, argument: str, criterion: str) -> np.ndarray:
    """Joint positions that a criterion cannot do without."""
    if joints is None:
        raise InputError(f"the criterion {criterion!r} needs {argument}=, joint positions in rad")
    return np.asarray(joints, dtype=float)
