"""What the closed form promises, counted on many random poses.

A million reachable poses and a hundred thousand that are not, each judged by forward kinematics or
by how the pose was made; the nearest reachable pose beside a numerical optimiser; and, where EAIK
is installed, the same set of solutions from an independent closed form.
"""

from __future__ import annotations

import argparse

import numpy as np
from peers import KIN, LIMITS, Eaik, random_joints
from scipy.optimize import minimize
from scipy.spatial.transform import Rotation

CHUNK = 100_000


def reachable(rng, n):
    """Solves poses of random joints, and compares the answers with these and with the poses."""
    solved, pose_error, joint_error, count = 0, 0.0, 0.0, 0
    for _ in range(0, n, CHUNK):
        q = random_joints(rng, min(CHUNK, n))
        T = KIN.forward_kinematics(q)
        branches = KIN.inverse_branches(T)
        assert np.isfinite(branches.joints[branches.valid]).all()
        assert LIMITS.contain(branches.joints[branches.valid]).all()
        i, _ = np.nonzero(branches.valid)
        reached = KIN.forward_kinematics(branches.joints[branches.valid])
        off = np.where(branches.valid, np.abs(branches.joints - q[:, None]).max(axis=-1), np.inf)
        solved += int(branches.valid.any(axis=1).sum())
        count += len(i)
        pose_error = max(pose_error, np.abs(reached - T[i]).max())
        joint_error = max(joint_error, off.min(axis=1).max())
    print(f"{n} reachable poses: {solved / n:.4%} solved, {count / n:.3f} solutions a pose")
    print(
        f"  largest pose error {pose_error:.1e} m or 1, generating joints within {joint_error:.1e}"
    )


def poses_in_plane(rng, n):
    """Poses that a planar arm of any length could have: azimuth, reach, height, pitch, roll."""
    phi, pitch, roll = rng.uniform(-np.pi, np.pi, (3, n))
    r, z = rng.uniform(0.0, 1.0, n), rng.uniform(-0.6, 1.0, n)
    T = np.tile(np.eye(4), (n, 1, 1))
    T[:, :3, :3] = Rotation.from_euler("ZYZ", np.stack([phi, pitch, roll], axis=-1)).as_matrix()
    T[:, :3, 3] = np.stack([r * np.cos(phi), r * np.sin(phi), z], axis=-1)
    return T


def wrist_is_out_of_reach(T):
    """Whether the wrist is farther from the shoulder than the arm is long, facing either way."""
    wrist = T[:, :3, 3] + T[:, :3, :3] @ np.array([0.0, 0.0, -0.185])  # 2 mm beside it at most
    out = wrist[:, 2] - 0.145
    aside = np.hypot(wrist[:, 0], wrist[:, 1])
    far = [np.hypot(aside + side * 0.033, out) > 0.155 + 0.135 + 0.0021 for side in (1, -1)]
    return far[0] & far[1]


def unreachable(rng, n):
    """Asks for poses that cannot be reached, by how they were made, and looks for the reasons."""
    tilted = poses_in_plane(rng, n // 2)
    turn = rng.uniform(1e-6, 0.5, n // 2)
    facing = np.arctan2(tilted[:, 1, 3], tilted[:, 0, 3])
    across = np.stack([-np.sin(facing), np.cos(facing), 0 * facing], axis=-1)
    out_of_plane = np.cross(tilted[:, :3, 2], across)
    tilt = Rotation.from_rotvec(turn[:, None] * out_of_plane)
    tilted[:, :3, :3] = tilt.as_matrix() @ tilted[:, :3, :3]
    far = poses_in_plane(rng, 4 * n)
    far = far[wrist_is_out_of_reach(far)][: n - n // 2]
    T = np.concatenate([tilted, far])
    branches = KIN.inverse_branches(T)
    reason = (
        (branches.out_of_reach != 0)
        | (branches.limit_excess != 0).any(axis=-1)
        | (branches.tilt > 1e-9)
    )
    assert not any(np.isnan(field).any() for field in branches[2:])
    print(f"{len(T)} unreachable poses: {branches.valid.any(axis=1).sum()} claimed solved,")
    print(f"  {reason.all(axis=1).mean():.4%} with a reason for each branch")


def nearest(rng, n):
    """The nearest pose's position beside the best of five runs of a numerical optimiser."""
    bounds = list(zip(*LIMITS[:2]))
    gain, unreached = 0.0, 0
    for _ in range(n):
        T = np.eye(4)
        T[:3, :3] = Rotation.from_quat(rng.normal(size=4)).as_matrix()
        T[:3, 3] = rng.uniform([-0.7, -0.7, -0.5], [0.7, 0.7, 1.0])
        answer = KIN.nearest_reachable_pose(T)
        assert len(answer.solutions) and LIMITS.contain(answer.solutions).all()
        reached = KIN.forward_kinematics(answer.solutions)
        assert np.abs(reached - answer.pose).max() < 1e-9
        if answer.position_error == 0:
            continue
        unreached += 1
        for start in random_joints(rng, 5):
            found = minimize(squared_distance, start, (T[:3, 3],), jac=True, bounds=bounds)
            gain = max(gain, answer.position_error - np.sqrt(found.fun))
    print(f"{n} nearest poses, {unreached} of them at another position than asked for:")
    print(f"  an optimiser came nearer by {gain:.1e} m at most")


def squared_distance(q, p):
    off = KIN.forward_kinematics(q)[:3, 3] - p
    return off @ off, 2 * KIN.get_jacobian(q)[:3].T @ off


def same_as_eaik(rng, n):
    """Compares the solutions with those of EAIK, one by one in both directions."""
    try:
        eaik = Eaik()
    except ImportError as error:
        print(f"EAIK left out, not installed: {error}")
        return
    differing, count = 0, 0
    for T in KIN.forward_kinematics(random_joints(rng, n)):
        ours, theirs = KIN.inverse_kinematics(T), eaik.solve(T)
        apart = np.abs(ours[:, None] - theirs).max(axis=-1, initial=0.0)
        same = len(ours) and len(theirs) and max(apart.min(0).max(), apart.min(1).max()) < 1e-5
        differing += not same
        count += len(ours)
    print(f"{n} poses beside EAIK: {count} solutions, {differing} poses with another set of them")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--scale", type=float, default=1.0, help="of the numbers of poses")
    options = parser.parse_args()
    rng = np.random.default_rng(options.seed)
    for figure, n in [
        (reachable, 1_000_000),
        (unreachable, 100_000),
        (nearest, 2_000),
        (same_as_eaik, 10_000),
    ]:
        figure(rng, max(int(n * options.scale), 10))


if __name__ == "__main__":
    main()
