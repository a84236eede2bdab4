"""Random tours: does each become a trajectory that the arm can run? Beside the coursework's method.

A tour has 1 to 8 targets, random joint positions inside the limits, and starts at another; the
limit profiles alternate. What is planned is judged by ``judge``, which shares no code with it.
"""

from __future__ import annotations

import argparse
import time
from collections import Counter

import coursework
import numpy as np
from bench import shown, table, write
from judge import Judge

from youbot_kinematics import PlanningError, YoubotKinematics, arm
from youbot_kinematics.export import as_dict
from youbot_kinematics.parameters import Parameters
from youbot_kinematics.planner import plan
from youbot_kinematics.resources import resource_path
from youbot_kinematics.targets import Targets

#: What the figures must not pass: rad, fractions of a limit, m.
ALLOWED = {
    "outside": 1e-9,
    "velocity": 1.0 + 1e-9,
    "acceleration": 1.0 + 1e-9,
    "jump": 1.0 + 1e-6,  # a step in a millisecond that the velocity's limit does not explain
    "line": 1e-4,
    "missed": 1e-6,
}


def random_tours(count, seed):
    """Yields the profile of limits, the start (5,) and the targets (n, 5), rad."""
    rng = np.random.default_rng(seed)
    for i in range(count):
        profile = ("urdf", "hardware")[i % 2]
        limits = arm.LIMITS[profile]
        q = rng.uniform(limits.lower, limits.upper, (rng.integers(1, 9) + 1, arm.DOF))
        yield profile, q[0], q[1:]


def ours(judge, profile, start, q, number):
    """The figures of a tour that is planned by the package, or None."""
    targets = Targets.from_joints(q, profile)
    begin = time.perf_counter()
    try:
        planned = plan(targets, start, Parameters(limits=profile))
    except PlanningError as error:
        print(f"tour {number}: {error}", flush=True)
        return None
    took = time.perf_counter() - begin
    figures = judge.figures(as_dict(planned))
    for name, most in ALLOWED.items():
        if figures[name] > most:
            print(f"tour {number}: {name} is {figures[name]:.3g}", flush=True)
    return {**figures, "planning": took, "solver": planned.solver}


def theirs(profile, start, q, num_points):
    """What is wrong with a tour of the coursework's method."""
    limits = arm.LIMITS[profile]
    positions = YoubotKinematics().forward_kinematics(q)[:, :3, 3]
    with np.errstate(all="ignore"):
        try:
            return coursework.judge(*coursework.plan(start, positions, num_points), limits)
        except (np.linalg.LinAlgError, OverflowError, ValueError):  # diverged to infinity
            return {"not_converged": 1, "outside": 1, "jumps": 1}


def histogram(values):
    """``0: 941, 1: 52`` for many zeros and some ones."""
    return ", ".join(f"{value}: {count}" for value, count in sorted(Counter(values).items()))


def show(planned, count, verdicts):
    """Prints what came of ``count`` tours, as far as they were planned, and of the coursework's."""
    worst = {name: max(figures[name] for figures in planned) for name in ALLOWED}
    over = {name: sum(f[name] > most for f in planned) for name, most in ALLOWED.items()}
    usable = sum(map(coursework.is_usable, verdicts))
    rows = [
        ("tours planned", f"{len(planned)} of {count}", f"{usable} of {len(verdicts)}"),
        *(
            (f"tours with {text}", over[key], sum(v[other] > 0 for v in verdicts))
            for text, key, other in (
                ("a joint outside its limits", "outside", "outside"),
                ("a jump", "jump", "jumps"),
                ("a checkpoint or point missed", "missed", "not_converged"),
            )
        ),
        ("tool off its line, at most", f"{worst['line'] * 1000:.4f} mm", "-"),
        ("checkpoint missed, at most", f"{worst['missed'] * 1000:.6f} mm", "-"),
        ("velocity, at most", f"{worst['velocity']:.3%}", "-"),
        ("acceleration, at most", f"{worst['acceleration']:.3%}", "-"),
        ("outside of limits, at most", f"{max(worst['outside'], 0):.1e} rad", "-"),
    ]
    table(("", "youbot_kinematics", "coursework"), rows)
    times = [figures["planning"] for figures in planned]
    for name in ("reconfigurations", "detours", "solver"):
        print(f"{name}: {histogram(f[name] for f in planned)} tours")
    print(f"lines left by detours: {sum(f['detoured'] for f in planned):.3f} m in all")
    print(f"planning: {shown(np.median(times))} median, {shown(max(times))} at most")
    return {"worst": worst, "over": over, "usable_by_coursework": usable}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--count", type=int, default=1000)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--points", type=int, default=10, help="a segment, for the coursework")
    options = parser.parse_args()
    judge = Judge(resource_path("urdf/youbot_arm.urdf"), arm.LIMITS)
    figures, verdicts = [], []
    for number, (profile, start, q) in enumerate(random_tours(options.count, options.seed)):
        figures.append(ours(judge, profile, start, q, number))
        verdicts.append(theirs(profile, start, q, options.points))
    planned = [f for f in figures if f]
    print(f"{options.count} random tours of 1 to 8 targets, seed {options.seed}, judged at 1 kHz")
    summary = show(planned, options.count, verdicts)
    write("tours", {**vars(options), **summary, "tours": figures, "coursework": verdicts})


if __name__ == "__main__":
    main()
