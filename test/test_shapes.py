"""The arm's shapes are where the URDF has them, by KDL's word, and move with their links."""

from xml.etree import ElementTree

import numpy as np
import pytest

from youbot_kinematics.arm import LIMITS
from youbot_kinematics.kdl import YoubotKDL
from youbot_kinematics.resources import resource_path
from youbot_kinematics.shapes import arm_shapes, shape_poses

pytest.importorskip("PyKDL")
pytest.importorskip("urdf_parser_py")


def visuals():
    """Link, position in it (m) and size as it is written, of all shapes in the URDF."""
    for link in ElementTree.parse(resource_path("urdf/youbot_arm.urdf")).iter("link"):
        for visual in link.iter("visual"):
            xyz = [float(x) for x in visual.find("origin").get("xyz").split()]
            yield link.get("name"), xyz, visual.find("geometry")[0]


def test_every_shape_of_the_urdf_is_there_with_its_size_and_colour():
    shapes = arm_shapes()
    for shape, (_, _, geometry) in zip(shapes, visuals()):
        assert shape.kind == geometry.tag
        if shape.kind == "box":
            assert shape.size.tolist() == [float(x) for x in geometry.get("size").split()]
        else:
            assert shape.size[2] == float(geometry.get("length"))
            assert shape.size[0] == shape.size[1] == 2 * float(geometry.get("radius"))
    assert len(shapes) == len(list(visuals()))
    assert {shape.colour for shape in shapes} == {(0.95, 0.42, 0.05, 1), (0.13, 0.13, 0.14, 1)}


def test_shapes_are_on_their_links_wherever_the_joints_are():
    limits = LIMITS["urdf"]
    q = np.random.default_rng(7).uniform(limits.lower, limits.upper)
    kdl, poses = YoubotKDL(), shape_poses(arm_shapes(), q)
    for T, (link, xyz, _) in zip(poses, visuals()):
        number = int(link[-1])
        T_link = kdl.forward_kinematics(q, number)
        back = [0.0, 0.0, 0.0]
        if number == 0:
            back = [0.024, 0.0, -0.030]  # from arm_link_0's frame to base_link's, and back
        if number == 5:
            back = [0.0, 0.0, 0.055]  # KDL's fifth frame is the tool's
        np.testing.assert_allclose(T[:3, 3], (T_link @ [*(np.array(xyz) - back), 1])[:3], atol=1e-9)
        assert abs(np.linalg.det(T) - 1) < 1e-9
