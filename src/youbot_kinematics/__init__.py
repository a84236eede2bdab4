"""Kinematics and trajectory planning for the KUKA youBot arm.

What other programs import; planning is in ``youbot_kinematics.planner``.
"""

from importlib import import_module as _import_module

try:
    _import_module(".formulas", __name__)
except ModuleNotFoundError as error:
    raise ImportError(
        f"{error}: it is in C, and not built here; catkin_make builds it, and so does pip install ."
    ) from None

from .arm import JOINT_NAMES, JointLimits, from_upright, joint_limits, to_upright
from .exceptions import BagError, InputError, PlanningError, YoubotError
from .kdl import YoubotKDL
from .kinematics import YoubotKinematics
from .planar import PlanarArm2R, PlanarArm4R

__all__ = [
    "JOINT_NAMES",
    "BagError",
    "InputError",
    "JointLimits",
    "PlanarArm2R",
    "PlanarArm4R",
    "PlanningError",
    "YoubotError",
    "YoubotKDL",
    "YoubotKinematics",
    "from_upright",
    "joint_limits",
    "to_upright",
]
