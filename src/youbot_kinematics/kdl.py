"""The same kinematics from a URDF instead of a table: urdf_parser_py reads it, KDL computes.

An independent reference for ``YoubotKinematics``, and a choice of the planner. KDL and the parser
are imported only when a ``YoubotKDL`` is made.
"""

from __future__ import annotations

from pathlib import Path
from xml.parsers import expat

import numpy as np

from . import arm
from .exceptions import InputError
from .kinematics import Kinematics, as_joint_number, as_joints
from .resources import resource_path

_INSTALL = "on Debian or Ubuntu: apt-get install python3-pykdl, and pip install urdf-parser-py"


class YoubotKDL(Kinematics):
    """Kinematics of the youBot arm from a URDF, computed by KDL.

    Args:
        urdf: path of the URDF; default, the package's own ``urdf/youbot_arm.urdf``. Its chain from
            ``base_link`` to ``arm_link_ee`` must move by ``arm_joint_1`` to ``arm_joint_5``.
        limits: a profile, or a ``JointLimits``; default, the limits that the URDF gives.

    Raises:
        InputError: KDL or the parser is missing, or the URDF is not one of this arm.
    """

    def __init__(self, urdf=None, limits=None):
        path = Path(resource_path("urdf/youbot_arm.urdf") if urdf is None else urdf)
        joints = chain_joints(read_urdf(path), path)
        moving = [joint for joint in joints if joint.type != "fixed"]
        _check_moving(moving, path)
        self.limits = _urdf_limits(moving, path) if limits is None else arm.joint_limits(limits)
        self._build(joints)
        # Not a number, an infinity or an axis of length zero anywhere in the chain ends up here.
        if not np.isfinite(self.get_jacobian(np.zeros(arm.DOF))).all():
            raise InputError(
                f"{path} has an origin or axis that is not finite, or an axis of zeros"
            )

    def _build(self, joints):
        """Makes KDL's chain, and its solvers, of the URDF's joints from base to tool."""
        self._kdl = kdl = _import("PyKDL")
        self._chain = kdl.Chain()
        for joint in joints:
            origin = _kdl_frame(kdl, joint.origin)
            self._chain.addSegment(kdl.Segment(joint.child, _kdl_joint(kdl, joint, origin), origin))
        ends = [i + 1 for i, joint in enumerate(joints) if joint.type != "fixed"]
        self._segments = [0, *ends[:-1], len(joints)]  # for each frame 0 ... 5
        self._position = kdl.ChainFkSolverPos_recursive(self._chain)
        self._velocity = kdl.ChainJntToJacSolver(self._chain)

    def forward_kinematics(self, q, up_to_joint: int = arm.DOF) -> np.ndarray:
        """Pose in ``base_link`` of the link that a joint moves.

        0 is ``base_link`` itself, 1 to 4 are ``arm_link_1`` to ``arm_link_4``, and 5 the tool frame
        ``arm_link_ee``. The URDF puts a link's frame on the joint before it, Denavit-Hartenberg on
        the joint behind it: the two kinematics agree on 0 and on 5, not between.

        Args:
            q: joint positions, (5,) or (..., 5), rad.
            up_to_joint: the joint, 0 to 5.

        Returns:
            Homogeneous transform, (4, 4) or (..., 4, 4), translation in m.

        Raises:
            InputError: q has another shape or is not finite, or there is no such joint.
        """
        q, frame = as_joints(q), self._kdl.Frame()
        segment = self._segments[as_joint_number(up_to_joint)]
        T = np.empty((*q.shape[:-1], 4, 4))
        for index in np.ndindex(q.shape[:-1]):
            self._position.JntToCart(self._joint_array(q[index]), frame, segment)
            T[index] = [[frame[i, j] for j in range(4)] for i in range(3)] + [[0.0, 0.0, 0.0, 1.0]]
        return T

    def get_jacobian(self, q) -> np.ndarray:
        """Geometric Jacobian of the tool, linear over angular velocity, in ``base_link``.

        Args:
            q: joint positions, (5,) or (..., 5), rad.

        Returns:
            (6, 5) or (..., 6, 5): m/rad and rad/rad.

        Raises:
            InputError: q has another shape, or is not finite.
        """
        q, jacobian = as_joints(q), self._kdl.Jacobian(arm.DOF)
        J = np.empty((*q.shape[:-1], 6, arm.DOF))
        for index in np.ndindex(q.shape[:-1]):
            self._velocity.JntToJac(self._joint_array(q[index]), jacobian)
            J[index] = [[jacobian[i, j] for j in range(arm.DOF)] for i in range(6)]
        return J

    def _joint_array(self, q):
        array = self._kdl.JntArray(arm.DOF)
        for i, value in enumerate(q):
            array[i] = value
        return array


def _import(name: str):
    """The module of that name, imported now."""
    try:
        return __import__(name, fromlist=["*"])
    except ImportError as error:
        raise InputError(f"the URDF needs {name} ({_INSTALL}): {error}") from error


def read_urdf(path: Path):
    """The URDF's robot, as urdf_parser_py has it."""
    urdf = _import("urdf_parser_py.urdf")
    try:
        text = path.read_bytes()
    except OSError as error:
        raise InputError(f"cannot read the URDF {path}: {error.strerror}") from error
    _refuse_doctype(text, path)
    try:
        return urdf.URDF.from_xml_string(text)
    except Exception as error:  # the parser raises whatever the text makes it stumble over
        raise InputError(f"{path} is not a valid URDF: {' '.join(str(error).split())}") from error


def _refuse_doctype(text: bytes, path: Path):
    """Only a document type can define entities, which expand without bound or read other files."""

    def refuse(*_):
        raise InputError(f"{path} has a DOCTYPE, which no URDF needs: remove it")

    parser = expat.ParserCreate()
    parser.StartDoctypeDeclHandler = refuse
    try:
        parser.Parse(text, True)
    except expat.ExpatError as error:
        raise InputError(f"{path} is not XML: {error}") from error


def chain_joints(robot, path: Path) -> list:
    """The URDF's joints from the base frame to the tool frame."""
    names: list[str] = []
    link = arm.TOOL_FRAME
    while link != arm.BASE_FRAME:
        # More joints than there are: the links form a ring.
        if link not in robot.parent_map or len(names) > len(robot.joints):
            raise InputError(f"{path} has no chain from {arm.BASE_FRAME} to {arm.TOOL_FRAME}")
        name, link = robot.parent_map[link]
        names.append(name)
    return [robot.joint_map[name] for name in reversed(names)]


def _check_moving(joints: list, path: Path):
    """Refuses a chain that does not move by the arm's five revolute joints, in their order."""
    found = [f"{joint.name} ({joint.type})" for joint in joints]
    if found != [f"{name} (revolute)" for name in arm.JOINT_NAMES]:
        raise InputError(
            f"{path} must move by {', '.join(arm.JOINT_NAMES)}, all revolute, from"
            f" {arm.BASE_FRAME} to {arm.TOOL_FRAME}; it has {', '.join(found) or 'no joint'}"
        )


def _urdf_limits(joints: list, path: Path) -> arm.JointLimits:
    """The limits of the five joints, as the URDF gives them."""
    for joint in joints:
        if joint.limit is None:
            raise InputError(f"{path} gives no limit for {joint.name}")
    fields = arm.JointLimits._fields
    values = [[float(getattr(joint.limit, field) or 0.0) for joint in joints] for field in fields]
    limits = arm.JointLimits(*np.array(values))
    if not (np.isfinite(limits).all() and (limits.lower < limits.upper).all()):
        raise InputError(f"{path} has a joint whose limits are not finite, or leave it no range")
    return limits


def _kdl_frame(kdl, origin):
    """A URDF origin (m, rad; none given is the identity) as a KDL frame."""
    xyz, rpy = (origin.xyz, origin.rpy) if origin else (None, None)
    return kdl.Frame(kdl.Rotation.RPY(*(rpy or [0, 0, 0])), kdl.Vector(*(xyz or [0, 0, 0])))


def _kdl_joint(kdl, joint, origin):
    """A URDF joint as a KDL joint, whose axis is in the parent's frame and not in the child's."""
    if joint.type == "fixed":
        return kdl.Joint(joint.name, kdl.Joint.Fixed)
    axis = kdl.Vector(*(joint.axis or [1, 0, 0]))  # [1, 0, 0] is the URDF's default
    return kdl.Joint(joint.name, origin.p, origin.M * axis, kdl.Joint.RotAxis)
