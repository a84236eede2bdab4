"""Where the tool goes along a trajectory, segment by segment, to be drawn."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from .kinematics import dh_frames
from .trajectory import Segment, Trajectory, interpolate

#: Time between two points of a track, s: at the arm's fastest the tool moves a centimetre in it.
STEP = 0.01


class Track(NamedTuple):
    """The tool's way during a segment."""

    segment: Segment
    times: np.ndarray  # (m,) s, both ends included
    tool: np.ndarray  # positions in base_link, (m, 3) m


def tool_tracks(trajectory: Trajectory) -> list[Track]:
    """The tracks of all segments of a trajectory, in order of time."""
    return [_track(trajectory, segment) for segment in trajectory.segments]


def _track(trajectory: Trajectory, segment: Segment) -> Track:
    n = max(int(np.ceil((segment.end - segment.start) / STEP)), 1)
    times = np.linspace(segment.start, segment.end, n + 1)
    positions, _, _ = interpolate(trajectory, times)
    return Track(segment, times, dh_frames(positions)[:, -1, :3, 3])
