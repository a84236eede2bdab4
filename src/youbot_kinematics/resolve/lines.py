"""Straight lines of the tool, as the arm's plane sees them: azimuth, signed radius, height.

A line that passes joint 1's axis at a distance d turns the arm's plane by up to pi within a few d.
So lines are not measured by their length alone but by their ``progress``, length and turn together,
in which every joint moves at a bounded rate; waypoints are evenly spaced in it.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

# A waypoint each 5 mm, and each 0.05 rad of azimuth: a tenth of joint 1's gap, so that no step can
# jump over it, and dense enough for a cubic spline to stay on the line to a micrometre.
STEP_LENGTH, STEP_TURN = 0.005, 0.05
_MIN_STEPS = 8
# Close to the axis joint 1 hurries and the others crawl, and within a few times the distance it is
# the other way round: as sharp a corner as the distance is small. So many steps while the distance
# grows e-fold follow it round.
_STEPS_PER_SCALE = 3
# A line this close to joint 1's axis (m) goes through it: the arm bends over its back there and
# joint 1 stands still.
_THROUGH_AXIS = 1e-8
# The arm's reach (m) over that, as the argument of a hyperbolic sine.
_FAR = 20.0


class Line(NamedTuple):
    """A straight line of the tool in ``base_link``; u in 0..1 is the fraction of it done.

    In the horizontal plane the line runs in the direction ``heading`` and passes joint 1's axis at
    the distance ``offset``, on its left; ``along`` counts from the point nearest to the axis.
    """

    start: np.ndarray  # (3,) m
    end: np.ndarray  # (3,) m
    heading: float  # rad
    offset: float  # m
    along: float  # m, at the start
    run: float  # m, the line's horizontal length

    @property
    def length(self) -> float:
        """Length of the line (m)."""
        return float(np.linalg.norm(self.end - self.start))

    def point(self, u) -> np.ndarray:
        """Tool positions (..., 3), m."""
        return self.start + np.asarray(u)[..., None] * (self.end - self.start)

    def height(self, u) -> np.ndarray:
        """Height z of the tool (...), m."""
        return self.start[2] + np.asarray(u) * (self.end[2] - self.start[2])

    def azimuth(self, u) -> np.ndarray:
        """Azimuth phi of the arm's plane (...), rad, continuous along the line."""
        if self.offset == 0.0:
            return np.full(np.shape(u), self.heading)
        return self.heading + np.arctan2(self.offset, self.along + np.asarray(u) * self.run)

    def radius(self, u) -> np.ndarray:
        """Signed reach r in the plane of that azimuth (...), m."""
        x = self.along + np.asarray(u) * self.run
        return x if self.offset == 0.0 else np.hypot(x, self.offset)

    def progress(self, u) -> np.ndarray:
        """Steps of length and of turn since the start (...): the measure of the line.

        It grows steadily, by some steps even for a line of no length.
        """
        u = np.asarray(u)
        steps = u * (self.length / STEP_LENGTH + _MIN_STEPS)
        if self.offset == 0.0:
            return steps
        scale = np.arcsinh((self.along + u * self.run) / abs(self.offset))
        scale_0 = np.arcsinh(self.along / abs(self.offset))
        turn = np.abs(self.azimuth(u) - self.azimuth(0.0))
        return steps + turn / STEP_TURN + _STEPS_PER_SCALE * (scale - scale_0)

    def waypoints(self) -> np.ndarray:
        """Fractions u of the waypoints, both ends included, evenly spaced in ``progress``."""
        total = float(self.progress(1.0))
        n = int(np.ceil(total))
        table = np.linspace(0.0, 1.0, n + 1)
        if self.offset != 0.0 and self.run > 0.0:
            # Near the axis progress is steep in u: tabulate it by distances that grow evenly there.
            scales = np.sinh(np.linspace(-_FAR, _FAR, 400))
            foot = (np.abs(self.offset) * scales - self.along) / self.run
            table = np.union1d(table, foot[(foot > 0) & (foot < 1)])
        u = np.interp(np.linspace(0.0, total, n + 1), self.progress(table), table)
        u[0], u[-1] = 0.0, 1.0
        return u


def straight_line(start: np.ndarray, end: np.ndarray, free_azimuth: float = 0.0) -> Line:
    """The line from ``start`` to ``end``, each (3,) in ``base_link``, m.

    Args:
        free_azimuth: azimuth (rad) of the arm's plane where the line leaves it free, on the axis.
    """
    run = float(np.hypot(*(end - start)[:2]))
    if run < _THROUGH_AXIS:  # vertical: measured from the axis, in the direction of the line
        along = float(np.hypot(*start[:2]))
        on_axis = along < _THROUGH_AXIS
        heading = free_azimuth if on_axis else float(np.arctan2(start[1], start[0]))
        return Line(start, end, heading, 0.0, along, 0.0)
    ex, ey = (end - start)[:2] / run
    along, offset = start[0] * ex + start[1] * ey, start[1] * ex - start[0] * ey
    offset = 0.0 if abs(offset) < _THROUGH_AXIS else float(offset)
    return Line(start, end, float(np.arctan2(ey, ex)), offset, float(along), run)
