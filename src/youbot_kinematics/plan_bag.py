"""The command ``plan_bag``: a bag's tour planned without a ROS master, and without ROS at all."""

from __future__ import annotations

import logging
import sys

from .exceptions import YoubotError
from .plan_bags import plan_bags, status_of, table
from .plan_job import KINDS, Job, jobs, plan_job
from .plan_options import for_argparse, parameters_of, parser
from .progress_bar import shown
from .summary import summary

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
