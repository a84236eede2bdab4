"""The planner's parameters: names, defaults, meanings and bounds, defined once.

The node reads them as private ROS parameters, ``plan_bag`` as command-line options, and the checks
here serve both. What only a node needs is added there, in a class of its own.
"""

from __future__ import annotations

import difflib
import math
from dataclasses import dataclass, field, fields

from . import arm
from .exceptions import InputError


def parameter(default, help, *, choices=(), at_least=None, at_most=None):
    """A field with its meaning and bounds, for the checks, the command line and the documents."""
    bounds = {"choices": choices, "at_least": at_least, "at_most": at_most}
    return field(default=default, metadata={"help": help, **bounds})


@dataclass(frozen=True)
class Checked:
    """A set of parameters, each made by ``parameter``, that are checked when they are set.

    Raises:
        InputError: a value of the wrong type, or outside of its bounds.
    """

    def __post_init__(self):
        for f in fields(self):
            object.__setattr__(self, f.name, _checked(f, getattr(self, f.name)))

    @classmethod
    def from_dict(cls, values: dict):
        """Parameters from names and values; what is not named has its default.

        Raises:
            InputError: an unknown name (with the nearest known one), or a bad value.
        """
        known = [f.name for f in fields(cls)]
        for name in values:
            if name not in known:
                near = difflib.get_close_matches(name, known, n=1)
                hint = f"did you mean {near[0]!r}?" if near else f"known: {', '.join(known)}"
                raise InputError(f"unknown parameter {name!r}: {hint}")
        return cls(**values)


@dataclass(frozen=True)
class Parameters(Checked):
    """How to plan. Every value is checked when it is made.

    Raises:
        InputError: a value of the wrong type or outside of its bounds, or two that contradict
            each other.
    """

    topic: str = parameter("", "topic of the targets; needed only if several topics fit")
    start: tuple[float, ...] | None = parameter(
        None, "joint positions where the arm starts, five values, rad"
    )
    order: str = parameter(
        "shortest", "visiting order: the shortest, or the bag's", choices=("shortest", "given")
    )
    return_home: bool = parameter(False, "whether the tour ends where it began")
    num_points: int = parameter(
        10, "intermediate poses between two checkpoints", at_least=0, at_most=10_000
    )
    kinematics: str = parameter(
        "dh", "model that the pseudo-inverse uses: the DH table or KDL", choices=("dh", "kdl")
    )
    solver: str = parameter(
        "auto",
        "inverse kinematics along the path: the pseudo-inverse, the closed form with a search over"
        " the whole path, or the first where it succeeds and else the second",
        choices=("auto", "pseudo_inverse", "closed_form"),
    )
    checkpoint: str = parameter(
        "position",
        "what is met at a target: its position, its whole pose, or the very joints given",
        choices=("position", "pose", "joints"),
    )
    orientation_weight: float = parameter(
        0.0,
        "how closely the closed form follows the slerped orientation between targets: the time, s,"
        " that a radian off along a whole line is worth",
        at_least=0.0,
        at_most=1000.0,
    )
    reconfigure: bool = parameter(
        True, "whether the arm may stop on the way to change its posture, if it must"
    )
    detour: bool = parameter(
        True, "whether the tool may leave a line where the arm cannot follow it"
    )
    limits: str = parameter(
        "urdf", "joint limits: the URDF's, or the real arm's driver's", choices=tuple(arm.LIMITS)
    )
    timing: str = parameter(
        "optimal",
        "time scaling of each segment: time-optimal, or cubic",
        choices=("optimal", "cubic"),
    )
    velocity_scaling: float = parameter(
        1.0, "fraction of the joints' velocity limits to use", at_least=0.01, at_most=1.0
    )
    acceleration: float = parameter(
        3.0, "limit of every joint's acceleration, rad/s^2", at_least=0.01, at_most=1000.0
    )
    dt: float = parameter(
        0.02, "time between two points of the trajectory, s", at_least=0.001, at_most=1.0
    )

    def __post_init__(self):
        super().__post_init__()
        for name, value, other, needed in _CONTRADICTIONS:
            theirs = getattr(self, other)
            if getattr(self, name) == value and theirs != needed:
                raise InputError(
                    f"parameters {name} and {other} contradict each other:"
                    f" {value!r} goes with {needed!r} only, not with {theirs!r}"
                )


# A value of one parameter with which another must have a certain value, or would be ignored.
_CONTRADICTIONS = (
    ("solver", "pseudo_inverse", "checkpoint", "position"),  # it meets no more than positions
    ("solver", "pseudo_inverse", "orientation_weight", 0.0),
    ("solver", "closed_form", "kinematics", "dh"),  # the closed form is that of the DH table
)

_A_KIND = {str: "a text", bool: "true or false", int: "a whole number", float: "a number"}


def _checked(f, value):
    """``value`` as the type of field ``f``, inside of its bounds."""
    if f.name == "start":
        return None if value is None else _checked_start(value)
    kind = type(f.default)
    is_number = isinstance(value, (int, float)) and not isinstance(value, bool)
    if kind is float and is_number:
        value = float(value)
    if not isinstance(value, kind) or isinstance(value, bool) != (kind is bool):
        raise InputError(f"parameter {f.name} must be {_A_KIND[kind]}, not {value!r}")
    rule = f.metadata
    if rule["choices"] and value not in rule["choices"]:
        raise InputError(f"parameter {f.name} must be {_either(rule['choices'])}, not {value!r}")
    if kind in (int, float):
        _check_bounds(f.name, value, rule)
    return value


def _check_bounds(name, value, rule):
    low, high = rule["at_least"], rule["at_most"]
    if not math.isfinite(value):
        raise InputError(f"parameter {name} must be finite, not {value}")
    if low is not None and value < low:
        raise InputError(f"parameter {name} must be at least {low:g}, not {value:g}")
    if high is not None and value > high:
        raise InputError(f"parameter {name} must be at most {high:g}, not {value:g}")


def _checked_start(value) -> tuple[float, ...]:
    try:
        start = tuple(float(x) for x in value)
    except (TypeError, ValueError, OverflowError):
        raise InputError(f"parameter start must be five numbers, rad, not {value!r}") from None
    if len(start) != arm.DOF or not all(map(math.isfinite, start)):
        raise InputError(f"parameter start must be five finite numbers, rad, not {value!r}")
    return start


def _either(choices) -> str:
    return " or ".join(repr(c) for c in choices)
