"""The other kinematics libraries, with the arm from the package's URDF, as their users use them.

A peer takes and gives NumPy arrays: ``forward`` joints (5,) -> pose (4, 4) of arm_link_ee in
base_link, ``jacobian`` joints -> (6, 5), ``solve`` pose -> joints (k, 5), whatever their limits;
``..._batch`` where it has an interface for many. Making a peer that is not installed raises
ImportError. Its joint limits are the project's ``urdf`` profile.
"""

from __future__ import annotations

from importlib import import_module

import numpy as np
from bench import OURS
from urdf_chain import kdl_chain, urdf_chain

from youbot_kinematics import YoubotKinematics, arm
from youbot_kinematics.resources import resource_path

KIN = YoubotKinematics()
LIMITS = KIN.limits
URDF = str(resource_path("urdf/youbot_arm.urdf"))
NONE = np.empty((0, arm.DOF))
_MIDDLE = (LIMITS.lower + LIMITS.upper) / 2


def random_joints(rng, n):
    """Joints (n, 5) inside the limits, rad."""
    return rng.uniform(LIMITS.lower, LIMITS.upper, (n, arm.DOF))


def inside_limits(q):
    """Those of some joints (k, 5), rad, that whole turns bring inside the limits."""
    q = np.reshape(q, (-1, arm.DOF))
    wrapped = LIMITS.lower - 1e-9 + np.mod(q - LIMITS.lower + 1e-9, 2 * np.pi)
    within = (wrapped >= LIMITS.lower - 1e-9) & (wrapped <= LIMITS.upper + 1e-9)
    return wrapped[within.all(axis=-1)]


def looped(function, shape):
    """A function of one as a function of many, by a loop."""

    def loop(inputs):
        results = np.empty((len(inputs), *shape))
        for i, value in enumerate(inputs):
            results[i] = function(value)
        return results

    return loop


class Ours:
    name, note = OURS, "all solutions, and why there are none"
    forward = forward_batch = staticmethod(KIN.forward_kinematics)
    jacobian = jacobian_batch = staticmethod(KIN.get_jacobian)
    solve = staticmethod(KIN.inverse_kinematics)
    solve_batch = staticmethod(KIN.inverse_branches)


class Pinocchio:
    """pinocchio (PyPI's pin); its inverse is the Newton method of its own example, in a loop."""

    name, note = "pinocchio", "one solution, Newton in a loop from a random start"

    def __init__(self):
        self.pin = pin = import_module("pinocchio")
        self.model = model = pin.buildModelFromUrdf(URDF)
        self.data = data = model.createData()
        self.frame = frame = model.getFrameId(arm.TOOL_FRAME)
        self.rng = np.random.default_rng(1)
        axes, compute = pin.ReferenceFrame.LOCAL_WORLD_ALIGNED, pin.computeFrameJacobian
        update, place = pin.forwardKinematics, pin.updateFramePlacement

        def forward(q):
            update(model, data, q)
            return place(model, data, frame).homogeneous

        def jacobian(q):
            return compute(model, data, q, frame, axes)

        self.forward, self.jacobian = forward, jacobian

    def solve(self, T):
        pin, model, data, frame = self.pin, self.model, self.data, self.frame
        target = pin.SE3(T[:3, :3], T[:3, 3])
        q = self.rng.uniform(LIMITS.lower, LIMITS.upper)
        for _ in range(200):
            pin.forwardKinematics(model, data, q)
            here = pin.updateFramePlacement(model, data, frame)
            error = pin.log(here.actInv(target)).vector
            if error @ error < 1e-16:
                return q[None]
            J = pin.computeFrameJacobian(model, data, q, frame)
            q = q + np.linalg.solve(J.T @ J + 1e-9 * np.eye(arm.DOF), J.T @ error)
        return NONE


class Kdl:
    """Orocos KDL by PyKDL; inverse by LMA, or by NR_JL, Newton-Raphson with joint limits."""

    def __init__(self, method=""):
        self.kdl = kdl = import_module("PyKDL")
        self.name = f"PyKDL {method}".strip()
        self.note = "one solution, from a random start"
        self.chain = chain = kdl_chain(URDF)  # must outlive the solvers
        self.rng = np.random.default_rng(1)
        self.fk, self.jac = kdl.ChainFkSolverPos_recursive(chain), kdl.ChainJntToJacSolver(chain)
        self.q, self.frame, self.J = kdl.JntArray(arm.DOF), kdl.Frame(), kdl.Jacobian(arm.DOF)
        if method == "LMA":
            self.solver = kdl.ChainIkSolverPos_LMA(chain, 1e-8, 500, 1e-15)
        if method == "NR_JL":
            self.velocity = kdl.ChainIkSolverVel_pinv(chain)
            bounds = self.array(LIMITS.lower), self.array(LIMITS.upper)
            parts = self.fk, self.velocity
            self.solver = kdl.ChainIkSolverPos_NR_JL(chain, *bounds, *parts, 500, 1e-7)

    def array(self, q):
        return self.fill(self.kdl.JntArray(arm.DOF), q)

    @staticmethod
    def fill(array, q):
        array[0], array[1], array[2], array[3], array[4] = q.tolist()
        return array

    def forward(self, q):
        frame = self.frame
        self.fk.JntToCart(self.fill(self.q, q), frame)
        M, p = frame.M, frame.p
        return np.array(
            [
                [M[0, 0], M[0, 1], M[0, 2], p[0]],
                [M[1, 0], M[1, 1], M[1, 2], p[1]],
                [M[2, 0], M[2, 1], M[2, 2], p[2]],
                [0.0, 0.0, 0.0, 1.0],
            ]
        )

    def jacobian(self, q):
        J = self.J
        self.jac.JntToJac(self.fill(self.q, q), J)
        return np.array([[J[i, j] for j in range(arm.DOF)] for i in range(6)])

    def solve(self, T):
        kdl = self.kdl
        target = kdl.Frame(kdl.Rotation(*T[:3, :3].ravel()), kdl.Vector(*T[:3, 3]))
        q = self.array(np.zeros(arm.DOF))
        start = self.array(self.rng.uniform(LIMITS.lower, LIMITS.upper))
        self.solver.CartToJnt(start, target, q)
        return np.array([[q[i] for i in range(arm.DOF)]])


class Toolbox:
    """Peter Corke's toolbox: its elementary transforms, which it computes in C."""

    name, note = "roboticstoolbox", "one solution, ik_LM with restarts"

    def __init__(self):
        ets, se3 = import_module("roboticstoolbox"), import_module("spatialmath").SE3
        et, chain = ets.ET, ets.ETS()
        for joint in urdf_chain(URDF):
            chain *= et.SE3(se3(joint.xyz) * se3.RPY(joint.rpy, order="zyx"))
            if not joint.fixed:
                i = int(np.argmax(np.abs(joint.axis)))
                turn = (et.Rx, et.Ry, et.Rz)[i]
                chain *= turn(flip=joint.axis[i] < 0, jindex=chain.n)
        self.ets = chain.compile()
        self.ets.qlim = np.array([LIMITS.lower, LIMITS.upper])
        self.forward = self.forward_batch = self.ets.eval
        self.jacobian = self.ets.jacob0

    def solve(self, T):
        q, success, *_ = self.ets.ik_LM(T, tol=1e-14)
        return q[None] if success else NONE


class Ikpy:
    """ikpy; it has no Jacobian."""

    name, note = "ikpy", "one solution, from the middle of the limits"

    def __init__(self):
        chain = import_module("ikpy.chain").Chain
        active = [False, False, True, True, True, True, True, False]
        self.chain = chain.from_urdf_file(URDF, ["base_link"], active_links_mask=active)

    @staticmethod
    def full(q):
        full = np.zeros(8)
        full[2:7] = q
        return full

    def forward(self, q):
        return self.chain.forward_kinematics(self.full(q))

    def solve(self, T):
        start = self.full(_MIDDLE)
        q = self.chain.inverse_kinematics_frame(T, start, orientation_mode="all")
        return q[None, 2:7]


class EaikBare:
    """EAIK's closed form, which knows no limits."""

    name, note = "EAIK", "all solutions, without limits"

    def __init__(self):
        robot = import_module("eaik.IK_Homogeneous").HomogeneousRobot
        frames = [KIN.forward_kinematics(np.zeros(arm.DOF), i) for i in range(arm.DOF + 1)]
        frames[0] = frames[0] @ np.diag([1.0, -1.0, -1.0, 1.0])  # joint 1 turns about -z
        self.robot = robot(np.array(frames))
        self.forward = self.robot.fwdKin

    def solve(self, T):
        return self.robot.IK(T).Q

    def solve_batch(self, T):
        return self.robot.IK_batched(T, 1)


class Eaik(EaikBare):
    """EAIK with what makes its answers comparable: wrapped, and filtered by the limits."""

    name, note = "EAIK + limits", "all solutions, wrapped and filtered in NumPy"
    forward = None

    def __init__(self):
        super().__init__()
        del self.forward  # that is EaikBare's

    def solve(self, T):
        return inside_limits(self._exact(self.robot.IK(T)))

    def solve_batch(self, T):
        answers = [self._exact(answer) for answer in self.robot.IK_batched(T, 1)]
        return inside_limits(np.concatenate(answers))

    @staticmethod
    def _exact(answer):
        # Where a branch has no solution, EAIK gives the least squares' nearest, and says so.
        return np.asarray(answer.Q)[~np.asarray(answer.is_LS, dtype=bool)]


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


FORWARD = (Ours, Pinocchio, EaikBare, Toolbox, Kdl, Ikpy)
INVERSE = (
    Ours,
    EaikBare,
    Eaik,
    Pinocchio,
    Optik,
    Toolbox,
    lambda: Kdl("LMA"),
    lambda: Kdl("NR_JL"),
    Ikpy,
)


def installed(makers):
    """Those of the peers that are there; a line for each other."""
    peers = []
    for make in makers:
        try:
            peers.append(make())
        except ImportError as error:
            print(f"left out, not installed: {error}")
    return peers
