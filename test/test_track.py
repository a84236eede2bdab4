"""Tracks follow the tool through their segments, without a gap."""

import numpy as np

from youbot_kinematics.kinematics import YoubotKinematics
from youbot_kinematics.planner import plan
from youbot_kinematics.targets import Targets
from youbot_kinematics.track import tool_tracks

START = [0.5, 0.5, -2.0, 1.2, 0.6]
TARGETS = [[1.4, 0.4, -1.9, 1.0, 1.5], [0.9, 0.25, -1.8, 0.9, 1.0]]


def test_tracks_go_from_checkpoint_to_checkpoint_in_small_steps():
    planned = plan(Targets.from_joints(TARGETS), START)
    tracks = tool_tracks(planned.trajectory)
    for track in tracks:
        assert (track.times[0], track.times[-1]) == (track.segment.start, track.segment.end)
        ends = planned.checkpoints[[track.segment.from_checkpoint, track.segment.to_checkpoint]]
        np.testing.assert_allclose(track.tool[[0, -1]], ends[:, :3, 3], atol=1e-6)
        assert np.linalg.norm(np.diff(track.tool, axis=0), axis=1).max() < 0.02


def test_a_track_is_where_the_joints_put_the_tool():
    planned = plan(Targets.from_joints(TARGETS), START)
    points = planned.trajectory.positions
    tool = YoubotKinematics().forward_kinematics(points)[:, :3, 3]
    (i,) = np.nonzero(np.isclose(planned.trajectory.times, planned.trajectory.segments[0].end))[0]
    np.testing.assert_allclose(tool_tracks(planned.trajectory)[0].tool[-1], tool[i], atol=1e-9)
