"""A plan in lines of text, for a terminal or a log."""

from __future__ import annotations

from .planner import Plan


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
