"""The course's own bag and the bundled one: planning time and duration of the motion.

The course's bag is not part of the package: name it by ``--bag``, or by YOUBOT_COURSE_BAG.
"""

from __future__ import annotations

import argparse
import os
from pathlib import Path

import coursework
import numpy as np
from bench import duration, seconds, table, write

from youbot_kinematics import PlanningError, arm
from youbot_kinematics.parameters import Parameters
from youbot_kinematics.planner import plan
from youbot_kinematics.targets import load_targets

ROOT = Path(__file__).parents[1]
COURSE_BAG = os.environ.get("YOUBOT_COURSE_BAG") or ROOT.parent / "shared/bags/comp0127_cw2.bag"
LIMITS = arm.LIMITS["urdf"]
STARTS = {"zeros": np.zeros(arm.DOF), "mid-range": (LIMITS.lower + LIMITS.upper) / 2}


def ours(targets, start, timing, repeats):
    """The planning time (s) and the plan, or None and why there is none."""
    parameters = Parameters(timing=timing)
    try:
        return seconds(lambda: plan(targets, start, parameters), repeats)
    except PlanningError as error:
        return None, error


def theirs(targets, start, num_points, repeats):
    """The planning time (s) of the coursework's method, and what is wrong with its joints."""
    positions = targets.poses[:, :3, 3]
    with np.errstate(all="ignore"):
        took, answer = seconds(lambda: coursework.plan(start, positions, num_points), repeats)
    return took, coursework.judge(*answer, LIMITS)


def what_is_wrong(verdict):
    problems = ("not_converged", "outside", "jumps")
    found = [f"{verdict[name]} {name.replace('_', ' ')}" for name in problems if verdict[name]]
    return f"{', '.join(found) or 'nothing wrong'} of {verdict['points']} points"


def compare(bag, options):
    """The rows of a bag: one for each start."""
    targets, rows, results = load_targets(bag), [], {}
    for name, start in STARTS.items():
        timings = {t: ours(targets, start, t, options.repeats) for t in ("optimal", "cubic")}
        their_time, verdict = theirs(targets, start, options.points, options.repeats)
        _, sparse = theirs(targets, start, 10, 1)
        our_time, planned = timings["optimal"]
        lasts = [
            "none" if took is None else f"{made.trajectory.duration:.2f} s"
            for took, made in timings.values()
        ]
        ratio = "" if our_time is None else f"{our_time / their_time:.2f}"
        shown = "none" if our_time is None else duration(our_time)
        rows.append((name, *lasts, shown, duration(their_time), ratio))
        results[name] = {
            "planning": our_time,
            "report": getattr(planned, "report", None) and planned.report.as_dict(),
            "durations": dict(zip(timings, lasts)),
            "coursework_planning": their_time,
            "coursework": {options.points: verdict, 10: sparse},
        }
        print(f"from {name}: {getattr(planned, 'solver', planned)}")
        print(f"  coursework, {options.points:2} points a segment: {what_is_wrong(verdict)}")
        print(f"  coursework, 10 points a segment: {what_is_wrong(sparse)}")
    return rows, results


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--bag", type=Path, default=Path(COURSE_BAG))
    parser.add_argument("--points", type=int, default=50, help="a segment, for the coursework")
    parser.add_argument("--repeats", type=int, default=5)
    options = parser.parse_args()
    header = ("from", "optimal", "cubic", "planned in", "coursework", "ours by it")
    results = {}
    for bag in (options.bag, ROOT / "bags/demo.bag"):
        if not bag.exists():
            print(f"{bag.name}: left out, there is no such file here (--bag)\n")
            continue
        print(f"{bag.name}: duration of the motion; planning with optimal timing beside the")
        print("coursework's method, which neither keeps limits nor gives times")
        rows, results[bag.name] = compare(bag, options)
        table(header, rows)
        print()
    write("course_bag", results)


if __name__ == "__main__":
    main()
