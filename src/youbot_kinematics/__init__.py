"""Kinematics and trajectory planning for the KUKA youBot arm."""

from .arm import JOINT_NAMES, JointLimits, joint_limits
from .exceptions import BagError, InputError, PlanningError, YoubotError
from .kinematics import YoubotKinematics

__all__ = [
    "JOINT_NAMES",
    "BagError",
    "InputError",
    "JointLimits",
    "PlanningError",
    "YoubotError",
    "YoubotKinematics",
    "joint_limits",
]
