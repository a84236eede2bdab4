"""Time-optimal timing: the limits are kept as the controller runs it, and used."""

import numpy as np
import pytest

from youbot_kinematics import YoubotKinematics, arm
from youbot_kinematics.optimal import optimal_rate
from youbot_kinematics.resolve import resolve
from youbot_kinematics.timing import DENSE, peak_load, sample_path, time_path
from youbot_kinematics.trajectory import JointPath, Trajectory, interpolate

VELOCITY, ACCELERATION, DT = np.full(5, np.pi / 2), np.full(5, 3.0), 0.02


def straight(*distances):
    return JointPath("approach", 0, 0, np.array([0.0, 1.0]), np.array([np.zeros(5), distances]))


def winding():
    s = np.linspace(0, 1, 60)
    turns = np.arange(1, 6)
    return JointPath("line", 0, 1, s, np.sin(turns * 2 * s[:, None] + turns) / turns)


def course_paths():
    joints = np.array(
        [
            [0.0, 0.0, 0.0, 0.0, 0.0],
            [4.05421051, 0.79926992, -2.28874961, 1.26920201, 2.64558435],
            [4.70848438, 1.37521755, -3.21426182, 1.78876146, 1.73020361],
            [1.43876323, 0.70547762, -2.5123522, 1.38666657, 1.62116132],
            [4.62257656, 1.49199568, -2.44350691, 2.09365912, 0.99909748],
        ]
    )
    points = YoubotKinematics().forward_kinematics(joints)[:, :3, 3]
    return resolve(joints[0], points, arm.LIMITS["urdf"])


def as_the_controller_runs(samples):
    times = np.arange(samples.shape[1]) * DT
    return interpolate(Trajectory(times, *samples), np.arange(0, times[-1] + DENSE / 2, DENSE))


@pytest.mark.parametrize("path", [straight(0.01, 0, 0, 0, 0), straight(1, 2, 3, -2, 1), winding()])
def test_the_limits_are_kept_to_the_last_bit_at_1_khz(path):
    _, v, a = as_the_controller_runs(time_path(path, VELOCITY, ACCELERATION, DT))
    assert (np.abs(v) <= VELOCITY).all()
    assert (np.abs(a) <= ACCELERATION).all()


def test_a_long_move_takes_the_time_of_the_trapezoid():
    path = straight(3.0, 1.0, 0, 0, 0)
    trapezoid = 3.0 / VELOCITY[0] + VELOCITY[0] / ACCELERATION[0]
    assert optimal_rate(path, VELOCITY, ACCELERATION)[0][-1] == pytest.approx(trapezoid, rel=1e-3)
    duration = (time_path(path, VELOCITY, ACCELERATION, DT).shape[1] - 1) * DT
    assert trapezoid <= duration <= trapezoid + 2.5 * DT


def test_each_part_begins_and_ends_at_rest_on_its_own_joints():
    path = winding()
    samples = time_path(path, VELOCITY, ACCELERATION, DT)
    np.testing.assert_array_equal(samples[0, [0, -1]], path.joints[[0, -1]])
    assert (samples[1:, [0, -1]] == 0).all()


def test_the_samples_lie_on_the_path():
    path = winding()
    q = time_path(path, VELOCITY, ACCELERATION, DT)[0]
    near = path.spline()(np.linspace(0, 1, 200_001))
    for sample in q[:: len(q) // 10]:
        assert np.abs(near - sample).max(axis=1).min() < 1e-4


def test_sampling_is_exact_between_samples_where_the_path_is_straight():
    """The acceleration runs in straight lines between samples, so no peak hides between them."""
    path = straight(1.0, 0.5, 0, 0, 0)
    rates = np.array([0.0, 0.4, 1.0, 1.7, 1.2, 0.3, 0.0])
    samples = sample_path(path.spline(), rates, DT)
    _, _, a = as_the_controller_runs(samples)
    assert np.abs(a).max() <= np.abs(samples[2]).max() * (1 + 1e-9)
    assert samples[0, -1] == pytest.approx(path.joints[-1])


def test_the_course_tour_is_timed_within_3_percent_of_toppra_and_stays_on_its_lines():
    kinematics, total, shortest = YoubotKinematics(), 0.0, 0.0
    for path in course_paths():
        samples = time_path(path, VELOCITY, ACCELERATION, DT)
        total += (samples.shape[1] - 1) * DT
        shortest += optimal_rate(path, VELOCITY, ACCELERATION)[0][-1]
        assert peak_load(samples, VELOCITY, ACCELERATION, DT) <= 1.0
        if path.kind == "line":
            q, _, _ = as_the_controller_runs(samples)
            x = kinematics.forward_kinematics(q)[:, :3, 3]
            along = (x[-1] - x[0]) / np.linalg.norm(x[-1] - x[0])
            assert np.linalg.norm(np.cross(x - x[0], along), axis=1).max() < 1e-4
    assert total <= 1.03 * shortest
    assert total < 10.5


def test_a_path_that_stands_still_takes_no_time():
    path = JointPath("line", 0, 1, np.array([0.0, 1.0]), np.ones((2, 5)))
    assert time_path(path, VELOCITY, ACCELERATION, DT).shape == (3, 1, 5)


def test_lower_limits_make_it_slower():
    fast = time_path(winding(), VELOCITY, ACCELERATION, DT)
    slow = time_path(winding(), VELOCITY / 2, ACCELERATION / 2, DT)
    assert slow.shape[1] > 1.3 * fast.shape[1]
    assert peak_load(slow, VELOCITY / 2, ACCELERATION / 2, DT) <= 1.0
