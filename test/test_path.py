"""Straight lines and slerp between checkpoints."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from youbot_kinematics.path import decoupled_rot_and_trans, intermediate_tfs, pose_between


def random_poses(n, seed=0):
    rng = np.random.default_rng(seed)
    poses = np.tile(np.eye(4), (n, 1, 1))
    poses[:, :3, :3] = Rotation.random(n, random_state=seed).as_matrix()
    poses[:, :3, 3] = rng.uniform(-0.5, 0.5, (n, 3))
    return poses


@pytest.mark.parametrize("num_points", [0, 1, 10])
def test_the_way_has_every_checkpoint_once_and_the_last_one_too(num_points):
    poses = random_poses(4)
    way = intermediate_tfs([2, 0, 3, 1], poses, num_points)
    assert way.shape == (3 * (num_points + 1) + 1, 4, 4)
    np.testing.assert_allclose(way[:: num_points + 1], poses[[2, 0, 3, 1]], atol=1e-15)


def test_intermediate_poses_lie_evenly_on_the_straight_line():
    T_a, T_b = random_poses(2)
    positions = decoupled_rot_and_trans(T_a, T_b, 9)[:, :3, 3]
    expected = np.linspace(T_a[:3, 3], T_b[:3, 3], 11)[1:-1]
    np.testing.assert_allclose(positions, expected, atol=1e-15)


@given(st.integers(0, 1000), st.floats(0, 1))
def test_the_orientation_turns_about_a_fixed_axis_at_constant_rate(seed, s):
    T_a, T_b = random_poses(2, seed)
    whole = Rotation.from_matrix(T_a[:3, :3].T @ T_b[:3, :3]).as_rotvec()
    part = Rotation.from_matrix(T_a[:3, :3].T @ pose_between(T_a, T_b, [s])[0, :3, :3]).as_rotvec()
    np.testing.assert_allclose(part, s * whole, atol=1e-12)


def test_slerp_of_two_equal_orientations_is_that_orientation():
    T = random_poses(1)[0]
    np.testing.assert_allclose(decoupled_rot_and_trans(T, T, 5), np.tile(T, (5, 1, 1)), atol=1e-12)


def test_the_ends_of_the_way_are_the_checkpoints():
    T_a, T_b = random_poses(2)
    np.testing.assert_allclose(pose_between(T_a, T_b, [0, 1]), [T_a, T_b], atol=1e-12)
