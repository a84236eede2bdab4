"""The command ``plan_bag``: a bag's tour planned without a ROS master, and without ROS at all."""

from __future__ import annotations

import logging
import sys

from .exceptions import YoubotError
from .plan_bags import plan_bags, status_of, table
from .plan_job import KINDS, Job, jobs, plan_job
from .plan_options import for_argparse, parameters_of, parser
from .planner import Plan
from .progress_bar import shown

_INTERRUPTED = 130

_log = logging.getLogger("youbot_kinematics")


def main(argv=None) -> int:
    """Runs the command; results go to standard output, everything else to standard error.

    Args:
        argv: its arguments; those of the process if not given.

    Returns:
        The exit status: 0 planned, 1 no plan, 2 bad input, 130 interrupted.
    """
    logging.basicConfig(format="plan_bag: %(message)s")
    _log.setLevel(logging.INFO)
    options = parser().parse_args(for_argparse(sys.argv[1:] if argv is None else argv))
    try:
        return _run(options)
    except YoubotError as error:
        print(f"plan_bag: {error}", file=sys.stderr)
        return status_of(error)
    except KeyboardInterrupt:
        print("plan_bag: interrupted", file=sys.stderr)
        return _INTERRUPTED


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
        *_about_poses_in_vain(plan.met_in_position_only),
        *(_about(segment) for segment in plan.trajectory.segments if segment.kind != "line"),
    ]


def _about_poses_in_vain(targets) -> list[str]:
    """A line about targets whose orientation the arm cannot take there, if there are any."""
    if not len(targets):
        return []
    numbers = " ".join(str(target + 1) for target in targets)
    return [f"position only       targets {numbers}: the arm cannot take their orientation there"]


def _about(segment) -> str:
    """A line about a segment that follows no line of the tour: when, where and why."""
    a, b = segment.from_checkpoint, segment.to_checkpoint
    where = f"from checkpoint {a} to {b}" if a != b else f"at checkpoint {a}"
    when = f"{segment.start:.2f} s to {segment.end:.2f} s"
    return f"{segment.kind:<19} {when}, {where}: {segment.reason}"


def _run(options) -> int:
    parameters = parameters_of(options)
    names = {kind: getattr(options, kind) for kind in KINDS}
    every = jobs(options.bags, parameters, names, options.force)
    if len(every) == 1:
        _plan_one(every[0])
        status = 0
    else:
        status = _plan_several(every)
    if parameters.start is None:
        _log.warning("no --start given: the arm was taken to start folded, all joints at zero")
    return status


def _plan_one(job: Job) -> None:
    """Plans a bag, and says what came of it: beside standard output, where a plan goes there."""
    with shown(log=_log.info):
        planned = plan_job(job)
    files = [file for file in job.files if not file.is_standard_output]
    lines = summary(planned) + [f"{KINDS[file.kind].label:<19} {file.name}" for file in files]
    print("\n".join(lines), file=sys.stdout if len(files) == len(job.files) else sys.stderr)


def _plan_several(every: list[Job]) -> int:
    """Plans bags in parallel, says what became of each, and returns the worst exit status."""
    with shown(log=_log.info):
        outcomes = plan_bags(every)
    print("\n".join(table(outcomes)))
    return max(outcome.status for outcome in outcomes)
