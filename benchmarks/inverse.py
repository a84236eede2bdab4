"""Inverse kinematics beside its peers: success, solutions and time, on the same random poses.

A pose counts as solved if one of a solver's answers gives it back to 1e-6 with all joints inside
the limits. Only the project and EAIK give all solutions of a pose, and only the project knows the
limits; where EAIK's answers are filtered, they are compared with the project's one by one.
"""

from __future__ import annotations

import argparse
from statistics import median

import numpy as np
from bench import OURS, Work, compared, in_turn, report, shown, table
from peers import INVERSE, KIN, inside_limits, installed, random_joints

SOLVED = 1e-6  # m or 1, in an element of the pose
EAIK = "EAIK + limits"
SLOW = "ikpy", "PyKDL NR_JL"  # milliseconds a pose: judged on a hundred


def solutions_of(answers, T):
    """How many of a solver's answers are solutions for a pose."""
    q = inside_limits(answers)
    return int((np.abs(KIN.forward_kinematics(q) - T).max(axis=(1, 2), initial=0.0) < SOLVED).sum())


def judged(solver, T):
    """How many solutions a solver has for each of some poses."""
    T = T[:100] if solver.name in SLOW else T
    return np.array([solutions_of(solver.solve(pose), pose) for pose in T])


def show(solvers, counts, single, batched):
    rows = []
    for solver in solvers:
        name, found = solver.name, counts[solver.name]
        in_batch = shown(median(batched[name])) if name in batched else ""
        success = f"{(found > 0).mean() * 100:.1f} %"
        times = shown(median(single[name])), in_batch
        rows.append((name, success, f"{found.mean():.2f}", *times, solver.note))
    header = ("random reachable poses", "solved", "solutions", "one", "of a batch", "answers")
    table(header, rows, left=(0, 5))
    print()


def require_same_solutions(counts, n):
    """Ends it where EAIK's solutions inside the limits are not as many as the project's."""
    if EAIK not in counts:
        return
    differ = int((counts[EAIK] != counts[OURS]).sum())
    print(f"{n} poses, of which {differ} have another number of solutions by {EAIK}\n")
    if differ > n / 1000:  # on a limit, or with a straight elbow
        raise SystemExit("nothing is timed")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--poses", type=int, default=1000, help="that are judged")
    parser.add_argument("--batch", type=int, default=100_000)
    parser.add_argument("--seed", type=int, default=0)
    options = parser.parse_args()
    q = random_joints(np.random.default_rng(options.seed), options.batch)
    T = KIN.forward_kinematics(q)
    solvers = installed(INVERSE)
    counts = {solver.name: judged(solver, T[: options.poses]) for solver in solvers}
    require_same_solutions(counts, options.poses)
    solved = bool((counts[OURS] > 0).all())

    one_by_one = list(T[:5000])
    single = in_turn({solver.name: Work(solver.solve, one_by_one) for solver in solvers})
    batches = {s.name: s.solve_batch for s in solvers if hasattr(s, "solve_batch")}
    batched = in_turn({name: Work(solve, [T], len(T)) for name, solve in batches.items()}, rounds=5)
    show(solvers, counts, single, batched)
    everyone = {**single, **batched}  # without an interface for many, one by one
    note = f"{(counts[OURS] > 0).mean():.1%} of {options.poses} poses solved"
    report(
        "inverse",
        [
            compared("IK, one pose", single, 1.0, "faster, and 100 %", solved, note),
            compared(f"IK, {len(T):,} poses", everyone, 0.2, "5 times faster", solved),
        ],
        success={name: float((found > 0).mean()) for name, found in counts.items()},
        **vars(options),
    )


if __name__ == "__main__":
    main()
