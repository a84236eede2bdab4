"""Whole plans beside the coursework's method: the course's own bag, and 8, 64 and 512 targets.

The project's plan is timed, checked and inside the limits; the coursework's method only gives
joints, which neither keep limits nor have times. Both have the same number of intermediate points.
Beyond 8 targets its permutations take longer than anyone lives: there it is given our order, free.

The course's bag is not part of the package: name it by ``--bag``, or by YOUBOT_COURSE_BAG.
"""

from __future__ import annotations

import argparse
import os
import time
from pathlib import Path

import coursework
import numpy as np
from bench import OURS, Line, Work, compared, in_turn, report, shown, table
from peers import LIMITS, random_joints

from youbot_kinematics import arm
from youbot_kinematics.parameters import Parameters
from youbot_kinematics.planner import plan
from youbot_kinematics.targets import Targets, load_targets

ROOT = Path(__file__).parents[1]
COURSE_BAG = os.environ.get("YOUBOT_COURSE_BAG") or ROOT.parent / "shared/bags/comp0127_cw2.bag"
STARTS = {"the folded arm": np.zeros(arm.DOF), "mid-range": (LIMITS.lower + LIMITS.upper) / 2}
TIMINGS = "optimal", "cubic"
SIZES = 8, 64, 512
#: Intermediate points a segment, for both: with as many the coursework's steps are those of the
#: trajectory that a controller wants.
PLANNED = Parameters(num_points=50)
PERMUTED = 8  # targets up to which the coursework's permutations are waited for
#: Sizes of tours in the given order, whose lengths grow as their numbers of targets do (a shortest
#: path grows more slowly). There are as many targets of each size: of small tours, several.
GIVEN_SIZES = 8, 32, 128
LINEAR = 1.1  # the exponent of time over length up to which growth counts as linear


def joints_of_coursework(targets, start, order):
    """The coursework's joints and what was found, with permutations or in a given order."""
    positions = targets.poses[:, :3, 3]
    with np.errstate(all="ignore"):
        return coursework.plan(start, positions, PLANNED.num_points, order)


def what_is_wrong(verdict):
    problems = ("not_converged", "outside", "jumps")
    found = [f"{verdict[name]} {name.replace('_', ' ')}" for name in problems if verdict[name]]
    return f"{', '.join(found) or 'nothing wrong'} of {verdict['points']} points"


def measure(name, targets, start, rounds):
    """The line of a whole plan; in its ``more``, how long it is."""
    planned = plan(targets, start, PLANNED)
    order = None if len(targets) <= PERMUTED else planned.order
    verdict = coursework.judge(*joints_of_coursework(targets, start, order), LIMITS)
    works = {
        OURS: Work(lambda _: plan(targets, start, PLANNED), [None]),
        "coursework": Work(lambda _: joints_of_coursework(targets, start, order), [None]),
    }
    line = compared(f"plan, {name}", in_turn(works, rounds, 0.0), 1.0, "faster")
    line.note = f"the coursework's has {what_is_wrong(verdict)}"
    line.more = {
        **size(planned),
        "duration": planned.trajectory.duration,
        "solver": planned.solver,
        "coursework": verdict,
    }
    return line


def size(planned):
    return {
        "targets": len(planned.targets),
        "length": planned.length,
        "waypoints": len(planned.poses),
        "points": len(planned.trajectory.times),
    }


def show_motion(targets):
    """Prints how long the course bag's motion takes: from two starts, with either timing."""
    rows = []
    for name, start in STARTS.items():
        plans = [plan(targets, start, Parameters(timing=timing)) for timing in TIMINGS]
        times = [f"{planned.trajectory.duration:.2f} s" for planned in plans]
        rows.append((name, *times, plans[0].report.reconfigurations, plans[0].solver))
    table(("course bag, from", *TIMINGS, "reconfigurations", "solver"), rows)
    print()


def random_targets(rng, n):
    return Targets.from_joints(random_joints(rng, n))


def growth(rng, start):
    """The line that says how planning grows with the path: tours in the order given."""
    given, rows = Parameters(order="given"), []
    for n in GIVEN_SIZES:
        sizes, times = [], []
        for _ in range(GIVEN_SIZES[-1] // n):
            targets = random_targets(rng, n)
            begin = time.perf_counter()
            sizes.append(size(plan(targets, start, given)))
            times.append(time.perf_counter() - begin)
        means = {key: float(np.mean([s[key] for s in sizes])) for key in sizes[0]}
        rows.append({"time": float(np.mean(times)), **means})
    show_growth("order given", rows)
    exponent = fitted([row["length"] for row in rows], [row["time"] for row in rows])
    return Line(
        "plan, growth with length",
        exponent,
        {},
        f"linear: exponent <= {LINEAR}",
        exponent <= LINEAR,
        unit="",
        note=f"{rows[0]['length']:.1f} to {rows[-1]['length']:.1f} m, in the order given",
        more={"tours": rows},
    )


def fitted(x, y):
    """The exponent of y ~ x^exponent, by least squares of the logarithms."""
    return float(np.polyfit(np.log(x), np.log(y), 1)[0])


def show_growth(name, rows):
    """Prints the time per metre and per waypoint, and how the time grows with each."""
    keys = "length", "waypoints", "points"
    shares = [
        (f"{row['targets']:.0f}", shown(row["time"]), f"{row['length']:.1f} m")
        + tuple(shown(row["time"] / row[key]) for key in keys)
        for row in rows
    ]
    times = [row["time"] for row in rows]
    exponents = [f"{fitted([row[key] for row in rows], times):.2f}" for key in keys]
    header = (f"targets, {name}", "planned in", "length", "a metre", "a waypoint", "a point")
    table(header, [*shares, ("exponent", "", "", *exponents)])
    print()


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--bag", type=Path, default=Path(COURSE_BAG))
    parser.add_argument("--repeats", type=int, default=5, help="fewer for the largest tours")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--sizes", type=int, nargs="+", default=SIZES)
    options = parser.parse_args()
    rng = np.random.default_rng(options.seed)
    rounds, lines = options.repeats, []
    start = STARTS["the folded arm"]
    if options.bag.exists():
        targets = load_targets(options.bag)
        show_motion(targets)
        lines.append(measure("course bag", targets, start, rounds))
    else:
        print(f"{options.bag.name}: left out, there is no such file here (--bag)\n")
    random = [
        measure(f"{n} targets", random_targets(rng, n), start, rounds if n < 100 else 2)
        for n in options.sizes
    ]
    if len(random) > 1:
        show_growth("shortest order", [{"time": line.ours, **line.more} for line in random])
    lines += [*random, growth(rng, start)]
    report("plans", lines, **vars(options))


if __name__ == "__main__":
    main()
