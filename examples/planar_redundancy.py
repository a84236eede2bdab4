"""A planar arm with four joints has infinitely many solutions for a pose: draw some, choose one.

    python examples/planar_redundancy.py docs/planar_redundancy.png

Position and direction of the tip are three equations for four joints. The last joint is left free,
on intervals that the joint limits leave of it; each value gives one solution with each elbow.
"""

from __future__ import annotations

import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

from youbot_kinematics.planar import PlanarArm4R
from youbot_kinematics.selection import cost

LIMIT = np.deg2rad([100.0, 125.0, 110.0, 120.0])
ARM = PlanarArm4R(0.30, 0.26, 0.20, 0.12, lower=-LIMIT, upper=LIMIT)
POSE = 0.42, 0.26, np.deg2rad(-30.0)  # m, m, rad
ELBOWS = ("elbow turned left", "elbow turned right")
CRITERIA = {"limits": "tab:red", "singularity": "tab:purple"}
MAPS = plt.cm.Blues, plt.cm.Oranges


def draw_arm(axes, q, **style):
    """One configuration (4,), from the base to the tip, as its links."""
    directions = np.cumsum(q)
    steps = ARM.lengths * np.array([np.cos(directions), np.sin(directions)])
    axes.plot(*np.hstack([np.zeros((2, 1)), np.cumsum(steps, axis=1)]), **style)


def draw_solutions(axes):
    """Solutions from all over each interval, and the best of all by each criterion."""
    for elbow, intervals in enumerate(ARM.theta4_intervals(*POSE)):
        for low, high in intervals:
            for theta4 in np.linspace(low + 1e-6, high - 1e-6, 12):
                shade = 0.3 + 0.6 * (theta4 + LIMIT[3]) / (2 * LIMIT[3])
                for q in ARM.inverse(*POSE, theta4):
                    if (q[1] >= 0) == (elbow == 0):
                        draw_arm(axes, q, color=MAPS[elbow](shade), lw=1)
    for criterion, colour in CRITERIA.items():
        best = ARM.best_solution(*POSE, criterion)
        label = f"farthest from {criterion if criterion == 'limits' else 'singularities'}"
        draw_arm(axes, best, color=colour, lw=3, marker="o", label=label)
    axes.set(title="one pose, infinitely many solutions", xlabel="x (m)", ylabel="y (m)")
    axes.set_aspect("equal")
    axes.legend(loc="lower left")
    axes.set_ylim(-0.26, 0.54)


def draw_costs(axes, elbow):
    """The intervals of the free joint with one elbow, and what each criterion costs there."""
    for number, (low, high) in enumerate(ARM.theta4_intervals(*POSE)[elbow]):
        axes.axvspan(*np.rad2deg([low, high]), color=MAPS[elbow](0.3))
        theta4 = np.linspace(low + 1e-6, high - 1e-6, 300)
        solutions = [
            q for t in theta4 for q in ARM.inverse(*POSE, t) if (q[1] >= 0) == (elbow == 0)
        ]
        for criterion, colour in CRITERIA.items():
            costs = cost(np.array(solutions), criterion, ARM)
            axes.plot(np.rad2deg(theta4), costs, color=colour, label="" if number else criterion)
    axes.set(title=f"cost over joint 4, {ELBOWS[elbow]}", xlabel="joint 4 (degrees)", ylabel="cost")
    axes.set_xlim(*np.rad2deg([-LIMIT[3], LIMIT[3]]))
    axes.legend(loc="center right")


def main():
    path = sys.argv[1] if len(sys.argv) > 1 else "planar_redundancy.png"
    figure, axes = plt.subplot_mosaic("ab;ac", figsize=(11, 6), layout="constrained")
    draw_solutions(axes["a"])
    for elbow, name in enumerate("bc"):
        draw_costs(axes[name], elbow)
    figure.savefig(path, dpi=110)
    print(f"a pose of x, y = {POSE[0]}, {POSE[1]} m and {np.rad2deg(POSE[2]):.0f} degrees:")
    for name, intervals in zip(ELBOWS, ARM.theta4_intervals(*POSE)):
        spans = ", ".join("{:.2f} to {:.2f}".format(*np.rad2deg(span)) for span in intervals)
        print(f"  {name}: joint 4 from {spans or 'nowhere'} degrees")
    print(f"picture: {path}")


if __name__ == "__main__":
    main()
