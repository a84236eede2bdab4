"""The options of ``plan_bag``: every parameter of the planner, and where the plans go."""

from __future__ import annotations

import argparse
from dataclasses import fields

from . import arm
from .parameters import Parameters

_DESCRIPTION = """\
Plans a trajectory of the youBot arm through the targets in a bag: the shortest tour, on straight
lines of the tool, inside the joint limits. Each trajectory is checked as the controller will run it
before anything is written. Needs no ROS."""

_EPILOG = """\
files:
  .json  everything: points, order, segments, report, targets, parameters; SI units and rad
  .csv   the points, a line each: time_s, then positions, velocities, accelerations of the joints
  .bag   one trajectory_msgs/JointTrajectory, which rosbag play sends to a controller
  -      standard output instead of a file: - or -.json, -.csv, -.bag; the summary goes to standard
         error then
  {bag} and {folder} in a name become the bag's name (without .bag) and its folder's

several bags:
  They are planned in parallel, each in a process of its own: what is wrong with one does not stop
  the others. A table says what became of each. Files of different bags need different names.

exit status:
  0 planned, 1 there is no plan, 2 bad input, 130 interrupted; of several bags the worst

examples:
  plan_bag targets.bag                                     say how the tour would go
  plan_bag targets.bag --start 1 1 -2 1 1                  from where the arm is
  plan_bag targets.bag --output plan.json --plot plan.png  keep it, and look at it
  plan_bag targets.bag --report plan.html                  look at the arm as it moves
  plan_bag targets.bag --output command.bag && rosbag play command.bag
  plan_bag targets.bag --output -.csv | head -n 3
  plan_bag class/*/targets.bag --output 'plans/{folder}.json' --plot 'plans/{folder}.png'"""


def parser() -> argparse.ArgumentParser:
    """The parser of the command's arguments, as ``for_argparse`` gives them."""
    parser = argparse.ArgumentParser(
        prog="plan_bag",
        usage="plan_bag BAG [BAG ...] [OPTION ...]",
        description=_DESCRIPTION,
        epilog=_EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
        allow_abbrev=False,
    )
    add = parser.add_argument
    add("bags", metavar="BAG", nargs="+", help="ROS 1 bag of the targets (or a ROS 2 bag's folder)")
    _add_file_options(parser.add_argument_group("what to write"))
    planning = parser.add_argument_group("how to plan")
    for f in fields(Parameters):
        planning.add_argument("--" + f.name.replace("_", "-"), **_option(f))
    return parser


def _add_file_options(group) -> None:
    repeatable = {"metavar": "FILE", "action": "append", "default": [], "type": str.strip}
    group.add_argument(
        "--output", help="the plan, as the name says: .json, .csv or .bag; repeatable", **repeatable
    )
    group.add_argument(
        "--plot", help="a picture of it, as the name says: .png or .svg; repeatable", **repeatable
    )
    group.add_argument(
        "--report",
        help="one page for a browser, .html: the arm in motion, plots, report; needs no network;"
        " repeatable",
        **repeatable,
    )
    group.add_argument("--force", action="store_true", help="replace files that exist")


def parameters_of(options) -> Parameters:
    """The planner's parameters among the options.

    Raises:
        InputError: one is out of its bounds.
    """
    return Parameters(**{f.name: getattr(options, f.name) for f in fields(Parameters)})


def for_argparse(argv) -> list[str]:
    """The arguments as argparse takes them: ``--num-points`` where ROS has ``--num_points``."""
    arguments = []
    for argument in argv:
        name, equals, value = argument.partition("=")
        if name.startswith("--"):
            argument = name.replace("_", "-") + equals + value
        elif argument.startswith("-.") or (argument.startswith("-") and _is_number(argument)):
            argument = " " + argument  # or argparse takes -1e-3 and -.csv for options
        arguments.append(argument)
    return arguments


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True


def _option(f) -> dict:
    """How argparse shall read a field of ``Parameters``, which checks the value itself."""
    text = f.metadata["help"].replace("%", "%%")
    if f.name == "start":
        names = tuple(f"Q{i + 1}" for i in range(arm.DOF))
        told = f"{text} (default: zeros)"
        return {"nargs": arm.DOF, "type": float, "metavar": names, "help": told}
    shown = f.default if f.default != "" else "none"
    if isinstance(f.default, bool):
        told = f"{text} (default: {str(shown).lower()})"
        return {"type": _truth, "metavar": "BOOL", "default": f.default, "help": told}
    told = f"{text} (default: {shown})"
    option = {"type": type(f.default), "default": f.default, "help": told}
    if f.metadata["choices"]:
        return {**option, "choices": f.metadata["choices"]}
    return {**option, "metavar": type(f.default).__name__.upper()}


def _truth(text: str) -> bool:
    """``true`` or ``false`` as ROS's parameters have them."""
    try:
        return {"true": True, "false": False}[text.lower()]
    except KeyError:
        raise argparse.ArgumentTypeError(f"must be true or false, not {text!r}") from None
