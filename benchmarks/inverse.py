"""Inverse kinematics beside its peers: success, solutions and time, on the same random poses.

Run it where the peers are installed (``./run bench``); those that are not are left out,
with a line that says so. A pose counts as solved if one of a solver's answers gives it back to
1e-6 with all joints inside the limits.
"""

from __future__ import annotations

import argparse
import time
from importlib import import_module

import numpy as np

from youbot_kinematics import InputError, YoubotKinematics, arm
from youbot_kinematics.kdl import YoubotKDL
from youbot_kinematics.kinematics import dh_frames
from youbot_kinematics.resources import resource_path

KIN = YoubotKinematics()
LIMITS = KIN.limits
URDF = str(resource_path("urdf/youbot_arm.urdf"))
SOLVED = 1e-6
NONE = np.empty((0, arm.DOF))


class Ours:
    name = "youbot_kinematics"
    note = "all solutions, and why there are none"
    solve = staticmethod(KIN.inverse_kinematics)

    @staticmethod
    def solve_batch(T):
        branches = KIN.inverse_branches(T)
        return branches.joints[branches.valid]


class Kdl:
    """KDL's iterative solvers, from a random start inside the limits."""

    def __init__(self, method):
        self.kdl = kdl = import_module("PyKDL")
        self.model = YoubotKDL()  # its chain must outlive the solvers
        chain = self.model._chain
        self.name, self.note = f"KDL {method}", "one solution, from a random start"
        self.rng = np.random.default_rng(1)
        if method == "LMA":
            self.solver = kdl.ChainIkSolverPos_LMA(chain, 1e-8, 500, 1e-15)
        else:
            self.parts = kdl.ChainFkSolverPos_recursive(chain), kdl.ChainIkSolverVel_pinv(chain)
            bounds = self.array(LIMITS.lower), self.array(LIMITS.upper)
            self.solver = kdl.ChainIkSolverPos_NR_JL(chain, *bounds, *self.parts, 500, 1e-7)

    def array(self, q):
        array = self.kdl.JntArray(arm.DOF)
        for i, value in enumerate(q):
            array[i] = value
        return array

    def solve(self, T):
        target = self.kdl.Frame(self.kdl.Rotation(*T[:3, :3].ravel()), self.kdl.Vector(*T[:3, 3]))
        q = self.array(np.zeros(arm.DOF))
        start = self.array(self.rng.uniform(LIMITS.lower, LIMITS.upper))
        self.solver.CartToJnt(start, target, q)
        return np.array([[q[i] for i in range(arm.DOF)]])


class Eaik:
    """EAIK's closed form; it knows no limits, so its angles are wrapped and filtered in NumPy."""

    name, note = "EAIK", "all solutions; wrapped and filtered here"

    def __init__(self):
        robot = import_module("eaik.IK_Homogeneous").HomogeneousRobot
        joints = dh_frames(np.zeros(arm.DOF))
        joints[0] = joints[0] @ np.diag([1.0, -1.0, -1.0, 1.0])  # joint 1 turns about -z
        self.robot = robot(joints)

    def solve(self, T):
        return self.exact(self.robot.IK(T))

    def solve_batch(self, T):
        return [self.exact(answer) for answer in self.robot.IK_batched(T, 1)]

    @staticmethod
    def exact(answer):
        # Where a branch has no solution, EAIK gives the least squares' nearest, and says so.
        return inside_limits(np.asarray(answer.Q)[~np.asarray(answer.is_LS, dtype=bool)])


class EaikBare(Eaik):
    name, note = "EAIK, bare", "angles without limits"

    def solve(self, T):
        return self.robot.IK(T).Q

    def solve_batch(self, T):
        return self.robot.IK_batched(T, 1)


class Optik:
    name, note = "OptIK", "one solution, with restarts"

    def __init__(self):
        optik = import_module("optik")
        # OptIK turns a fixed joint before a turned one the wrong way: begin behind it.
        self.robot = optik.Robot.from_urdf_file(URDF, "arm_link_0", arm.TOOL_FRAME)
        self.robot.set_parallelism(1)
        self.link_0_base = np.eye(4)
        self.link_0_base[:3, 3] = [0.024, 0.0, -0.030]
        self.config = optik.SolverConfig(tol_f=1e-14)
        self.rng = np.random.default_rng(1)

    def solve(self, T):
        start = self.rng.uniform(LIMITS.lower, LIMITS.upper)
        answer = self.robot.ik(self.config, self.link_0_base @ T, start)
        return NONE if answer is None else np.array([answer[0]])


class Toolbox:
    name, note = "roboticstoolbox ik_LM", "one solution, with restarts"

    def __init__(self):
        toolbox = import_module("roboticstoolbox")
        et, self.ets = toolbox.ET, toolbox.ETS()
        table = zip(arm.THETA_0 + arm.OFFSET, arm.SIGN, arm.D, arm.A, arm.ALPHA, *LIMITS[:2])
        for i, (theta, sign, d, a, alpha, low, high) in enumerate(table):
            joint = et.Rz(flip=sign < 0, qlim=[low, high], jindex=i)
            self.ets *= et.Rz(theta) * joint * et.tz(d) * et.tx(a) * et.Rx(alpha)

    def solve(self, T):
        q, success, *_ = self.ets.ik_LM(T, tol=1e-14)
        return q[None] if success else NONE


class Ikpy:
    name, note = "ikpy", "one solution; 100 poses"
    poses = 100

    def __init__(self):
        chain = import_module("ikpy.chain").Chain
        active = [False, False, True, True, True, True, True, False]
        self.chain = chain.from_urdf_file(URDF, ["base_link"], active_links_mask=active)

    def solve(self, T):
        middle = np.zeros(8)
        middle[2:7] = (LIMITS.lower + LIMITS.upper) / 2
        q = self.chain.inverse_kinematics_frame(T, middle, orientation_mode="all")
        return q[None, 2:7]


SOLVERS = [
    Ours,
    lambda: Kdl("LMA"),
    lambda: Kdl("NR_JL"),
    EaikBare,
    Eaik,
    Optik,
    Toolbox,
    Ikpy,
]


def inside_limits(q):
    """Those of some joints (k, 5), rad, that whole turns bring inside the limits."""
    q = np.reshape(q, (-1, arm.DOF))
    wrapped = LIMITS.lower - 1e-9 + np.mod(q - LIMITS.lower + 1e-9, 2 * np.pi)
    return wrapped[LIMITS.contain(wrapped, 1e-9)]


def solutions_of(answers, T):
    """How many of a solver's answers are solutions for a pose."""
    q = inside_limits(answers)
    return int((np.abs(KIN.forward_kinematics(q) - T).max(axis=(1, 2)) < SOLVED).sum())


def measure(solver, T, batch):
    """A row of the table: success, solutions a pose, microseconds a pose single and batched."""
    T = T[: getattr(solver, "poses", len(T))]
    solver.solve(T[0])
    start = time.perf_counter()
    answers = [solver.solve(pose) for pose in T]
    single = (time.perf_counter() - start) / len(T) * 1e6
    counts = np.array([solutions_of(answer, pose) for answer, pose in zip(answers, T)])
    batched = float("nan")
    if hasattr(solver, "solve_batch"):
        start = time.perf_counter()
        solver.solve_batch(batch)
        batched = (time.perf_counter() - start) / len(batch) * 1e6
    return (counts > 0).mean() * 100, counts.mean(), single, batched


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--poses", type=int, default=1000)
    parser.add_argument("--batch", type=int, default=100_000)
    parser.add_argument("--seed", type=int, default=0)
    options = parser.parse_args()
    rng = np.random.default_rng(options.seed)
    q = rng.uniform(LIMITS.lower, LIMITS.upper, (options.batch, arm.DOF))
    batch = KIN.forward_kinematics(q)

    print(f"inverse kinematics of {options.poses} reachable poses, batches of {options.batch}")
    print(f"{'':22} {'solved':>8} {'solutions':>9} {'us single':>10} {'us batched':>10}")
    for make in SOLVERS:
        try:
            solver = make()
        except (ImportError, InputError) as error:
            print(f"left out, not installed: {error}")
            continue
        success, count, single, batched = measure(solver, batch[: options.poses], batch)
        in_batch = "" if np.isnan(batched) else f"{batched:.2f}"
        row = f"{solver.name:22} {success:6.1f} % {count:9.2f} {single:10.1f} {in_batch:>10}"
        print(f"{row}  {solver.note}", flush=True)


if __name__ == "__main__":
    main()
