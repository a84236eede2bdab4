"""Trajectories and markers <-> ROS messages: conversions only, no node, no clock.

Everything is in ``base_link``, in SI units. Headers have stamp zero unless a time is given: for a
trajectory it means "start now", for RViz "whenever".
"""

from __future__ import annotations

import genpy
import numpy as np
from geometry_msgs.msg import Point, Pose, PoseStamped, Quaternion, Vector3
from nav_msgs.msg import Path
from scipy.spatial.transform import Rotation
from std_msgs.msg import ColorRGBA
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint
from visualization_msgs.msg import Marker, MarkerArray

from . import arm
from .colours import BLACK, KIND_COLOURS, ORANGE, VERMILLION, rgb
from .contract import Command, command_from_trajectory
from .shapes import BOX, Shape
from .track import Track
from .trajectory import Trajectory

SPHERE_DIAMETER = 0.02  # m
NUMBER_HEIGHT = 0.035  # m, of the digits
AXIS_LENGTH = 0.05  # m, of a checkpoint's frame
SEGMENT_WIDTH = 0.006  # m, of the tool's way
LABEL_HEIGHT = 0.022  # m, of the letters
BEAD_DIAMETER = 0.01  # m, of the trail
GHOST_OPACITY = 0.3

OPAQUE_BLACK = ColorRGBA(*rgb(BLACK), 1.0)
AXIS_COLORS = (  # x, y, z, as everywhere in ROS
    ColorRGBA(0.9, 0.2, 0.2, 1.0),
    ColorRGBA(0.2, 0.75, 0.2, 1.0),
    ColorRGBA(0.25, 0.4, 1.0, 1.0),
)


# Trajectories


def trajectory_message(trajectory: Trajectory) -> JointTrajectory:
    """The message that makes a controller run a trajectory from now on (stamp zero)."""
    command = command_from_trajectory(trajectory)
    rows = zip(command.times, command.positions, command.velocities, command.accelerations)
    points = [
        JointTrajectoryPoint(
            positions=position.tolist(),
            velocities=velocity.tolist(),
            accelerations=acceleration.tolist(),
            time_from_start=genpy.Duration(0, ns),
        )
        for ns, position, velocity, acceleration in rows
    ]
    return JointTrajectory(joint_names=list(command.joint_names), points=points)


def command_from_message(message: JointTrajectory) -> Command:
    """What a message says, whatever it is like; ``contract`` says whether it is well formed."""
    points = message.points
    return Command(
        joint_names=tuple(message.joint_names),
        times=[p.time_from_start.to_nsec() for p in points],
        positions=[p.positions for p in points],
        velocities=[p.velocities for p in points],
        accelerations=[p.accelerations for p in points],
        stamp=message.header.stamp.to_nsec(),
    )


# What RViz shows


def pose_message(T: np.ndarray) -> Pose:
    """A pose (4, 4), m, as position and quaternion."""
    quaternion = Rotation.from_matrix(T[:3, :3]).as_quat().tolist()
    return Pose(Point(*T[:3, 3].tolist()), Quaternion(*quaternion))


def path_message(poses: np.ndarray) -> Path:
    """Poses (n, 4, 4) of the tool in ``base_link``, m, as a path."""
    path = Path()
    path.header.frame_id = arm.BASE_FRAME
    for T in poses:
        stamped = PoseStamped(pose=pose_message(T))
        stamped.header.frame_id = arm.BASE_FRAME
        path.poses.append(stamped)
    return path


def checkpoint_markers(checkpoints: np.ndarray) -> MarkerArray:
    """Checkpoints in visiting order as spheres, their numbers from 1 on, and their frames.

    The first marker deletes what was shown before, so that a shorter tour leaves nothing behind.

    Args:
        checkpoints: (n, 4, 4) in ``base_link``, m.
    """
    markers = []
    for number, T in enumerate(checkpoints, start=1):
        markers += [_sphere(T), _number(T, str(number)), _frame(T)]
    return _instead_of_before(markers)


def segment_markers(tracks: list[Track]) -> MarkerArray:
    """The tool's way, each segment in the colour of its kind; what is no line is named as well."""
    markers = []
    for track in tracks:
        colour = ColorRGBA(*rgb(KIND_COLOURS[track.segment.kind]), 1.0)
        markers.append(_way(track.tool, colour))
        if track.segment.kind != "line":
            late = track.tool[3 * len(track.tool) // 4]  # where segments have parted already
            markers.append(_label(late, track.segment.kind, colour))
    return _instead_of_before(markers)


def trail_marker(points: np.ndarray) -> Marker:
    """Where the tool has been, (n, 3) in ``base_link``, m, as beads on its way."""
    marker = Marker(
        ns="trail",
        type=Marker.SPHERE_LIST,
        pose=pose_message(np.eye(4)),
        scale=Vector3(BEAD_DIAMETER, BEAD_DIAMETER, BEAD_DIAMETER),
        color=ColorRGBA(*rgb(ORANGE), 1.0),
        points=[Point(*point) for point in points.tolist()],
    )
    marker.header.frame_id = arm.BASE_FRAME
    return marker


def ghost_markers(shapes: list[Shape], poses: np.ndarray) -> MarkerArray:
    """The arm's shapes at poses (n, 4, 4) in ``base_link``, m, translucent."""
    return _instead_of_before([_ghost(shape, T) for shape, T in zip(shapes, poses)])


def _instead_of_before(markers: list[Marker]) -> MarkerArray:
    """Markers in ``base_link`` with ids of their own, after one that deletes what was shown."""
    markers = [Marker(action=Marker.DELETEALL), *markers]
    for i, marker in enumerate(markers):
        marker.id = i
        marker.header.frame_id = arm.BASE_FRAME
    return MarkerArray(markers)


def _sphere(T: np.ndarray) -> Marker:
    return Marker(
        ns="checkpoints",
        type=Marker.SPHERE,
        pose=pose_message(T),
        scale=Vector3(SPHERE_DIAMETER, SPHERE_DIAMETER, SPHERE_DIAMETER),
        color=ColorRGBA(*rgb(VERMILLION), 1.0),
    )


def _number(T: np.ndarray, text: str) -> Marker:
    return _text("numbers", T, NUMBER_HEIGHT, NUMBER_HEIGHT, OPAQUE_BLACK, text)


def _frame(T: np.ndarray) -> Marker:
    """Three lines from the origin along x, y and z."""
    ends = [Point(*end) for end in (AXIS_LENGTH * np.eye(3)).tolist()]
    return Marker(
        ns="frames",
        type=Marker.LINE_LIST,
        pose=pose_message(T),
        scale=Vector3(x=0.004),
        points=[point for end in ends for point in (Point(), end)],
        colors=[color for color in AXIS_COLORS for _ in range(2)],
        color=OPAQUE_BLACK,  # RViz takes those above, but warns of a marker that is transparent
    )


def _way(points: np.ndarray, colour: ColorRGBA) -> Marker:
    return Marker(
        ns="segments",
        type=Marker.LINE_STRIP,
        pose=pose_message(np.eye(4)),
        scale=Vector3(x=SEGMENT_WIDTH),
        points=[Point(*point) for point in points.tolist()],
        color=colour,
    )


def _label(point: np.ndarray, text: str, colour: ColorRGBA) -> Marker:
    T = np.eye(4)
    T[:3, 3] = point
    return _text("kinds", T, LABEL_HEIGHT, 2 * LABEL_HEIGHT, colour, text)


def _text(namespace, T: np.ndarray, height, above, colour: ColorRGBA, text: str) -> Marker:
    """A text of a height, so far above the origin of T (4, 4), in m."""
    pose = pose_message(T)
    pose.position.z += above
    return Marker(
        ns=namespace,
        type=Marker.TEXT_VIEW_FACING,
        pose=pose,
        scale=Vector3(z=height),
        color=colour,
        text=text,
    )


def _ghost(shape: Shape, T: np.ndarray) -> Marker:
    return Marker(
        ns="goal",
        type=Marker.CUBE if shape.kind == BOX else Marker.CYLINDER,
        pose=pose_message(T),
        scale=Vector3(*shape.size.tolist()),
        color=ColorRGBA(*shape.colour[:3], GHOST_OPACITY),
    )
