"""How the controller fills in between points: against SciPy's Hermite interpolation."""

import numpy as np
from scipy.interpolate import BPoly

from youbot_kinematics.trajectory import Trajectory, interpolate


def random_trajectory(n=6, seed=0):
    rng = np.random.default_rng(seed)
    times = np.cumsum(rng.uniform(0.01, 0.5, n)) - 0.01
    return Trajectory(times - times[0], *rng.normal(size=(3, n, 5)))


def test_it_is_the_quintic_that_meets_both_ends():
    trajectory = random_trajectory()
    times = np.linspace(0, trajectory.duration, 1001)
    quintic = BPoly.from_derivatives(
        trajectory.times, np.stack(trajectory[1:4], axis=1)
    )  # an independent implementation of the same polynomial
    for order, values in enumerate(interpolate(trajectory, times)):
        np.testing.assert_allclose(values, quintic(times, nu=order), rtol=1e-7, atol=1e-7)


def test_it_passes_through_the_points():
    trajectory = random_trajectory()
    for values, points in zip(interpolate(trajectory, trajectory.times), trajectory[1:4]):
        np.testing.assert_allclose(values, points, rtol=1e-9, atol=1e-9)


def test_it_stands_before_the_first_and_after_the_last_point():
    trajectory = random_trajectory()
    positions, _, _ = interpolate(trajectory, [-1.0, trajectory.duration + 1.0])
    np.testing.assert_allclose(positions, trajectory.positions[[0, -1]], atol=1e-12)


def test_a_single_point_is_a_place_to_stand():
    trajectory = Trajectory(np.zeros(1), np.ones((1, 5)), np.zeros((1, 5)), np.zeros((1, 5)))
    positions, velocities, _ = interpolate(trajectory, [0.0, 1.0])
    assert (positions == 1.0).all() and not velocities.any()
