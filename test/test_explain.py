"""The reasons for moves between postures, on ways where the reason is known."""

import numpy as np

from youbot_kinematics import YoubotKinematics, joint_limits
from youbot_kinematics.resolve import resolve
from youbot_kinematics.resolve.explain import explained, why_not_as_it_is

ARM = YoubotKinematics()
LIMITS = joint_limits("urdf")


def circle(q, angle, n=400):
    """The tool of joints q (5,) carried round joint 1's axis by an angle, (n, 3) m."""
    x, y, z = ARM.forward_kinematics(q)[:3, 3]
    turn = np.linspace(0, angle, n)
    c, s = np.cos(turn), np.sin(turn)
    return np.column_stack([c * x - s * y, s * x + c * y, np.full(n, z)])


def test_joint_1_cannot_turn_through_the_gap_between_its_limits():
    q = np.array([5.0, 1.2, -2.0, 2.2, 2.9])
    reason = why_not_as_it_is(q, circle(q, -np.pi), LIMITS)
    assert "reaching forward" in reason
    assert "arm_joint_1 would pass its upper limit 5.8992 rad" in reason


def test_a_way_that_the_posture_follows_to_its_end_is_not_blamed_on_a_joint():
    q = np.array([2.9, 1.2, -2.0, 2.2, 2.9])
    assert "can stand all along the way" in why_not_as_it_is(q, circle(q, 1.0), LIMITS)


def test_a_way_out_of_reach_says_so():
    q = np.array([2.9, 1.2, -2.0, 2.2, 2.9])
    p = ARM.forward_kinematics(q)[:3, 3]
    away = p + np.linspace(0, 1, 300)[:, None] * np.array([1.0, 0, 0])
    assert "does not reach the line at" in why_not_as_it_is(q, away, LIMITS)


def test_every_move_of_a_tour_has_its_reason_and_no_line_has_one():
    rng = np.random.default_rng(5)
    for _ in range(8):
        joints = rng.uniform(LIMITS.lower, LIMITS.upper, (4, 5))
        points = ARM.forward_kinematics(joints)[:, :3, 3]
        paths = explained(resolve(joints[0], points, LIMITS), points, LIMITS)
        assert all(bool(path.reason) == (path.kind != "line") for path in paths)
