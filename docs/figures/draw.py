"""Draws the figures of the mathematics with the package's own functions, beside this file.

    python docs/figures/draw.py [FOLDER]
"""

from __future__ import annotations

import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from scipy.spatial.transform import Rotation

from youbot_kinematics import YoubotKinematics, arm, joint_limits
from youbot_kinematics.colours import BLACK, BLUE, GREEN, GREY, ORANGE, SHADE, VERMILLION
from youbot_kinematics.inverse import BRANCH_NAMES, FOREARM, SHOULDER_R, SHOULDER_Z, UPPER_ARM
from youbot_kinematics.kinematics import dh_frames
from youbot_kinematics.timing import RATES, time_path
from youbot_kinematics.trajectory import JointPath

DEGREE = np.pi / 180
KIN = YoubotKinematics()
LIMITS = joint_limits("urdf")
BRANCH_COLOURS = (BLUE, ORANGE, GREEN, VERMILLION)


def in_plane(q) -> np.ndarray:
    """Joint 1's axis, shoulder, elbow, wrist and tool as (r, z) in m, (2, 5)."""
    points = dh_frames(np.asarray(q))[:, :3, 3]
    phi = arm.OFFSET[0] - q[0]
    r = points[:, 0] * np.cos(phi) + points[:, 1] * np.sin(phi)
    return np.array([r, points[:, 2]])[:, [0, 1, 2, 3, 5]]


def angle_from_vertical(axes, corner, angle, name, radius=0.06) -> None:
    """An arc at a corner from the vertical to an angle, with its name."""
    around = np.linspace(0, angle, 30)
    x, z = corner
    axes.plot([x, x], [z, z + 1.4 * radius], color=GREY, lw=0.8, ls="--")
    axes.plot(x + radius * np.sin(around), z + radius * np.cos(around), color=BLACK, lw=1)
    half = angle / 2
    axes.text(x + 1.35 * radius * np.sin(half), z + 1.35 * radius * np.cos(half), name, ha="center")


def draw_angles():
    """The lengths and angles of the closed form, and the four solutions of a position."""
    figure, (left, right) = plt.subplots(1, 2, figsize=(10, 4.6), layout="constrained")
    q = np.array([2.0, 95 * DEGREE, -88 * DEGREE, 130 * DEGREE, 2.0])
    t2 = q[1] - 65 * DEGREE
    t23 = t2 + q[2] + 146 * DEGREE
    beta = t23 + q[3] - 102.5 * DEGREE
    left.plot(*in_plane(q), marker="o", markersize=4, lw=2.5, color=BLUE)
    shoulder = np.array([SHOULDER_R, SHOULDER_Z])
    elbow = shoulder + UPPER_ARM * np.array([np.sin(t2), np.cos(t2)])
    wrist = elbow + FOREARM * np.array([np.sin(t23), np.cos(t23)])
    for corner, angle, name in ((shoulder, t2, "$t_2$"), (elbow, t23, "$t_{23}$")):
        angle_from_vertical(left, corner, angle, name)
    angle_from_vertical(left, wrist, beta, r"$\beta$", 0.05)
    left.axvline(0, color=GREY, lw=1, ls="-.")
    left.text(0.004, 0.35, "joint 1's axis", color=GREY)
    left.set(title="the arm's plane: angles from the vertical")

    named: set = set()
    for q in KIN.inverse_position([0.26, 0.0, 0.4]).solutions:
        branch = branch_of(q)
        forward = np.sign(np.cos(arm.OFFSET[0] - q[0]))  # over the back the plane is turned round
        r, z = in_plane(q)
        name = BRANCH_NAMES[branch] if branch not in named else None
        named.add(branch)
        style = {"color": BRANCH_COLOURS[branch], "label": name}
        right.plot(forward * r, z, marker="o", markersize=4, lw=2.5, **style)
    right.axvline(0, color=GREY, lw=1, ls="-.")
    right.legend(loc="lower right", fontsize="small")
    right.set(title="solutions of one position, each with a pitch of its own")
    for axes in (left, right):
        axes.set_aspect("equal")
        axes.set(xlabel="reach r (m)", ylabel="height z (m)")
    return figure


def branch_of(q) -> int:
    """The number of the branch that a configuration is on."""
    back = in_plane(q)[0, -1] < 0
    return 2 * int(back) + int(q[2] + 146 * DEGREE < 0)


def draw_nearest():
    """The angle to a wanted orientation over pitch and roll, and its least by singular vectors."""
    wanted = Rotation.from_euler("zyz", [25, 70, 40], degrees=True)
    x, y, z, w = wanted.as_quat()
    M = np.array([[w, z], [y, x]])
    beta, gamma = np.meshgrid(np.linspace(-180, 180, 121), np.linspace(-180, 180, 121))
    u, v = (np.array([np.cos(a / 2 * DEGREE), np.sin(a / 2 * DEGREE)]) for a in (beta, gamma))
    angle = 2 * np.arccos(np.minimum(np.abs(np.einsum("iab,ij,jab->ab", u, M, v)), 1)) / DEGREE

    figure, axes = plt.subplots(figsize=(6, 4.8), layout="constrained")
    lines = axes.contour(beta, gamma, angle, levels=np.arange(20, 181, 20), cmap="cividis")
    axes.clabel(lines, fmt="%d°")
    U, S, Vt = np.linalg.svd(M)
    best = [2 * np.arctan2(s[1], s[0]) / DEGREE for s in (U[:, 0], Vt[0])]
    best = [(b + 180) % 360 - 180 for b in best]
    axes.plot(*best, "o", color=VERMILLION)
    least = 2 * np.arccos(min(S[0], 1)) / DEGREE
    axes.annotate(f"{least:.1f}°", best, xytext=(-12, -16), textcoords="offset points")
    axes.set(xlabel=r"pitch $\beta$ (degrees)", ylabel=r"roll $\gamma$ (degrees)")
    axes.set(title="angle to an orientation that is out of the arm's plane")
    return figure


def draw_axis():
    """What joint 1 does while the tool passes its axis on straight lines."""
    figure, (left, right) = plt.subplots(1, 2, figsize=(10, 4.2), layout="constrained")
    x = np.linspace(-0.15, 0.15, 2001)
    for distance, colour in ((0.05, BLUE), (0.02, GREEN), (0.006, VERMILLION)):
        label = f"{distance * 1000:.0f} mm from the axis"
        left.plot(x, np.full_like(x, distance), color=colour)
        q1 = np.unwrap(arm.OFFSET[0] - np.arctan2(distance, x)) / DEGREE
        right.plot(x, q1 - q1[0] + 20, color=colour, label=label)
    gap = np.linspace(LIMITS.upper[0], LIMITS.lower[0] + 2 * np.pi, 30)
    corner = 0.15 * np.array([np.cos(arm.OFFSET[0] - gap), np.sin(arm.OFFSET[0] - gap)])
    left.fill(*np.hstack([[[0], [0]], corner]), color=SHADE)
    left.text(-0.145, -0.012, "joint 1's gap", color=GREY, fontsize="small")
    left.plot(0, 0, "+", color=BLACK, markersize=12)
    left.set_aspect("equal")
    left.set(xlabel="x (m)", ylabel="y (m)", title="three lines past joint 1's axis, from above")
    left.set_ylim(-0.08, 0.1)
    right.set(xlabel="x along the line (m)", ylabel="joint 1, from where it was (degrees)")
    right.set(title="it turns by up to half a turn")
    right.legend(loc="upper left")
    return figure


def draw_timing():
    """One joint path with both timings: how hard the arm works over time."""
    s = np.linspace(0, 1, 41)[:, None]
    a, b = np.array([1.0, 0.6, -2.2, 1.0, 1.5]), np.array([2.6, 1.2, -1.6, 1.9, 1.0])
    bend = 0.25 * np.sin(np.pi * s) * [0, 1, -1, 1, 0]
    way = JointPath("line", 0, 1, s[:, 0], a + s * (b - a) + bend)
    velocity, acceleration, dt = LIMITS.velocity, np.full(arm.DOF, 3.0), 0.01
    figure, (top, bottom) = plt.subplots(2, 1, figsize=(8, 4.8), sharex=True, layout="constrained")
    for name, colour in (("cubic", ORANGE), ("optimal", BLUE)):
        samples = time_path(way, velocity, acceleration, dt, RATES[name])
        t = np.arange(samples.shape[1]) * dt
        fastest = (np.abs(samples[1]) / velocity).max(axis=1)
        hardest = (np.abs(samples[2]) / acceleration).max(axis=1)
        top.plot(t, 100 * fastest, color=colour, label=f"{name}: {t[-1]:.2f} s")
        bottom.plot(t, 100 * hardest, color=colour)
    top.legend(loc="upper right")
    top.set(ylabel="velocity (% of limit)", title="the joint that works hardest")
    bottom.set(xlabel="time (s)", ylabel="acceleration (% of limit)")
    return figure


FIGURES = {
    "angles": draw_angles,
    "nearest": draw_nearest,
    "axis": draw_axis,
    "timing": draw_timing,
}


def main() -> None:
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).parent
    # The same figure is the same file: text as text, no date, and names that are not random.
    plt.rcParams.update({"svg.fonttype": "none", "svg.hashsalt": "figures", "font.size": 10})
    for name, draw in FIGURES.items():
        draw().savefig(folder / f"{name}.svg", metadata={"Date": None})


if __name__ == "__main__":
    main()
