"""Planar arms against their own forward kinematics, written again here."""

import numpy as np
import pytest

from youbot_kinematics import InputError
from youbot_kinematics.planar import PlanarArm2R, PlanarArm4R, inverse_2r
from youbot_kinematics.selection import cost

L1, L2 = 0.155, 0.135


def forward_2r(a, b, l1=L1, l2=L2):
    return l1 * np.cos(a) + l2 * np.cos(a + b), l1 * np.sin(a) + l2 * np.sin(a + b)


def test_both_elbows_reach_random_points():
    rng = np.random.default_rng(0)
    x, y = forward_2r(*rng.uniform(-np.pi, np.pi, (2, 10_000)))
    a, b, beyond = inverse_2r(x, y, L1, L2)
    reached = forward_2r(a, b)
    assert np.abs(reached[0] - x[:, None]).max() < 1e-12
    assert np.abs(reached[1] - y[:, None]).max() < 1e-12
    assert (b[:, 0] >= 0).all() and (b[:, 1] <= 0).all() and (beyond == 0).all()


@pytest.mark.parametrize("direction", [0.0, 0.3, 2.0, -3.0])
@pytest.mark.parametrize("distance", [L1 + L2, L1 - L2], ids=["stretched", "folded"])
def test_the_edge_of_reach_is_within_reach_in_spite_of_rounding(distance, direction):
    for rounding in (-1, 0, 1):
        d = distance * (1 + rounding * np.finfo(float).eps)
        a, b, beyond = inverse_2r(d * np.cos(direction), d * np.sin(direction), L1, L2)
        assert beyond == 0
        assert np.allclose(
            forward_2r(a, b), [[d * np.cos(direction)] * 2, [d * np.sin(direction)] * 2]
        )


def test_out_of_reach_says_by_how_much_and_gives_the_nearest_point():
    a, b, beyond = inverse_2r([0.0, 0.0], [0.30, 0.01], L1, L2)
    assert np.allclose(beyond, [0.30 - (L1 + L2), 0.01 - (L1 - L2)], atol=1e-15)
    assert np.allclose(forward_2r(a, b)[1], [[L1 + L2] * 2, [L1 - L2] * 2])


def test_links_of_one_length_reach_the_shoulder_itself_folded():
    a, b, beyond = inverse_2r(0.0, 0.0, 0.1, 0.1)
    assert beyond == 0 and np.isfinite(a).all()
    assert np.allclose(np.abs(b), np.pi)
    assert np.allclose(forward_2r(a, b, 0.1, 0.1), 0, atol=1e-16)


def test_a_stretched_arm_is_exactly_straight_whatever_the_rounding():
    x, y = forward_2r(0.7, 0.0)
    assert (inverse_2r(x, y, L1, L2)[1] == 0).all()


LENGTHS = np.array([0.4, 0.3, 0.25, 0.1])
LOWER, UPPER = np.array([-2.5, -2.6, -2.0, -1.9]), np.array([2.4, 2.7, 2.2, 1.8])
ARM = PlanarArm4R(*LENGTHS, LOWER, UPPER)


def forward_4r(q):
    sums = np.cumsum(q, axis=-1)
    return (LENGTHS * np.cos(sums)).sum(-1), (LENGTHS * np.sin(sums)).sum(-1), sums[..., -1]


def random_joints(n, seed=0):
    return np.random.default_rng(seed).uniform(LOWER, UPPER, (n, 4))


def turned(angle):
    return np.abs(np.angle(np.exp(1j * np.asarray(angle))))


def test_forward_kinematics_of_four_links_adds_them_up():
    assert np.allclose(ARM.forward(random_joints(100)), forward_4r(random_joints(100)), atol=1e-15)


def test_the_planar_jacobian_is_what_central_differences_give():
    q, step = random_joints(100), 1e-6
    J = ARM.jacobian(q)
    for i in range(4):
        ahead, behind = (forward_4r(q + sign * step * np.eye(4)[i]) for sign in (1, -1))
        slope = (np.stack(ahead, -1) - np.stack(behind, -1)) / (2 * step)
        assert np.abs(J[..., i] - slope).max() < 1e-8


def test_both_elbows_of_four_links_reach_the_pose_and_the_generating_joints_are_among_them():
    for q in random_joints(500):
        x, y, phi = forward_4r(q)
        solutions = ARM.inverse(x, y, phi, q[3])
        assert 1 <= len(solutions) <= 2
        reached = forward_4r(solutions)
        assert np.abs(reached[0] - x).max() < 1e-12 and np.abs(reached[1] - y).max() < 1e-12
        assert turned(reached[2] - phi).max() < 1e-12
        assert ((solutions >= LOWER) & (solutions <= UPPER)).all()
        assert np.abs(solutions - q).max(axis=1).min() < 1e-8


def test_solutions_exist_inside_the_intervals_of_theta4_and_nowhere_else():
    for x, y, phi in zip(*forward_4r(random_joints(20, seed=1))):
        by_elbow = ARM.theta4_intervals(x, y, phi)
        for theta4 in np.linspace(-np.pi, np.pi, 120):
            solutions = ARM.inverse(x, y, phi, theta4)
            for sign, intervals in zip((1, -1), by_elbow):
                inside = any(low <= theta4 <= high for low, high in intervals)
                assert inside == bool((sign * solutions[:, 1] > 0).any())


def test_the_ends_of_the_intervals_are_exact_there_a_joint_is_on_a_limit_or_the_elbow_straight():
    for x, y, phi in zip(*forward_4r(random_joints(40, seed=2))):
        for theta4 in np.array([i for e in ARM.theta4_intervals(x, y, phi) for i in e]).ravel():
            solutions = ARM.inverse(x, y, phi, theta4)
            to_limit = np.minimum(solutions - LOWER, UPPER - solutions).min()
            assert to_limit < 1e-7 or np.abs(solutions[:, 1]).min() < 1e-6


def test_a_stretched_arm_of_four_links_has_one_solution():
    whole = PlanarArm4R(*LENGTHS)
    (interval,), _ = whole.theta4_intervals(LENGTHS.sum(), 0, 0)
    assert np.allclose(interval, 0, atol=1e-6)
    assert np.allclose(whole.inverse(LENGTHS.sum(), 0, 0, 0), np.zeros((1, 4)))
    assert whole.theta4_intervals(LENGTHS.sum() + 1e-6, 0, 0) == [[], []]


@pytest.mark.parametrize(
    "criterion", ["limits", "singularity", "movement", {"limits": 1, "movement": 0.2}]
)
def test_no_sample_of_the_free_angle_beats_the_resolved_one(criterion):
    for q in random_joints(10, seed=3):
        x, y, phi = forward_4r(q)
        best = ARM.best_solution(x, y, phi, criterion, seed=q + 0.1)
        assert np.allclose(forward_4r(best)[:2], (x, y), atol=1e-9)
        samples = [s for t in np.linspace(-1.9, 1.8, 400) for s in ARM.inverse(x, y, phi, t)]
        least = cost(np.array(samples), criterion, ARM, seed=q + 0.1).min()
        assert cost(best[None], criterion, ARM, seed=q + 0.1)[0] <= least + 1e-6


def test_two_links_reach_their_points_with_both_elbows_inside_their_limits():
    both, one = PlanarArm2R(L1, L2), PlanarArm2R(L1, L2, [-np.pi, 0], [np.pi, np.pi])
    x, y = forward_2r(0.4, 1.1)
    assert len(both.inverse(x, y)) == 2
    assert np.allclose(one.inverse(x, y), [[0.4, 1.1]])
    assert np.allclose(both.forward(both.inverse(x, y))[:2], [[x, x], [y, y]])
    assert len(both.inverse(1.0, 0.0)) == 0


@pytest.mark.parametrize(
    ("make", "sentence"),
    [
        (lambda: PlanarArm2R(0.1, 0.0), "positive lengths"),
        (lambda: PlanarArm4R(1, 1, 1, np.nan), "positive lengths"),
        (lambda: PlanarArm2R(1, 1, [0], [1]), "2 lower ones"),
        (lambda: PlanarArm2R(1, 1, [0, 1], [1, 0]), "below its upper"),
        (lambda: ARM.forward([0, 0, 0]), r"got \(3,\)"),
        (lambda: ARM.theta4_intervals(np.nan, 0, 0), "must be finite"),
        (lambda: ARM.best_solution(5, 0, 0), "no joints inside the limits reach"),
    ],
)
def test_bad_planar_input_is_refused_with_a_sentence(make, sentence):
    with pytest.raises(InputError, match=sentence):
        make()
