"""The command ``plan_bag``: a bag's tour planned without a ROS master, and without ROS at all."""

from __future__ import annotations

import argparse
import logging
import sys
from dataclasses import fields

import numpy as np

from . import arm, export, plot
from .exceptions import InputError, YoubotError
from .files import require_writable
from .parameters import Parameters
from .planner import Plan, plan
from .targets import load_targets

_PLANNED, _NO_PLAN, _BAD_INPUT, _INTERRUPTED = 0, 1, 2, 130

_DESCRIPTION = """\
Plans a trajectory of the youBot arm through the targets in a bag: the shortest tour, on straight
lines of the tool, inside the joint limits. Needs no ROS."""

_EPILOG = """\
exit status: 0 planned, 1 there is no plan, 2 bad input

examples:
  plan_bag targets.bag --start 1 1 -2 1 1
  plan_bag targets.bag --output plan.json --output plan.csv --plot plan.png
  plan_bag targets.bag --output command.bag && rosbag play command.bag"""


def main(argv=None) -> int:
    """Runs the command; results go to standard output, everything else to standard error.

    Args:
        argv: its arguments; those of the process if not given.

    Returns:
        The exit status: 0 planned, 1 no plan, 2 bad input, 130 interrupted.
    """
    logging.basicConfig(format="plan_bag: %(levelname)s: %(message)s")
    options = _parser().parse_args(_for_argparse(sys.argv[1:] if argv is None else argv))
    try:
        _run(options)
    except YoubotError as error:
        print(f"plan_bag: {error}", file=sys.stderr)
        return _BAD_INPUT if isinstance(error, InputError) else _NO_PLAN
    except KeyboardInterrupt:
        print("plan_bag: interrupted", file=sys.stderr)
        return _INTERRUPTED
    return _PLANNED


def summary(plan: Plan) -> list[str]:
    """What a person wants to know about a plan, a line each."""
    order = " ".join(str(target + 1) for target in plan.order)
    return [
        f"targets             {len(plan.targets)} from {plan.targets.source}",
        f"visiting order      {order}",
        f"tour                {plan.length:.3f} m",
        f"solver              {plan.solver}: {plan.solver_reason}",
        f"waypoints           {len(plan.poses)}",
        f"trajectory points   {len(plan.trajectory.times)}",
        *plan.report.lines(),
        *(_about(segment) for segment in plan.trajectory.segments if segment.kind != "line"),
    ]


def _about(segment) -> str:
    """A line about a segment that follows no line of the tour: when, where and why."""
    a, b = segment.from_checkpoint, segment.to_checkpoint
    where = f"from checkpoint {a} to {b}" if a != b else f"at checkpoint {a}"
    when = f"{segment.start:.2f} s to {segment.end:.2f} s"
    return f"{segment.kind:<19} {when}, {where}: {segment.reason}"


def _run(options) -> None:
    # What cannot be written is said before any work is done.
    for path in options.output:
        export.writer(path)
        require_writable(path, options.force)
    if options.plot:
        plot.require_plottable(options.plot)
        require_writable(options.plot, options.force)

    parameters = Parameters(**{f.name: getattr(options, f.name) for f in fields(Parameters)})
    targets = load_targets(options.bag, parameters.topic, parameters.limits)
    result = plan(targets, _start(parameters), parameters)
    print("\n".join(summary(result)))
    for path in options.output:
        export.write_plan(path, result, options.force)
        print(f"written             {path}")
    if options.plot:
        plot.plot_plan(result, options.plot, force=options.force)
        print(f"picture             {options.plot}")


def _start(parameters: Parameters):
    if parameters.start is not None:
        return parameters.start
    logging.warning("no --start given: the arm is taken to start folded, all joints at zero")
    return np.zeros(arm.DOF)


def _for_argparse(argv) -> list[str]:
    """The arguments as argparse takes them: ``--num-points`` where ROS has ``--num_points``."""
    arguments = []
    for argument in argv:
        name, equals, value = argument.partition("=")
        if name.startswith("--"):
            argument = name.replace("_", "-") + equals + value
        elif argument.startswith("-") and "e" in argument:
            argument = " " + argument  # or argparse takes -1e-3 for an option
        arguments.append(argument)
    return arguments


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="plan_bag",
        description=_DESCRIPTION,
        epilog=_EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
        allow_abbrev=False,
    )
    add = parser.add_argument
    add("bag", metavar="BAG", help="ROS 1 bag of the targets (or a ROS 2 bag's folder)")
    add(
        "--output",
        metavar="FILE",
        action="append",
        default=[],
        help="write the plan, as its name says: .json, .csv, or .bag for a controller; repeatable",
    )
    add("--plot", metavar="FILE", help="draw the plan, as its name says: .png or .svg")
    add("--force", action="store_true", help="replace files that exist")
    planning = parser.add_argument_group("how to plan")
    for f in fields(Parameters):
        planning.add_argument("--" + f.name.replace("_", "-"), **_option(f))
    return parser


def _option(f) -> dict:
    """How argparse shall read a field of ``Parameters``, which checks the value itself."""
    text = f.metadata["help"].replace("%", "%%")
    if f.name == "start":
        names = tuple(f"Q{i + 1}" for i in range(arm.DOF))
        return {
            "nargs": arm.DOF,
            "type": float,
            "metavar": names,
            "help": f"{text} (default: zeros)",
        }
    if isinstance(f.default, bool):
        shown = str(f.default).lower()
        return {
            "type": _truth,
            "metavar": "BOOL",
            "default": f.default,
            "help": f"{text} (default: {shown})",
        }
    shown = f.default if f.default != "" else "none"
    option = {"type": type(f.default), "default": f.default, "help": f"{text} (default: {shown})"}
    if f.metadata["choices"]:
        return {**option, "choices": f.metadata["choices"]}
    return {**option, "metavar": type(f.default).__name__.upper()}


def _truth(text: str) -> bool:
    """``true`` or ``false`` as ROS's parameters have them."""
    try:
        return {"true": True, "false": False}[text.lower()]
    except KeyError:
        raise argparse.ArgumentTypeError(f"must be true or false, not {text!r}") from None
