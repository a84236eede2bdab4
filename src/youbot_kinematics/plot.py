"""A plan as one picture: the tour in space, the joints in their limits, how hard the arm works."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from . import arm
from .check import distance_to_line
from .colours import BLACK, BLUE, GREEN, GREY, KIND_COLOURS, ORANGE, SHADE, SKY
from .exceptions import InputError
from .files import new_file
from .kinematics import dh_frames, smallest_singular_value
from .track import tool_tracks
from .trajectory import Trajectory, interpolate

SUFFIXES = (".png", ".svg")

_SAMPLES = 1500
# Distances are drawn on a scale of this much at least: less is rounding, mm.
_LEAST_DISTANCE = 0.01


def plot_plan(plan, path, recorded=None, force: bool = False) -> None:
    """Draws a plan to a PNG or SVG file, whole or not at all.

    Args:
        plan: a ``planner.Plan``.
        path: a name that ends in ``.png`` or ``.svg``.
        recorded: what an arm did, to draw over what was planned: ``(times, joints)`` with times
            (m,) in s from the start of the trajectory and joints (m, 5) in rad.
        force: whether it may replace a file.

    Raises:
        InputError: another suffix, Matplotlib is missing, the file exists or cannot be written.
    """
    require_plottable(path)
    figure = draw(plan, recorded)
    with new_file(path, force) as unfinished:
        figure.savefig(unfinished, dpi=110)


def require_plottable(path) -> None:
    """Raises InputError if a picture of that name cannot be drawn."""
    if Path(path).suffix.lower() not in SUFFIXES:
        raise InputError(f"cannot draw {path}: its name must end in {' or '.join(SUFFIXES)}")
    try:
        import matplotlib.figure  # noqa: F401
    except ImportError as error:
        raise InputError(
            "pictures need Matplotlib: install python3-matplotlib (apt) or matplotlib (pip)"
        ) from error


def draw(plan, recorded=None):
    """The picture as a ``matplotlib.figure.Figure``; arguments as in ``plot_plan``."""
    from matplotlib.figure import Figure
    from mpl_toolkits import mplot3d  # noqa: F401 (older Matplotlib knows "3d" only after this)

    figure = Figure(figsize=(14, 9.5))
    columns = figure.add_gridspec(
        1, 2, width_ratios=(1.25, 1), left=0.06, right=0.985, top=0.91, bottom=0.06, wspace=0.13
    )
    left = columns[0].subgridspec(4, 1, height_ratios=(4.6, 1, 1, 1), hspace=0.42)
    right = columns[1].subgridspec(arm.DOF, 1, hspace=0.16)
    times = np.linspace(0.0, plan.trajectory.duration, _SAMPLES)
    states = Trajectory(times, *interpolate(plan.trajectory, times))

    _draw_tour(figure.add_subplot(left[0], projection="3d"), plan, states, recorded)
    _draw_effort(figure.add_subplot(left[1]), plan, states)
    _draw_singular_value(figure.add_subplot(left[2]), plan, states)
    _draw_distance(figure.add_subplot(left[3]), plan, states, recorded)
    _draw_joints([figure.add_subplot(cell) for cell in right], plan, states, recorded)
    figure.suptitle(_title(plan), fontsize=12)
    return figure


def _title(plan) -> str:
    return (
        f"{len(plan.targets)} targets from {plan.targets.source}\n"
        f"tour {plan.length:.3f} m, {plan.trajectory.duration:.2f} s"
    )


# --- the tour in space ----------------------------------------------------------------------------


def _draw_tour(axes, plan, states: Trajectory, recorded) -> None:
    _draw_tracks(axes, tool_tracks(plan.trajectory))
    if recorded is not None:
        axes.plot(*_tool_positions(recorded[1]).T, color=ORANGE, lw=1.5, ls="--", label="recorded")
    _draw_arm(axes, states.positions[0], GREY, "arm at the start")
    _draw_arm(axes, states.positions[-1], SKY, "arm at the end")
    _draw_checkpoints(axes, plan.checkpoints[:, :3, 3])
    axes.set(xlabel="x (m)", ylabel="y (m)", zlabel="z (m)")
    axes.tick_params(labelsize=8)
    axes.legend(loc="upper left", bbox_to_anchor=(-0.16, 1.02), fontsize=8)
    _look_at(axes, plan.checkpoints[:, :3, 3])
    tool = _tool_positions(states.positions)
    _equal_scales(axes, np.vstack([tool, *(_arm_points(q) for q in states.positions[[0, -1]])]))


def _draw_tracks(axes, tracks) -> None:
    """The tool's way in the colours of its segments' kinds, each named once."""
    named = set()
    for track in tracks:
        kind = track.segment.kind
        label = None if kind in named else f"tool: {kind}"
        axes.plot(*track.tool.T, color=KIND_COLOURS[kind], lw=2.5, label=label)
        named.add(kind)


def _draw_checkpoints(axes, points) -> None:
    """The start, and the targets numbered in visiting order."""
    axes.scatter(*points[:1].T, color=GREEN, s=60, marker="s", depthshade=False, label="start")
    axes.scatter(*points[1:].T, color=BLACK, s=45, depthshade=False, label="targets")
    for number, (x, y, z) in enumerate(points[1:], start=1):
        axes.text(x, y, z + 0.015, str(number), fontsize=11, weight="bold", zorder=10)


def _draw_arm(axes, q, colour, label) -> None:
    axes.plot(*_arm_points(q).T, color=colour, lw=4, marker="o", ms=5, alpha=0.8, label=label)


def _arm_points(q) -> np.ndarray:
    """Points (7, 3) in m of the arm as a stick figure: base, shoulder, elbow, wrist, tool."""
    origins = dh_frames(np.asarray(q))[:, :3, 3]
    above_base = [0.0, 0.0, origins[1, 2]]  # the shoulder is beside joint 1's axis
    return np.vstack([origins[0], above_base, origins[1:]])


def _look_at(axes, points) -> None:
    """From the side of the arm on which most of the tour is, a little from above and beside."""
    x, y, _ = points.mean(axis=0)
    axes.view_init(elev=22, azim=np.rad2deg(np.arctan2(y, x)) + 35)


def _equal_scales(axes, points) -> None:
    """A metre as long in all three directions."""
    centre = (points.min(axis=0) + points.max(axis=0)) / 2
    half = np.ptp(points, axis=0).max() / 2 * 1.05
    axes.set(**{f"{name}lim": (c - half, c + half) for name, c in zip("xyz", centre)})
    if hasattr(axes, "set_box_aspect"):  # older Matplotlib has a cubic box anyway
        axes.set_box_aspect((1, 1, 1), zoom=1.12)


# --- over time ------------------------------------------------------------------------------------


def _draw_joints(panels, plan, states: Trajectory, recorded) -> None:
    """Every joint against its limits, which are the edges of the white band."""
    limits = arm.joint_limits(plan.parameters.limits)
    for i, axes in enumerate(panels):
        lower, upper = limits.lower[i], limits.upper[i]
        room = 0.08 * (upper - lower)
        axes.set(ylim=(lower - room, upper + room), ylabel=f"joint {i + 1} (rad)")
        axes.axhspan(lower - room, lower, color=SHADE)
        axes.axhspan(upper, upper + room, color=SHADE)
        axes.plot(states.times, states.positions[:, i], color=BLUE, label="planned")
        if recorded is not None:
            axes.plot(recorded[0], recorded[1][:, i], color=ORANGE, ls="--", label="recorded")
        _finish(axes, plan, numbered=i == 0, last=i == len(panels) - 1)
    panels[0].set_title(
        "joints in their limits (shaded: beyond), and targets as visited", fontsize=10, pad=18
    )
    if recorded is not None:
        panels[0].legend(loc="lower right", fontsize=8)


def _draw_effort(axes, plan, states: Trajectory) -> None:
    limits = arm.joint_limits(plan.parameters.limits)
    velocity = np.abs(states.velocities) / limits.velocity
    acceleration = np.abs(states.accelerations) / plan.parameters.acceleration
    axes.plot(states.times, 100 * velocity.max(axis=1), color=BLUE, label="velocity")
    axes.plot(
        states.times, 100 * acceleration.max(axis=1), color=ORANGE, lw=1, label="acceleration"
    )
    axes.axhline(100, color=BLACK, lw=1, ls=":")
    axes.set(ylim=(0, 115), ylabel="% of limit")
    axes.set_title("velocity and acceleration, nearest to its limit", fontsize=10, loc="left")
    axes.legend(loc="lower right", bbox_to_anchor=(1.0, 0.97), fontsize=8, ncol=2, frameon=False)
    _finish(axes, plan, last=False)


def _draw_singular_value(axes, plan, states: Trajectory) -> None:
    values = smallest_singular_value(states.positions)
    axes.plot(states.times, values, color=BLUE)
    axes.set(ylabel="value (m/rad)")
    axes.set_ylim(bottom=0)
    axes.set_title("smallest singular value of the Jacobian (0: singular)", fontsize=10)
    _finish(axes, plan, last=False)


def _draw_distance(axes, plan, states: Trajectory, recorded) -> None:
    lines = [segment for segment in plan.trajectory.segments if segment.kind == "line"]
    tool = _tool_positions(states.positions)
    for line in lines:
        during = (states.times >= line.start) & (states.times <= line.end)
        axes.plot(states.times[during], _distance(plan, line, tool[during]), color=BLUE)
    if recorded is not None and lines:
        # An arm lags behind its trajectory, so that its clock does not tell which line it is on.
        tool = _tool_positions(recorded[1])
        nearest = np.min([_distance(plan, line, tool) for line in lines], axis=0)
        axes.plot(recorded[0], nearest, color=ORANGE, ls="--")
    axes.set(ylabel="mm", ylim=(0, max(axes.get_ylim()[1], _LEAST_DISTANCE)))
    axes.set_title("distance of the tool from its straight line", fontsize=10)
    _finish(axes, plan, last=True)


def _distance(plan, line, tool) -> np.ndarray:
    """Distance (m,) in mm of the tool at (m, 3), m, from a segment's straight line."""
    a, b = plan.checkpoints[[line.from_checkpoint, line.to_checkpoint], :3, 3]
    return 1000 * distance_to_line(tool, a, b)


def _finish(axes, plan, last: bool, numbered: bool = False) -> None:
    """What all panels over time have in common: the time axis, segments' kinds, checkpoints."""
    axes.set_xlim(0, plan.trajectory.duration)
    axes.grid(color=SHADE, lw=0.6)
    axes.set_axisbelow(True)
    axes.tick_params(labelbottom=last, labelsize=8)
    if last:
        axes.set_xlabel("time (s)")
    for segment in plan.trajectory.segments:
        if segment.kind != "line":
            colour = KIND_COLOURS[segment.kind]
            axes.axvspan(segment.start, segment.end, color=colour, alpha=0.2, lw=0)
    reached = {segment.to_checkpoint: segment.end for segment in plan.trajectory.segments}
    for number, time in reached.items():
        axes.axvline(time, color=GREY, lw=0.8)
        if numbered and number > 0:
            above = (time, axes.get_ylim()[1])
            style = {"ha": "center", "weight": "bold", "textcoords": "offset points"}
            axes.annotate(str(number), above, (0, 2), **style)


def _tool_positions(joints) -> np.ndarray:
    """Positions (m, 3) of the tool in m at joints (m, 5) in rad."""
    return dh_frames(np.asarray(joints))[:, -1, :3, 3]
