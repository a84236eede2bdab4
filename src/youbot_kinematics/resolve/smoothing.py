"""Smooth curves inside a tube: quadratic programs with bounds and few bands, over waypoints."""

from __future__ import annotations

import numpy as np
from scipy.linalg import solveh_banded

# A shorter step counts as this long: a stair in one would otherwise outweigh the rest of the path.
_SHORTEST_STEP = 0.3
# The interior-point method: the gap at which it ends, relative to values near 1; the fraction of it
# that each step aims at; bounds so near count as equal; a safeguard against rounding.
_TINY, _CENTRING, _NARROW, _MAX_ITERATIONS = 1e-9, 0.1, 1e-9, 50


def roughness(at: np.ndarray, run: np.ndarray, slope_weight: float) -> np.ndarray:
    """The quadratic form of how rough values along runs are: of their second differences.

    Args:
        at: where the waypoints are along their line (n,).
        run: number of the run that each is in (n,).
        slope_weight: of the first differences beside the second.

    Returns:
        Its lower bands (3, n) as ``scipy.linalg.solveh_banded`` has them.
    """
    n = len(at)
    bands = np.zeros((3, n))
    step = np.where(run[1:] == run[:-1], np.maximum(np.diff(at), _SHORTEST_STEP), np.inf)
    _add_squares(bands, [-1 / step, 1 / step], slope_weight * np.where(np.isinf(step), 0.0, step))
    # The second derivative by finite differences of uneven steps, times the square root of a step.
    a, b = step[:-1], step[1:]
    inside = np.isfinite(a + b)
    a, b = np.where(inside, a, 1.0), np.where(inside, b, 1.0)
    weights = [2 / (a * (a + b)), -2 / (a * b), 2 / (b * (a + b))]
    _add_squares(bands, weights, inside * (a + b) / 2)
    return bands


def _add_squares(bands, weights, scale):
    """Adds sum_k scale_k (sum_i weights_i,k x_{k+i})^2 to the form; mutates ``bands``."""
    n = bands.shape[1] - len(weights) + 1
    for i, a in enumerate(weights):
        for j, b in enumerate(weights[: i + 1]):
            bands[i - j, j : j + n] += scale * a * b


def merged(bands: np.ndarray, gradient: np.ndarray, joined: np.ndarray):
    """The form and gradient of which values are one with the one before them.

    Args:
        bands: lower bands (3, n), without entries across a merge.
        gradient: (n,).
        joined: (n,) bool.
    """
    variable = np.cumsum(~joined) - 1
    out = np.zeros((3, variable[-1] + 1))
    for row, values in zip(out, bands):
        np.add.at(row, variable, values)
    return out, np.bincount(variable, gradient)


def solve_box(bands: np.ndarray, g: np.ndarray, lower: np.ndarray, upper: np.ndarray) -> np.ndarray:
    """Minimises ``x H x / 2 + g x`` inside bounds, by an interior-point method.

    Source: Nocedal and Wright, "Numerical Optimization" (2006), section 16.6.

    Args:
        bands: lower bands (w, n) of the positive definite H.
        g: (n,).
        lower, upper: bounds (n,); equal where x is given.
    """
    given = upper - lower < _NARROW
    middle, half = (lower + upper) / 2, np.where(given, 1.0, (upper - lower) / 2)
    x = np.where(given, middle, np.clip(0.0, middle - 0.9 * half, middle + 0.9 * half))
    below, above = x - middle + half, middle + half - x  # slacks, and their multipliers
    scale = np.abs(banded_product(bands, x) + g).max() + _TINY
    push_up, push_down = scale / below, scale / above
    stiff = _uncoupled(bands, given)
    for _ in range(_MAX_ITERATIONS):
        gap = (below @ push_up + above @ push_down) / (2 * len(x))
        slope = banded_product(bands, x) + g
        residual = np.where(given, 0.0, slope - push_up + push_down)
        if gap < _TINY and np.abs(residual).max() < _TINY:
            break
        mu = _CENTRING * gap
        # The step of the free values to where their slope is zero; the given ones stay.
        stiff[0] = np.where(given, 1.0, bands[0] + (push_up / below + push_down / above))
        target = np.where(given, 0.0, -(slope - mu / below + mu / above))
        dx = solveh_banded(stiff, target, lower=True)
        d_up = mu / below - push_up - push_up / below * dx
        d_down = mu / above - push_down + push_down / above * dx
        t = _longest((below, above, push_up, push_down), (dx, -dx, d_up, d_down))
        x, below, above = x + t * dx, below + t * dx, above - t * dx
        push_up, push_down = push_up + t * d_up, push_down + t * d_down
    return x


def _longest(values, steps) -> float:
    """The fraction (at most 1) of the steps that leaves all values positive."""
    return 0.99 / max(0.99, *(float((-d / v).max()) for v, d in zip(values, steps)))


def banded_product(bands: np.ndarray, x: np.ndarray) -> np.ndarray:
    """H x for a symmetric H given by its lower bands, for x of (n,) or (n, m)."""
    rows = bands if x.ndim == 1 else bands[..., None]
    y = rows[0] * x
    for k in range(1, len(bands)):
        y[k:] += rows[k, :-k] * x[:-k]
        y[:-k] += rows[k, :-k] * x[k:]
    return y


def _uncoupled(bands: np.ndarray, given: np.ndarray) -> np.ndarray:
    """The bands (w, n) without what ties given values (n,) bool to others, or one to another."""
    free = bands.copy()
    for k in range(1, len(bands)):
        free[k, :-k][given[:-k] | given[k:]] = 0.0
    return free
