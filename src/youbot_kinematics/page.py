"""A plan as one page for the browser, which needs no network: the arm in motion, plots, report.

The page is ``page/plan.html`` with its script ``page/plan.js``, plotly.js, which draws, and the
plan as data. What the page shows is computed here; the script only moves it.
"""

from __future__ import annotations

import json
import math
import re
from pathlib import Path

import numpy as np

from . import arm
from .check import distance_to_line
from .colours import KIND_COLOURS
from .exceptions import InputError
from .files import new_file
from .kinematics import dh_frames, smallest_singular_value
from .resources import resource_path
from .shapes import arm_shapes, mesh
from .track import tool_tracks
from .trajectory import Trajectory, interpolate

SUFFIX = ".html"
# Moments that the slider knows: so many a second, but no more than so many.
_RATE, _MOST = 50.0, 1500
# Digits of positions (m, rad) and of fractions: a tenth of a millimetre is less than a pixel.
_DIGITS = 5


def write_page(path, plan, force: bool = False) -> None:
    """Writes a plan as one HTML file, whole or not at all.

    Args:
        path: a name that ends in ``.html``.
        plan: a ``planner.Plan``.
        force: whether it may replace a file.

    Raises:
        InputError: another suffix, plotly or the URDF's parser is missing, the file exists or
            cannot be written.
    """
    library = require_page(path)
    # "</script>" in a bag's name must not end the script; a browser reads "<\/" as "</".
    data = json.dumps(page_data(plan), allow_nan=False, separators=(",", ":")).replace("</", r"<\/")
    script = resource_path("page/plan.js").read_text(encoding="utf-8")
    template = resource_path("page/plan.html").read_text(encoding="utf-8")
    parts = {"plotly": library, "data": data, "script": script}
    text = re.sub(r"\{\{(\w+)\}\}", lambda match: parts[match[1]], template)
    with new_file(path, force) as unfinished:
        unfinished.write_text(text, encoding="utf-8")


def require_page(path) -> str:
    """The source of plotly.js, if a page of that name can be written.

    Raises:
        InputError: it cannot.
    """
    if Path(path).suffix.lower() != SUFFIX:
        raise InputError(f"cannot write the page {path}: its name must end in {SUFFIX}")
    try:
        from plotly.offline import get_plotlyjs
    except ImportError as error:
        raise InputError("pages need plotly: pip install plotly") from error
    return get_plotlyjs()


def page_data(plan) -> dict:
    """All that the page shows, as JSON knows it: SI units, rad, ``base_link``."""
    n = int(np.clip(plan.trajectory.duration * _RATE, 1, _MOST))
    times = np.linspace(0.0, plan.trajectory.duration, n + 1)
    states = Trajectory(times, *interpolate(plan.trajectory, times))
    frames = dh_frames(states.positions)
    return {
        "title": f"{len(plan.targets)} targets from {plan.targets.source}",
        "times": _rounded(times),
        "frames": _rounded(frames[:, :, :3]),
        "shapes": [_shape(shape) for shape in arm_shapes()],
        "checkpoints": _rounded(plan.checkpoints[:, :3, 3]),
        "segments": [_segment(track) for track in tool_tracks(plan.trajectory)],
        "joints": _joints(plan, states),
        "effort": _effort(plan, states),
        "distance": _distance(plan, states, frames[:, -1, :3, 3]),
        "singular_value": _rounded(smallest_singular_value(states.positions)),
        "report": _rows(plan),
    }


def _shape(shape) -> dict:
    vertices, triangles = mesh(shape)
    red, green, blue = (round(255 * part) for part in shape.colour[:3])
    return {
        "frame": shape.frame,
        "colour": f"rgb({red},{green},{blue})",
        "vertices": _rounded(vertices),
        "triangles": triangles.tolist(),
    }


def _segment(track) -> dict:
    kind, start, end, first, last, reason = track.segment
    return {
        "kind": kind,
        "colour": KIND_COLOURS[kind],
        "start": start,
        "end": end,
        "from": first,
        "to": last,
        "reason": reason,
        "tool": _rounded(track.tool),
    }


def _joints(plan, states: Trajectory) -> dict:
    limits = arm.joint_limits(plan.parameters.limits)
    return {
        "names": [f"joint {i + 1}" for i in range(arm.DOF)],
        "positions": _rounded(states.positions.T),
        "lower": limits.lower.tolist(),
        "upper": limits.upper.tolist(),
    }


def _effort(plan, states: Trajectory) -> dict:
    """Fractions of the limits, of the joint nearest to its own at each moment."""
    limits = arm.joint_limits(plan.parameters.limits)
    acceleration = np.abs(states.accelerations).max(axis=1) / plan.parameters.acceleration
    velocity = (np.abs(states.velocities) / limits.velocity).max(axis=1)
    return {"velocity": _rounded(velocity), "acceleration": _rounded(acceleration)}


def _distance(plan, states: Trajectory, tool) -> list:
    """Distance of the tool from its line in mm at each moment, None where it is on none."""
    distance = np.full(len(tool), np.nan)
    for segment in plan.trajectory.segments:
        if segment.kind == "line":
            during = (states.times >= segment.start) & (states.times <= segment.end)
            a, b = plan.checkpoints[[segment.from_checkpoint, segment.to_checkpoint], :3, 3]
            distance[during] = 1000 * distance_to_line(tool[during], a, b)
    return [None if math.isnan(value) else value for value in distance.tolist()]


def _rows(plan) -> list:
    order = " ".join(str(target + 1) for target in plan.order)
    return [
        ("visiting order", order),
        ("tour", f"{plan.length:.3f} m"),
        ("solver", plan.solver),
        *plan.report.rows(),
    ]


def _rounded(values: np.ndarray) -> list:
    return np.round(values, _DIGITS).tolist()
