"""The nearest reachable pose, against numerical optimisers that know nothing of its formulas."""

import numpy as np
import pytest
from scipy.optimize import minimize
from scipy.spatial.transform import Rotation

from youbot_kinematics import InputError, YoubotKinematics, arm

PROFILES = [YoubotKinematics(name) for name in arm.LIMITS]
KIN = PROFILES[0]


def angle_between(a, b):
    return Rotation.from_matrix(np.swapaxes(a[..., :3, :3], -1, -2) @ b[..., :3, :3]).magnitude()


def random_pose(rng):
    T = np.eye(4)
    T[:3, :3] = Rotation.from_quat(rng.normal(size=4)).as_matrix()
    T[:3, 3] = rng.uniform([-0.6, -0.6, -0.3], [0.6, 0.6, 0.8])
    return T


def assert_true(kin, T, nearest):
    """What the result says of itself is so."""
    assert len(nearest.solutions) >= 1 and kin.limits.contain(nearest.solutions).all()
    assert np.abs(kin.forward_kinematics(nearest.solutions) - nearest.pose).max() < 1e-9
    assert np.isclose(
        nearest.position_error, np.linalg.norm(nearest.pose[:3, 3] - T[:3, 3]), atol=1e-9
    )
    assert np.isclose(nearest.angle_error, angle_between(nearest.pose, T), atol=1e-9)


@pytest.mark.parametrize("kin", PROFILES)
def test_no_optimiser_brings_the_tool_nearer_to_a_position(kin):
    rng = np.random.default_rng(0)
    lower, upper = kin.limits[:2]
    for _ in range(25):
        T = random_pose(rng)
        nearest = kin.nearest_reachable_pose(T)
        assert_true(kin, T, nearest)
        for start in rng.uniform(lower, upper, (6, 5)):
            found = minimize(
                lambda q, p=T[:3, 3]: ((kin.forward_kinematics(q)[:3, 3] - p) ** 2).sum(),
                start,
                bounds=list(zip(lower, upper)),
            )
            assert nearest.position_error <= np.sqrt(found.fun) + 1e-7


def test_no_joints_at_the_same_position_turn_the_tool_nearer():
    rng = np.random.default_rng(1)
    sampled = 0
    for q in rng.uniform(*KIN.limits[:2], (15, 5)):
        T = random_pose(rng)
        T[:3, 3] = KIN.forward_kinematics(q)[:3, 3]
        nearest = KIN.nearest_reachable_pose(T)
        assert_true(KIN, T, nearest)
        assert nearest.position_error < 1e-12
        for pitch in np.linspace(-np.pi, np.pi, 60):
            others = KIN.inverse_position(T[:3, 3], pitch).solutions
            for q5 in np.linspace(KIN.limits.lower[4], KIN.limits.upper[4], 30):
                others[:, 4:] = q5
                sampled += len(others)
                if len(others):
                    turned = angle_between(KIN.forward_kinematics(others), T)
                    assert nearest.angle_error <= turned.min() + 1e-9
    assert sampled > 5_000


def test_far_from_the_limits_it_is_the_singular_value_decomposition_of_the_quaternion():
    rng = np.random.default_rng(2)
    q = np.array([2.9, 1.0, -1.2, 1.7, 2.9])
    for _ in range(200):
        T = KIN.forward_kinematics(q)
        T[:3, :3] = Rotation.from_rotvec(rng.normal(scale=0.05, size=3)).as_matrix() @ T[:3, :3]
        to_plane = Rotation.from_euler("Z", -np.arctan2(T[1, 3], T[0, 3]))
        x, y, z, w = (to_plane * Rotation.from_matrix(T[:3, :3])).as_quat()
        largest = np.linalg.svd([[w, z], [y, x]], compute_uv=False)[0]
        nearest = KIN.nearest_reachable_pose(T)
        assert_true(KIN, T, nearest)
        assert np.isclose(nearest.angle_error, 2 * np.arccos(min(largest, 1.0)), atol=1e-7)


def test_a_reachable_pose_is_its_own_nearest():
    for q in np.random.default_rng(3).uniform(*KIN.limits[:2], (100, 5)):
        T = KIN.forward_kinematics(q)
        nearest = KIN.nearest_reachable_pose(T)
        assert np.abs(nearest.pose - T).max() < 1e-12
        assert nearest.position_error == nearest.angle_error == 0.0
        assert np.abs(nearest.solutions - q).max(axis=1).min() < 1e-6


def test_a_pose_printed_to_three_digits_is_solved_to_that_precision():
    for q in np.random.default_rng(4).uniform(*KIN.limits[:2], (50, 5)):
        T = KIN.forward_kinematics(q)
        with pytest.raises(InputError, match="nearest_reachable_pose"):
            KIN.inverse_kinematics(T.round(3))
        nearest = KIN.nearest_reachable_pose(T.round(3))
        assert nearest.position_error < 1e-3
        assert np.abs(nearest.pose[:3, 3] - T[:3, 3]).max() < 1e-3


@pytest.mark.parametrize(
    "position",
    [[0, 0, 2.0], [0, 0, 0.145], [0.033, 0, 0.145], [2.0, 0, 0.145], [0, 0, -1.0], [0, 0, 0]],
    ids=str,
)
def test_degenerate_positions_have_a_nearest_pose_as_well(position):
    rng = np.random.default_rng(5)
    for angles in ([0, 0, 0], [0, np.pi, 0], [0.3, np.pi / 2, 0], rng.uniform(-3, 3, 3)):
        T = np.eye(4)
        T[:3, :3], T[:3, 3] = Rotation.from_euler("ZYZ", angles).as_matrix(), position
        assert_true(KIN, T, KIN.nearest_reachable_pose(T))


def test_one_pose_is_asked_for_and_a_rotation_in_it():
    with pytest.raises(InputError, match="takes one pose"):
        KIN.nearest_reachable_pose(np.tile(np.eye(4), (2, 1, 1)))
    with pytest.raises(InputError, match="must hold a rotation"):
        KIN.nearest_reachable_pose(np.diag([1.0, 1.0, 0.9, 1.0]))
