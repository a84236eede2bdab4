"""Arrays to ROS messages and back."""

from __future__ import annotations

import io

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from youbot_kinematics import JOINT_NAMES, joint_limits
from youbot_kinematics.colours import KIND_COLOURS, rgb
from youbot_kinematics.contract import shape_problems, trajectory_from_command
from youbot_kinematics.kinematics import YoubotKinematics
from youbot_kinematics.shapes import arm_shapes, shape_poses
from youbot_kinematics.track import Track
from youbot_kinematics.trajectory import Segment, Trajectory

genpy = pytest.importorskip("genpy")
for package in ("geometry", "nav", "sensor", "std", "trajectory", "visualization"):
    pytest.importorskip(f"{package}_msgs.msg")

from sensor_msgs.msg import JointState  # noqa: E402
from visualization_msgs.msg import Marker  # noqa: E402

from youbot_kinematics import messages, state_messages  # noqa: E402

RNG = np.random.default_rng(2)
LIMITS = joint_limits("urdf")


def over_the_wire(message):
    """The message as a subscriber gets it."""
    buffer = io.BytesIO()
    message.serialize(buffer)
    return type(message)().deserialize(buffer.getvalue())


def random_poses(n):
    return YoubotKinematics().forward_kinematics(RNG.uniform(LIMITS.lower, LIMITS.upper, (n, 5)))


class TestTrajectory:
    @pytest.fixture
    def trajectory(self):
        times = np.arange(201) * 0.02
        values = RNG.uniform(LIMITS.lower, LIMITS.upper, (201, 5))
        slow, soft = RNG.uniform(-1, 1, (2, 201, 5))
        slow[[0, -1]] = soft[[0, -1]] = 0.0
        return Trajectory(times, values, slow, soft)

    def test_it_has_the_shape_that_both_controllers_take(self, trajectory):
        message = over_the_wire(messages.trajectory_message(trajectory))
        command = messages.command_from_message(message)
        assert shape_problems(command, LIMITS) == []
        assert message.header.stamp == genpy.Time(0)
        assert tuple(message.joint_names) == JOINT_NAMES

    def test_it_comes_back_as_it_was(self, trajectory):
        message = over_the_wire(messages.trajectory_message(trajectory))
        back = trajectory_from_command(messages.command_from_message(message))
        np.testing.assert_allclose(back.times, trajectory.times, atol=5e-10)
        for before, after in zip(trajectory[1:4], back[1:4]):
            np.testing.assert_array_equal(before, after)

    def test_times_beyond_a_second_fill_both_fields_of_a_duration(self, trajectory):
        last = messages.trajectory_message(trajectory).points[-1].time_from_start
        assert (last.secs, last.nsecs) == (4, 0)

    def test_any_message_can_be_looked_at(self):
        message = messages.trajectory_message(
            Trajectory(np.zeros(1), np.zeros((1, 5)), np.zeros((1, 5)), np.zeros((1, 5)))
        )
        message.points[0].velocities = []
        message.header.stamp = genpy.Time(3, 5)
        command = messages.command_from_message(over_the_wire(message))
        assert command.stamp == 3_000_000_005
        assert len(command.velocities[0]) == 0


class TestJointStates:
    def test_there_and_back(self):
        q, v = RNG.uniform(-1, 1, (2, 5))
        message = over_the_wire(state_messages.joint_state_message(genpy.Time(7), q, v))
        np.testing.assert_array_equal(state_messages.joints_from_message(message), q)
        np.testing.assert_array_equal(state_messages.joints_from_message(message, "velocity"), v)
        assert message.header.stamp == genpy.Time(7)

    def test_joints_are_taken_by_name(self):
        names = ["wheel", *JOINT_NAMES[::-1], "gripper"]
        message = JointState(name=names, position=[9.0, 5, 4, 3, 2, 1, 9.0])
        np.testing.assert_array_equal(state_messages.joints_from_message(message), [1, 2, 3, 4, 5])

    @pytest.mark.parametrize(
        "names, position",
        [
            ([], []),
            ([], [1.0, 2, 3, 4, 5]),
            (["wheel"], [1.0]),
            (JOINT_NAMES[:4], [1.0, 2, 3, 4]),
            (JOINT_NAMES, [1.0, 2, 3, 4]),
            ([*JOINT_NAMES, JOINT_NAMES[0]], [1.0, 2, 3, 4, 5, 6]),
            (JOINT_NAMES, [1.0, 2, 3, 4, float("nan")]),
            (JOINT_NAMES, [float("inf"), 2, 3, 4, 5]),
        ],
    )
    def test_what_is_incomplete_ambiguous_or_not_finite_is_none(self, names, position):
        message = JointState(name=list(names), position=position)
        assert state_messages.joints_from_message(message) is None

    def test_a_wheel_that_is_not_finite_does_not_matter(self):
        message = JointState(name=["wheel", *JOINT_NAMES], position=[float("nan"), 1, 2, 3, 4, 5])
        np.testing.assert_array_equal(state_messages.joints_from_message(message), [1, 2, 3, 4, 5])


class TestMarkers:
    def test_the_first_deletes_what_was_before_and_ids_are_unique(self):
        markers = over_the_wire(messages.checkpoint_markers(random_poses(12))).markers
        assert markers[0].action == Marker.DELETEALL
        assert all(m.action == Marker.ADD for m in markers[1:])
        assert len({m.id for m in markers}) == len(markers)
        assert {m.header.frame_id for m in markers} == {"base_link"}

    def test_checkpoints_are_spheres_numbered_from_one_in_visiting_order(self):
        poses = random_poses(12)
        markers = messages.checkpoint_markers(poses).markers
        spheres = [m.pose.position for m in markers if m.type == Marker.SPHERE]
        np.testing.assert_array_equal([[p.x, p.y, p.z] for p in spheres], poses[:, :3, 3])
        numbers = [m.text for m in markers if m.type == Marker.TEXT_VIEW_FACING]
        assert numbers == [str(i) for i in range(1, 13)]

    def test_colours_are_colours_and_everything_has_a_size(self):
        for marker in messages.checkpoint_markers(random_poses(30)).markers[1:]:
            for color in [marker.color, *marker.colors]:
                assert all(0 <= c <= 1 for c in (color.r, color.g, color.b)) and color.a > 0
            assert max(marker.scale.x, marker.scale.z) > 0
            assert len(marker.colors) in (0, len(marker.points))

    def test_no_checkpoints_clear_the_view(self):
        assert len(messages.checkpoint_markers(np.empty((0, 4, 4))).markers) == 1


class TestWhatElseIsSeen:
    @pytest.fixture
    def tracks(self):
        way = np.linspace([0.1, 0.2, 0.3], [0.3, 0.2, 0.1], 9)
        segments = [Segment(kind, i, i + 1.0, i, i + 1) for i, kind in enumerate(KIND_COLOURS)]
        return [Track(segment, segment.start + np.arange(9) / 8, way) for segment in segments]

    def test_every_segment_is_a_line_in_the_colour_of_its_kind(self, tracks):
        markers = over_the_wire(messages.segment_markers(tracks)).markers
        lines = [m for m in markers if m.type == Marker.LINE_STRIP]
        for track, line in zip(tracks, lines):
            colour = [line.color.r, line.color.g, line.color.b]
            np.testing.assert_allclose(colour, rgb(KIND_COLOURS[track.segment.kind]), atol=1e-6)
            np.testing.assert_allclose([[p.x, p.y, p.z] for p in line.points], track.tool)
        assert len(lines) == len(tracks)
        assert markers[0].action == Marker.DELETEALL
        assert len({m.id for m in markers}) == len(markers)

    def test_what_is_no_line_is_named(self, tracks):
        markers = messages.segment_markers(tracks).markers
        assert {m.text for m in markers if m.text} == set(KIND_COLOURS) - {"line"}

    def test_the_ghost_has_the_shapes_of_the_arm_and_is_translucent(self):
        pytest.importorskip("urdf_parser_py")
        shapes = arm_shapes()
        poses = shape_poses(shapes, [1.0, 1.0, -2.0, 1.0, 1.0])
        first, *markers = over_the_wire(messages.ghost_markers(shapes, poses)).markers
        assert first.action == Marker.DELETEALL
        for marker, shape, T in zip(markers, shapes, poses):
            p, size = marker.pose.position, marker.scale
            np.testing.assert_allclose([p.x, p.y, p.z], T[:3, 3])
            np.testing.assert_allclose([size.x, size.y, size.z], shape.size)
            assert 0 < marker.color.a < 0.5 and marker.header.frame_id == "base_link"
        assert {m.type for m in markers} == {Marker.CUBE, Marker.CYLINDER}

    def test_a_trail_has_a_bead_for_each_point_and_may_be_empty(self):
        points = np.arange(12.0).reshape(4, 3)
        marker = over_the_wire(messages.trail_marker(points))
        assert [[p.x, p.y, p.z] for p in marker.points] == points.tolist()
        assert messages.trail_marker(np.empty((0, 3))).points == []


def test_a_path_holds_the_poses_in_the_base_frame():
    poses = random_poses(20)
    path = over_the_wire(messages.path_message(poses))
    assert path.header.frame_id == "base_link"
    for T, stamped in zip(poses, path.poses):
        p, q = stamped.pose.position, stamped.pose.orientation
        assert stamped.header.frame_id == "base_link"
        np.testing.assert_array_equal([p.x, p.y, p.z], T[:3, 3])
        R = Rotation.from_quat([q.x, q.y, q.z, q.w]).as_matrix()
        np.testing.assert_allclose(R, T[:3, :3], atol=1e-12)
