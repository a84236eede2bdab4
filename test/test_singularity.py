"""The kinds of singularity, verified against the singular values of the whole Jacobian."""

import numpy as np

from youbot_kinematics import YoubotKinematics
from youbot_kinematics.singularity import SINGULARITY_THRESHOLD

KIN = YoubotKinematics()
LIMITS = KIN.limits
STRAIGHT = np.deg2rad(-146)
WRIST_IN_LINE = np.deg2rad(102.5) + np.arctan2(0.002, 0.185)


def grid():
    """Joints on a grid that has singular configurations of each kind on it."""
    q2, q3, q4 = (np.linspace(LIMITS.lower[i], LIMITS.upper[i], 25) for i in (1, 2, 3))
    axes = np.array([0.0, 2.0]), q2, np.append(q3, STRAIGHT), np.append(q4, WRIST_IN_LINE), [1.0]
    on_grid = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 5)
    return np.concatenate([on_grid, vertical_on_the_axis()])


def vertical_on_the_axis():
    T = np.tile(np.eye(4), (20, 1, 1))
    T[:, 2, 3] = np.linspace(0.4, 0.56, 20)
    branches = KIN.inverse_branches(T)
    return branches.joints[branches.valid]


def test_the_kinds_are_together_all_that_the_singular_values_find_on_a_grid():
    q = grid()
    kinds = KIN.classify_singularity(q)
    assert ((kinds.elbow | kinds.wrist) == KIN.check_singularity(q)).all()
    assert ((kinds.shoulder | kinds.stretch) == KIN.check_singularity(q, position_only=True)).all()
    for kind in kinds:
        assert 0 < kind.sum() < len(q)


def test_the_elbow_is_singular_where_it_is_straight_and_nowhere_else():
    q = grid()
    kinds = KIN.classify_singularity(q)
    assert kinds.elbow[q[:, 2] == STRAIGHT].all()
    assert (np.abs(np.sin(q[kinds.elbow, 2] - STRAIGHT)) < 0.1).all()


def test_the_shoulder_is_singular_where_the_tool_is_on_joint_1s_axis_and_nowhere_else():
    q = grid()
    reach = np.hypot(*KIN.forward_kinematics(q)[:, :2, 3].T)
    assert (KIN.classify_singularity(q).shoulder == (reach < SINGULARITY_THRESHOLD)).all()


def test_every_wrist_singularity_is_one_of_the_shoulder_and_every_stretch_one_of_the_elbow():
    q = grid()
    kinds = KIN.classify_singularity(q)
    assert kinds.shoulder[kinds.wrist].all() and kinds.wrist[-len(vertical_on_the_axis()) :].all()
    assert kinds.elbow[kinds.stretch].all()


def test_kinds_of_one_configuration_have_names():
    full_stretch = np.array([1.0, 1.2, STRAIGHT, WRIST_IN_LINE, 1.0])
    assert KIN.classify_singularity(full_stretch).names() == ["elbow", "stretch"]
    assert KIN.classify_singularity(vertical_on_the_axis()[0]).names() == ["shoulder", "wrist"]
    assert KIN.classify_singularity(np.array([1.0, 1.0, -1.0, 1.0, 1.0])).names() == []


def near(q, rng):
    """Joints next to singular ones, at distances from 0.1 to 1e-17 rad."""
    distance = 10.0 ** rng.uniform(-17, -1, (len(q), 1))
    return q + distance * rng.uniform(-1, 1, q.shape)


def test_the_smallest_singular_value_is_that_of_a_singular_value_decomposition():
    rng = np.random.default_rng(1)
    everywhere = rng.uniform(-np.pi, np.pi, (20_000, 5))
    straight, folded = everywhere[:2000].copy(), everywhere[2000:4000].copy()
    straight[:, 2], folded[:, 2] = STRAIGHT, STRAIGHT + np.pi
    singular = np.concatenate([grid(), straight, folded])
    for q in (everywhere, singular, near(singular, rng)):
        decomposed = np.linalg.svd(KIN.get_jacobian(q), compute_uv=False)[:, -1]
        assert np.abs(KIN.smallest_singular_value(q) - decomposed).max() < 1e-14


def test_manipulability_is_the_root_of_the_determinant_where_there_is_one():
    q = np.random.default_rng(0).uniform(LIMITS.lower, LIMITS.upper, (500, 5))
    J = KIN.get_jacobian(q)
    transposed = np.swapaxes(J, -1, -2)
    assert np.allclose(KIN.manipulability(q), np.sqrt(np.linalg.det(transposed @ J)))
    position = np.sqrt(np.linalg.det(J[:, :3] @ transposed[:, :, :3]))
    assert np.allclose(KIN.manipulability(q, position_only=True), position)
