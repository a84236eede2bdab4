"""An independent judge of trajectories: what a plan's JSON says, against KDL and SciPy.

No code of the package takes part: the chain is built here from the URDF's own numbers by PyKDL, and
the controller's quintic is SciPy's ``BPoly.from_derivatives``. The limits are the caller's.
"""

from __future__ import annotations

import numpy as np
import PyKDL
from scipy.interpolate import BPoly
from urdf_chain import kdl_chain

RATE = 1000  # Hz


class Judge:
    """Judges plans, given as the dict of their JSON.

    Args:
        urdf: path of the arm's URDF.
        limits: profile -> an object with ``lower``, ``upper`` and ``velocity``, (5,) each.
    """

    def __init__(self, urdf, limits):
        self.chain, self.limits = kdl_chain(urdf), limits
        self.solver = PyKDL.ChainFkSolverPos_recursive(self.chain)

    def tool(self, q):
        """Positions (m, 3) of the tool in the base for joints (m, 5)."""
        array, frame, positions = PyKDL.JntArray(5), PyKDL.Frame(), np.empty((len(q), 3))
        for row, joints in enumerate(q.tolist()):
            for i, value in enumerate(joints):
                array[i] = value
            self.solver.JntToCart(array, frame)
            positions[row] = frame.p[0], frame.p[1], frame.p[2]
        return positions

    def figures(self, plan):
        """What a plan's trajectory does at its worst, sampled at 1 kHz."""
        limits, parameters = self.limits[plan["parameters"]["limits"]], plan["parameters"]
        columns = ("positions", "velocities", "accelerations")
        knots = np.array([[point[name] for name in columns] for point in plan["points"]])
        at = np.array([point["time_from_start"] for point in plan["points"]])
        curve = BPoly.from_derivatives(at, knots)
        t = np.linspace(0.0, at[-1], round(at[-1] * RATE) + 1)
        q, v, a = curve(t), curve(t, 1), curve(t, 2)
        x = self.tool(q)
        outside = np.maximum(limits.lower - q, q - limits.upper)
        return {
            "duration": float(at[-1]),
            "outside": float(outside.max()),
            "velocity": float((np.abs(v) / limits.velocity).max()),
            "acceleration": float(np.abs(a).max() / parameters["acceleration"]),
            "jump": float(np.abs(np.diff(q, axis=0)).max() * RATE / limits.velocity.max()),
            **self.path_figures(plan, t, x),
        }

    def path_figures(self, plan, t, x):
        """How far the tool, at x (m, 3) at times t (m,), is from lines and checkpoints."""
        targets = np.array(plan["targets"]["poses"])[plan["order"], :3, 3]
        checkpoints = np.vstack([self.tool(np.array([plan["start"]])), targets])
        worst, detoured, missed = 0.0, 0.0, np.full(len(checkpoints), np.inf)
        missed[0] = np.linalg.norm(x[0] - checkpoints[0])
        for part in plan["segments"]:
            during = x[(t >= part["start"] - 1e-9) & (t <= part["end"] + 1e-9)]
            a, b = checkpoints[part["from"]], checkpoints[part["to"]]
            if part["kind"] == "line":
                worst = max(worst, from_line(during, a, b))
            if part["kind"] == "detour":
                detoured += float(np.linalg.norm(during[-1] - during[0]))
            # The last part that leads to a checkpoint must end on it.
            missed[part["to"]] = np.linalg.norm(during[-1] - b)
        kinds = [part["kind"] for part in plan["segments"]]
        return {
            "line": worst,
            "missed": float(missed.max()),
            "reconfigurations": kinds.count("reconfiguration"),
            "detours": kinds.count("detour"),
            "detoured": detoured,
        }


def from_line(points, a, b):
    """The largest distance of points (m, 3) from the straight line between a and b, (3,)."""
    along = (b - a) / max(np.linalg.norm(b - a), 1e-12)
    s = np.clip((points - a) @ along, 0.0, np.linalg.norm(b - a))
    return float(np.linalg.norm(points - a - s[:, None] * along, axis=1).max())
