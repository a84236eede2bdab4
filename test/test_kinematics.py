"""Forward kinematics, Jacobian and singularities, against formulas that use none of their code."""

import sys

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from youbot_kinematics import InputError, YoubotKinematics, arm

KIN = YoubotKinematics()
LIMITS = KIN.limits


def random_joints(n, seed=0):
    return np.random.default_rng(seed).uniform(LIMITS.lower, LIMITS.upper, (n, 5))


def dh_product(q):
    """Poses of the base and the five frames: the product of Rz(theta) Tz(d) Tx(a) Rx(alpha)."""
    theta = arm.THETA_0 + arm.OFFSET + arm.SIGN * q
    frames = [np.broadcast_to(np.eye(4), (len(q), 4, 4))]
    for i in range(5):
        link = np.zeros((len(q), 4, 4))
        turn = Rotation.from_euler("Z", theta[:, i]) * Rotation.from_euler("X", arm.ALPHA[i])
        link[:, :3, :3] = turn.as_matrix()
        link[:, 0, 3] = arm.A[i] * np.cos(theta[:, i])
        link[:, 1, 3] = arm.A[i] * np.sin(theta[:, i])
        link[:, 2, 3], link[:, 3, 3] = arm.D[i], 1
        frames.append(frames[-1] @ link)
    return frames


def elbow_singular(wrist=1.0):
    return np.array([1.0, 1.2, np.deg2rad(-146), wrist, 2.0])


def tool_at(radius, height, pitch):
    """Joints with the tool at a point of the plane of azimuth 0, elbow bent."""
    T = np.eye(4)
    T[:3, :3] = Rotation.from_euler("Y", pitch).as_matrix()
    T[:3, 3] = [radius, 0, height]
    return KIN.inverse_kinematics(T, seed=arm.UPRIGHT)[0]


def test_every_frame_is_the_product_of_the_denavit_hartenberg_transforms():
    q = random_joints(10_000)
    for number, frame in enumerate(dh_product(q)):
        T = KIN.forward_kinematics(q, number)
        assert np.abs(T - frame).max() < 1e-14
        assert (T[:, 3] == [0, 0, 0, 1]).all()


def test_the_frames_before_the_tool_are_on_the_joints_behind_them():
    q = random_joints(1)[0]
    phi, t2 = np.deg2rad(170) - q[0], q[1] - np.deg2rad(65)
    t23 = t2 + q[2] + np.deg2rad(146)
    r, z = np.cumsum([[0.033, 0.145], 0.155 * np.array([np.sin(t2), np.cos(t2)]),
                      0.135 * np.array([np.sin(t23), np.cos(t23)])], axis=0).T  # fmt: skip
    on_joints = np.stack([r * np.cos(phi), r * np.sin(phi), z], axis=-1)
    for frame in (1, 2, 3):
        assert np.allclose(
            KIN.forward_kinematics(q, frame)[:3, 3], on_joints[frame - 1], atol=1e-12
        )
    assert (KIN.forward_kinematics(q, 0) == np.eye(4)).all()


def test_the_jacobian_is_what_central_differences_give():
    q, step = random_joints(1000), 1e-6
    J = KIN.get_jacobian(q)
    T = KIN.forward_kinematics(q)
    for i in range(5):
        ahead = KIN.forward_kinematics(q + step * np.eye(5)[i])
        behind = KIN.forward_kinematics(q - step * np.eye(5)[i])
        linear = (ahead[:, :3, 3] - behind[:, :3, 3]) / (2 * step)
        spin = (ahead - behind)[:, :3, :3] / (2 * step) @ np.swapaxes(T[:, :3, :3], -1, -2)
        angular = np.stack([spin[:, 2, 1], spin[:, 0, 2], spin[:, 1, 0]], axis=-1)
        assert np.abs(J[:, :3, i] - linear).max() < 1e-6
        assert np.abs(J[:, 3:, i] - angular).max() < 1e-6


def test_joint_1_turns_the_tool_about_minus_z():
    assert (KIN.get_jacobian(random_joints(1)[0])[3:, 0] == [0, 0, -1]).all()


def test_a_batch_of_any_shape_gives_what_its_members_give():
    q = random_joints(6).reshape(2, 3, 5)
    for function, shape in [
        (KIN.forward_kinematics, (4, 4)),
        (KIN.get_jacobian, (6, 5)),
        (KIN.smallest_singular_value, ()),
        (KIN.check_singularity, ()),
    ]:
        batch = function(q)
        assert batch.shape == (2, 3, *shape)
        for index in np.ndindex(2, 3):
            assert np.allclose(batch[index], function(q[index]), rtol=0, atol=1e-15)
        assert function(q[:0]).shape == (0, 3, *shape)


@pytest.mark.parametrize(
    "as_given",
    [
        np.ndarray.tolist,
        lambda q: q.astype(">f8"),
        lambda q: np.asfortranarray(q),
        lambda q: np.repeat(q, 2, axis=0)[::2],
        lambda q: np.repeat(q, 2, axis=1)[:, ::2],
        lambda q: q.astype(object),
        lambda q: np.ma.masked_array(q),
    ],
)
def test_joints_and_poses_may_come_in_any_array_of_numbers(as_given):
    q = random_joints(6)
    T, J = KIN.forward_kinematics(q), KIN.get_jacobian(q)
    assert (KIN.forward_kinematics(as_given(q)) == T).all()
    assert (KIN.get_jacobian(as_given(q)) == J).all()
    for pose in T:
        assert (KIN.inverse_kinematics(as_given(pose)) == KIN.inverse_kinematics(pose)).all()
    whole = np.ones((2, 5), dtype=int)
    assert (KIN.forward_kinematics(whole) == KIN.forward_kinematics(whole.astype(float))).all()


def test_nothing_holds_on_to_what_it_was_given():
    q, T = random_joints(3), KIN.forward_kinematics(random_joints(3))
    broken, odd = np.full((2, 5), np.nan), np.zeros((4, 4))
    given = [q, T, T[0], broken, odd, KIN.limits.lower, KIN.limits.upper]

    def use():
        KIN.forward_kinematics(q), KIN.forward_kinematics(q, 3), KIN.get_jacobian(q)
        KIN.inverse_branches(T), KIN.inverse_kinematics(given[2], seed=q[0])
        KIN.nearest_reachable_pose(given[2])
        for function, argument in [
            (KIN.forward_kinematics, broken),
            (KIN.get_jacobian, broken),
            (KIN.inverse_kinematics, T),
            (KIN.inverse_kinematics, odd),
            (KIN.inverse_branches, odd),
        ]:
            with pytest.raises(InputError):
                function(argument)

    before = [sys.getrefcount(array) for array in given]
    for _ in range(10):
        use()
    assert [sys.getrefcount(array) for array in given] == before


@pytest.mark.parametrize(
    ("q", "sentence"),
    [
        ([0, 0, 0, 0], r"got \(4,\)"),
        (np.zeros((5, 1)), r"got \(5, 1\)"),
        (0.0, r"got \(\)"),
        ([0, 0, np.nan, 0, 0], "arm_joint_3 is nan"),
        ([[0] * 5, [0, 0, 0, 0, np.inf]], "arm_joint_5 is inf"),
        ("folded", "must be numbers"),
        ([10**400] * 5, "must be numbers"),
        ([[0] * 5, [0] * 4], "must be numbers"),
        (None, r"got \(\)"),
    ],
)
def test_joints_that_are_none_are_refused_with_what_was_found(q, sentence):
    for function in (KIN.forward_kinematics, KIN.get_jacobian, KIN.check_singularity):
        with pytest.raises(InputError, match=sentence):
            function(q)


@pytest.mark.parametrize("number", [-1, 6, 2.5, "3", None])
def test_a_frame_that_the_arm_does_not_have_is_refused(number):
    with pytest.raises(InputError, match="integer 0 to 5"):
        KIN.forward_kinematics(np.zeros(5), up_to_joint=number)


def test_writing_to_a_result_changes_nothing_else():
    q = np.zeros(5)
    KIN.forward_kinematics(q)[:] = 7.0
    KIN.get_jacobian(q)[:] = 7.0
    assert np.abs(KIN.forward_kinematics(q)).max() < 2


def test_a_straight_elbow_is_singular_for_the_pose_and_not_for_the_position():
    assert KIN.check_singularity(elbow_singular()) is True
    assert KIN.check_singularity(elbow_singular(), position_only=True) is False
    assert KIN.smallest_singular_value(elbow_singular()) < 1e-12


def test_a_tool_on_the_axis_is_singular_for_the_position_and_for_the_pose_only_if_vertical():
    tilted, vertical = tool_at(0.0, 0.5, 0.7), tool_at(0.0, 0.55, 0.0)
    assert KIN.check_singularity(tilted, position_only=True)
    assert not KIN.check_singularity(tilted)
    assert KIN.check_singularity(vertical, position_only=True)
    assert KIN.check_singularity(vertical)
    assert KIN.smallest_singular_value(vertical) < 1e-12


def test_the_full_stretch_is_singular_for_the_position():
    # The tool is 2 mm beside joint 5's axis line, so the wrist bends by atan(2 / 185) for it.
    stretch = elbow_singular(wrist=np.deg2rad(102.5) + np.arctan2(0.002, 0.185))
    assert KIN.smallest_singular_value(stretch, position_only=True) < 1e-12
    assert KIN.check_singularity(stretch, position_only=True)


def test_singular_values_are_those_of_the_two_motions_in_and_across_the_plane():
    # In the plane the 3x3 block of joints 2 to 4 has the determinant 0.155 * 0.135 * sin(elbow);
    # across it, the columns of joints 1 and 5 span an area sqrt(r^2 + sin(beta)^2).
    q = random_joints(1000)
    elbow = q[:, 2] + np.deg2rad(146)
    beta = q[:, 1:4].sum(axis=1) + np.deg2rad(-65 + 146 - 102.5)
    radius = np.hypot(*KIN.forward_kinematics(q)[:, :2, 3].T)
    volume = 0.155 * 0.135 * np.abs(np.sin(elbow)) * np.hypot(radius, np.sin(beta))
    assert np.allclose(np.linalg.svd(KIN.get_jacobian(q), compute_uv=False).prod(axis=1), volume)


def test_random_joints_are_not_singular_and_none_at_half_a_degree_from_straight_is_missed():
    assert KIN.check_singularity(random_joints(10_000)).mean() < 0.01
    near = elbow_singular() + np.array([0, 0, np.deg2rad(0.4), 0, 0])
    assert KIN.check_singularity(near)
