"""The check finds what is wrong with a trajectory, and nothing else."""

import json

import numpy as np
import pytest

from youbot_kinematics import YoubotKinematics
from youbot_kinematics.check import check, distance_to_line
from youbot_kinematics.differential import line_path
from youbot_kinematics.timing import time_paths

ARM = YoubotKinematics()
START = np.array([2.9, 1.2, -2.0, 2.2, 2.9])
GOAL = START + [0.3, 0.2, -0.2, 0.1, 0.2]
CHECKPOINTS = ARM.forward_kinematics([START, GOAL])


@pytest.fixture(scope="module")
def good():
    path = line_path(ARM, *CHECKPOINTS, START, ARM.limits, checkpoint=0, num_points=10)
    return time_paths([path], ARM.limits.velocity, np.full(5, 3.0), 0.02)


def failures(trajectory, acceleration=3.0):
    return " ".join(check(trajectory, ARM.limits, acceleration, CHECKPOINTS).failures)


def changed(trajectory, name, change, points=slice(5, 8)):
    values = getattr(trajectory, name).copy()
    values[points] = change(values[points])
    return trajectory._replace(**{name: values})


def test_a_good_trajectory_passes_with_figures_that_make_sense(good):
    report = check(good, ARM.limits, 3.0, CHECKPOINTS)
    assert report.passed, report.failures
    assert report.duration == pytest.approx(good.duration)
    assert 0.9 < report.acceleration_fraction <= 1.0
    assert report.line_distance < 1e-4
    assert report.checkpoint_distances[0] < 1e-6
    json.dumps(report.as_dict(), allow_nan=False)


def test_a_bulge_off_the_line_is_found(good):
    assert "leaves its line" in failures(changed(good, "positions", lambda q: q + 1e-2))


def test_a_joint_outside_of_its_limit_is_named(good):
    assert "arm_joint_2 at" in failures(changed(good, "positions", lambda q: q + [0, 3, 0, 0, 0]))


def test_a_velocity_above_its_limit_is_found(good):
    assert "velocity is" in failures(changed(good, "positions", lambda q: q + 0.05))


def test_an_acceleration_above_its_limit_is_found(good):
    assert "acceleration is" in failures(good, acceleration=1.0)


def test_an_overshoot_between_the_points_is_found(good):
    """The points keep the limits; only the controller's interpolation of them does not."""
    wild = changed(good, "accelerations", lambda a: 2.9 * (-1.0) ** np.arange(3)[:, None] + 0 * a)
    assert "acceleration is" in failures(wild)


def test_a_missed_checkpoint_is_found(good):
    short = good._replace(positions=good.positions - 1e-4 * (good.times / good.duration)[:, None])
    assert "checkpoint 1 is missed by" in failures(short)


def test_a_last_point_that_still_moves_is_found(good):
    assert "last point is not zero" in failures(
        changed(good, "velocities", lambda v: v + 0.1, slice(-1, None))
    )


def test_the_distance_to_a_line_is_that_to_its_nearest_point():
    a, b = np.zeros(3), np.array([1.0, 0, 0])
    points = np.array([[0.5, 0.2, 0], [-0.3, 0, 0], [1.0, 0, 0.4]])
    np.testing.assert_allclose(distance_to_line(points, a, b), [0.2, 0.3, 0.4])
