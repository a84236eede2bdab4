"""What controllers accept, what this package publishes, and how the stand-in for both moves."""

from __future__ import annotations

import numpy as np
import pytest

from youbot_kinematics import JOINT_NAMES, InputError, joint_limits
from youbot_kinematics.contract import (
    acceptance_problems,
    command_from_trajectory,
    shape_problems,
    trajectory_from_command,
)
from youbot_kinematics.controller import START_TOLERANCE, STOP_TIME, Controller
from youbot_kinematics.trajectory import Trajectory, interpolate

LIMITS = joint_limits("urdf")
HOME = np.zeros(5)
AWAY = np.array([1.0, 0.8, -1.2, 0.6, 1.0])


def quintic(start, end, duration=2.0, n=101):
    """A straight move in joint space from rest to rest."""
    t = np.linspace(0.0, duration, n)
    s = t / duration
    shapes = (
        10 * s**3 - 15 * s**4 + 6 * s**5,
        (30 * s**2 - 60 * s**3 + 30 * s**4) / duration,
        (60 * s - 180 * s**2 + 120 * s**3) / duration**2,
    )
    p, v, a = (shape[:, None] * (np.asarray(end, float) - start) for shape in shapes)
    return Trajectory(t, p + start, v, a)


@pytest.fixture
def command():
    """A command that keeps all rules, in lists that a test may spoil."""
    good = command_from_trajectory(quintic(HOME, AWAY))
    return good._replace(
        joint_names=list(good.joint_names),
        positions=good.positions.tolist(),
        velocities=good.velocities.tolist(),
        accelerations=good.accelerations.tolist(),
    )


def the_problem(command):
    """The one sentence that is said of a command."""
    problems = acceptance_problems(command, LIMITS)
    assert len(problems) == 1
    assert shape_problems(command, LIMITS) == problems
    return problems[0]


class TestAcceptance:
    def test_a_good_command_is_accepted_and_has_the_published_shape(self, command):
        assert acceptance_problems(command, LIMITS) == []
        assert shape_problems(command, LIMITS) == []

    @pytest.mark.parametrize("names", [(), JOINT_NAMES[:4], JOINT_NAMES[::-1]])
    def test_joints_missing_or_in_another_order_are_named(self, command, names):
        problem = the_problem(command._replace(joint_names=names))
        assert all(name in problem for name in JOINT_NAMES)

    @pytest.mark.parametrize("quantity", ["position", "velocity", "acceleration"])
    @pytest.mark.parametrize("length", [0, 4, 6])
    def test_a_row_of_another_length_is_named(self, command, quantity, length):
        rows = {"velocity": command.velocities, "acceleration": command.accelerations}
        rows.get(quantity, command.positions)[7] = [0.1] * length
        assert the_problem(command) == f"point 7 has {length} values of {quantity}, not 5"

    @pytest.mark.parametrize("value", [float("nan"), float("inf"), -float("inf")])
    def test_a_value_that_is_not_finite_is_named_with_its_joint(self, command, value):
        command.accelerations[5][3] = value
        assert the_problem(command) == f"point 5: the acceleration of arm_joint_4 is {value}"

    @pytest.mark.parametrize("ns", [0, -1])
    def test_times_that_do_not_increase_by_a_nanosecond_are_refused(self, command, ns):
        command.times[9] = command.times[8] + ns
        assert the_problem(command).startswith("point 9 at 0.1")

    def test_times_that_increase_by_one_nanosecond_are_accepted(self, command):
        command.times[9] = command.times[8] + 1
        assert acceptance_problems(command, LIMITS) == []

    def test_a_time_before_the_start_is_refused(self, command):
        command.times[0] = -1
        assert "before the start" in the_problem(command)

    def test_a_position_outside_of_its_limit_is_named(self, command):
        command.positions[50][2] = 0.1
        assert "point 50: arm_joint_3 at 0.1" in the_problem(command)

    def test_limits_themselves_are_inside(self, command):
        command.positions[50] = LIMITS.upper.tolist()
        command.velocities[50] = LIMITS.velocity.tolist()
        assert acceptance_problems(command, LIMITS) == []

    def test_a_velocity_above_its_limit_is_named(self, command):
        command.velocities[50][1] = -1.6
        assert "point 50: arm_joint_2 moves at 1.6" in the_problem(command)

    def test_no_points_are_nothing_to_run(self, command):
        empty = command._replace(times=[], positions=[], velocities=[], accelerations=[])
        assert "no points" in the_problem(empty)


class TestShape:
    def only_shape_problem(self, command):
        assert acceptance_problems(command, LIMITS) == []
        problems = shape_problems(command, LIMITS)
        assert len(problems) == 1
        return problems[0]

    def test_it_starts_now(self, command):
        assert "stamp" in self.only_shape_problem(command._replace(stamp=5))

    def test_its_first_point_is_at_time_zero(self, command):
        late = command._replace(times=[t + 20_000_000 for t in command.times])
        assert "first point" in self.only_shape_problem(late)

    def test_its_points_are_evenly_spaced(self, command):
        command.times[9] += 2
        assert "apart" in self.only_shape_problem(command)

    @pytest.mark.parametrize("rows", ["velocities", "accelerations"])
    @pytest.mark.parametrize("point, where", [(0, "first"), (-1, "last")])
    def test_the_arm_is_at_rest_at_both_ends(self, command, rows, point, where):
        getattr(command, rows)[point][4] = 1e-6
        assert f"of the {where} point is not zero" in self.only_shape_problem(command)


def test_a_trajectory_survives_the_way_into_a_command_and_back():
    trajectory = quintic(HOME, AWAY, duration=1 / 3 + 2, n=118)
    back = trajectory_from_command(command_from_trajectory(trajectory))
    np.testing.assert_allclose(back.times, trajectory.times, rtol=0, atol=5e-10)
    for before, after in zip(trajectory[1:4], back[1:4]):
        np.testing.assert_array_equal(before, after)


class TestController:
    @pytest.fixture
    def controller(self):
        return Controller(HOME, LIMITS)

    def path(self, controller, begin, end):
        """Positions and velocities every millisecond."""
        states = [controller.state(t)[:2] for t in np.arange(begin, end, 0.001)]
        return np.array([s[0] for s in states]), np.array([s[1] for s in states])

    def assert_smooth(self, *paths):
        """Positions and velocities without a jump: positions move as the velocities say."""
        positions, velocities = (np.concatenate(parts) for parts in zip(*paths))
        mean = (velocities[1:] + velocities[:-1]) / 2
        np.testing.assert_allclose(np.diff(positions, axis=0), mean * 0.001, atol=1e-4)

    def test_it_follows_a_trajectory_as_the_quintic_says(self, controller):
        wanted = quintic(HOME, AWAY)
        assert controller.command(command_from_trajectory(wanted), now=5.0) == 0
        times = np.linspace(0.0, 2.5, 333)
        for t, position in zip(times, interpolate(wanted, times)[0]):
            np.testing.assert_allclose(controller.state(5.0 + t)[0], position, atol=1e-9)

    def test_it_stands_exactly_after_the_end(self, controller):
        controller.command(command_from_trajectory(quintic(HOME, AWAY)), now=0.0)
        position, velocity, acceleration = controller.state(2.1)
        np.testing.assert_array_equal(position, AWAY)
        assert not velocity.any() and not acceleration.any()

    def test_a_refused_command_does_not_disturb_the_one_that_runs(self, controller, command):
        controller.command(command, now=0.0)
        with pytest.raises(InputError, match="joints"):
            controller.command(command._replace(joint_names=[]), now=1.0)
        np.testing.assert_allclose(controller.state(3.0)[0], AWAY)

    def test_a_new_trajectory_takes_over_smoothly(self, controller, command):
        controller.command(command, now=0.0)
        here, before = controller.state(1.0)[0], self.path(controller, 0.0, 1.0)
        end = np.array([0.2, 1.2, -0.3, 0.9, 0.2])
        controller.command(command_from_trajectory(quintic(here, end)), now=1.0)
        self.assert_smooth(before, self.path(controller, 1.0, 4.0))
        np.testing.assert_allclose(controller.state(4.0)[0], end)

    def test_an_empty_command_stops_the_arm_smoothly(self, controller, command):
        controller.command(command, now=0.0)
        speed, before = controller.state(1.0)[1], self.path(controller, 0.0, 1.0)
        controller.command(command._replace(times=[]), now=1.0)
        self.assert_smooth(before, self.path(controller, 1.0, 2.0))
        position, velocity, _ = controller.state(1.0 + STOP_TIME)
        assert not velocity.any()
        np.testing.assert_allclose(position, AWAY / 2 + speed * STOP_TIME / 2, atol=1e-9)

    def test_a_later_start_waits_and_the_trajectory_before_goes_on_until_then(
        self, controller, command
    ):
        controller.command(command, now=0.0)
        back = command_from_trajectory(quintic(AWAY, HOME))
        controller.command(back, now=0.5, start=3.0)
        np.testing.assert_allclose(controller.state(1.0)[0], AWAY / 2)
        np.testing.assert_allclose(controller.state(3.0)[0], AWAY)
        np.testing.assert_allclose(controller.state(4.0)[0], AWAY / 2)
        np.testing.assert_allclose(controller.state(5.0)[0], HOME, atol=1e-12)

    def test_points_in_the_past_are_dropped_and_the_rest_is_run(self, controller, command):
        assert controller.command(command, now=10.0, start=9.9) == 5
        self.assert_smooth(self.path(controller, 10.0, 12.0))
        np.testing.assert_allclose(controller.state(11.9)[0], AWAY)

    def test_a_trajectory_that_is_over_is_refused(self, controller, command):
        with pytest.raises(InputError, match="past"):
            controller.command(command, now=10.0, start=7.0)

    def test_a_jump_is_refused_and_a_sensors_error_is_not(self, controller):
        near, far = HOME.copy(), HOME.copy()
        near[0], far[0] = 0.9 * START_TOLERANCE, 0.5
        with pytest.raises(InputError, match="arm_joint_1"):
            controller.command(command_from_trajectory(quintic(far, AWAY)), now=0.0)
        assert controller.command(command_from_trajectory(quintic(near, AWAY)), now=0.0) == 0

    def test_the_past_is_forgotten(self, controller):
        for i in range(50):
            ends = (HOME, AWAY) if i % 2 == 0 else (AWAY, HOME)
            controller.command(command_from_trajectory(quintic(*ends)), now=3.0 * i)
        assert len(controller._trajectory.times) < 110

    def test_it_cannot_start_outside_of_the_limits(self):
        with pytest.raises(InputError, match="arm_joint_3"):
            Controller([0, 0, 1, 0, 0], LIMITS)
