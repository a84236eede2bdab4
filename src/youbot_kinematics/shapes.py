"""What the arm looks like: the boxes and cylinders of its URDF, and where they are.

Pictures of the arm that RViz does not draw by itself are made of these: the page of a plan, and the
translucent arm at the goal. The URDF says how its shapes lie when all joints are at zero, and
forward kinematics how each moves from there.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.spatial.transform import Rotation

from . import arm
from .exceptions import InputError
from .kdl import chain_joints, read_urdf
from .kinematics import dh_frames
from .resources import resource_path

BOX, CYLINDER = "box", "cylinder"
SIDES = 24  # of the prism that is drawn for a cylinder


class Shape(NamedTuple):
    """A box, or a cylinder whose axis is z, that is fixed to one of the arm's frames."""

    kind: str  # "box" or "cylinder"
    size: np.ndarray  # of the box around it along its own x, y, z, (3,) m
    colour: tuple[float, ...]  # red, green, blue, opacity, 0 to 1
    frame: int  # Denavit-Hartenberg frame that it moves with: 0 the base, 5 the tool
    T_frame_shape: np.ndarray  # pose of its centre, (4, 4), m


def arm_shapes() -> list[Shape]:
    """The shapes of the package's URDF, from the base to the tool.

    Raises:
        InputError: the URDF's parser is missing, or the URDF draws something else.
    """
    path = resource_path("urdf/youbot_arm.urdf")
    robot = read_urdf(path)
    colours = {material.name: material.color.rgba for material in robot.materials}
    frames = dh_frames(np.zeros(arm.DOF))
    T_base_link, frame, shapes = np.eye(4), 0, []
    for joint in chain_joints(robot, path):
        T_base_link = T_base_link @ _transform(joint.origin)
        frame += joint.type != "fixed"
        T_frame_link = np.linalg.solve(frames[frame], T_base_link)
        for visual in robot.link_map[joint.child].visuals:
            colour = colours[visual.material.name]
            shapes.append(_shape(visual, colour, frame, T_frame_link @ _transform(visual.origin)))
    return shapes


def shape_poses(shapes: list[Shape], q) -> np.ndarray:
    """Poses (n, 4, 4) in ``base_link``, m, of n shapes with the joints at q (5,), rad."""
    frames = dh_frames(np.asarray(q, dtype=float))
    return np.stack([frames[shape.frame] @ shape.T_frame_shape for shape in shapes])


def mesh(shape: Shape) -> tuple[np.ndarray, np.ndarray]:
    """A shape's surface: vertices (v, 3) in its Denavit-Hartenberg frame, m, and triangles (f, 3).

    The triangles are indices of vertices. Both kinds are prisms: a cylinder's has many sides.
    """
    if shape.kind == BOX:
        x, y = np.array([[-1, 1, 1, -1], [-1, -1, 1, 1]]) / 2
    else:
        angle = np.linspace(0.0, 2 * np.pi, SIDES, endpoint=False)
        x, y = np.cos(angle) / 2, np.sin(angle) / 2
    n = len(x)
    bottom = np.column_stack([x, y, np.full(n, -0.5)])
    centres = [[0.0, 0.0, -0.5], [0.0, 0.0, 0.5]]
    vertices = np.vstack([bottom, bottom + [0.0, 0.0, 1.0], centres]) * shape.size
    a = np.arange(n)
    b = (a + 1) % n
    below, above = np.full(n, 2 * n), np.full(n, 2 * n + 1)
    triangles = [(a, b, n + a), (b, n + b, n + a), (below, b, a), (above, n + a, n + b)]
    R, p = shape.T_frame_shape[:3, :3], shape.T_frame_shape[:3, 3]
    return vertices @ R.T + p, np.vstack([np.column_stack(each) for each in triangles])


def _shape(visual, colour, frame: int, T_frame_shape) -> Shape:
    geometry = visual.geometry
    if hasattr(geometry, "size"):
        kind, size = BOX, geometry.size
    elif hasattr(geometry, "radius") and hasattr(geometry, "length"):
        kind, size = CYLINDER, (2 * geometry.radius, 2 * geometry.radius, geometry.length)
    else:
        raise InputError(f"the URDF draws a {type(geometry).__name__}: not a box, nor a cylinder")
    return Shape(kind, np.array(size, dtype=float), tuple(colour), frame, T_frame_shape)


def _transform(origin) -> np.ndarray:
    """A URDF origin (m, rad; none given is the identity) as a transform (4, 4)."""
    T = np.eye(4)
    if origin is not None:
        T[:3, :3] = Rotation.from_euler("xyz", origin.rpy or [0, 0, 0]).as_matrix()
        T[:3, 3] = origin.xyz or [0, 0, 0]
    return T
