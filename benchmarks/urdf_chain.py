"""The arm's chain of joints, read from its URDF with no code of the package."""

from __future__ import annotations

from importlib import import_module
from typing import NamedTuple
from xml.etree import ElementTree


class UrdfJoint(NamedTuple):
    """A joint, by the link that it moves."""

    link: str
    fixed: bool
    xyz: list  # where it is in the parent's frame, m
    rpy: list  # rad
    axis: list  # that it turns about, in its own frame


def urdf_chain(path, base="base_link", tool="arm_link_ee"):
    """The joints from base to tool."""
    joints = {j.find("child").get("link"): j for j in ElementTree.parse(path).iter("joint")}
    chain = []
    while tool != base:
        joint = joints[tool]
        xyz, rpy = (_floats(joint.find("origin"), key) for key in ("xyz", "rpy"))
        axis = _floats(joint.find("axis"), "xyz")
        chain.append(UrdfJoint(tool, joint.get("type") == "fixed", xyz, rpy, axis))
        tool = joint.find("parent").get("link")
    return chain[::-1]


def kdl_chain(path):
    """The same as PyKDL's chain."""
    kdl = import_module("PyKDL")  # here, since others need only the numbers
    chain = kdl.Chain()
    for link, fixed, xyz, rpy, axis in urdf_chain(path):
        frame = kdl.Frame(kdl.Rotation.RPY(*rpy), kdl.Vector(*xyz))
        if fixed:
            moving = kdl.Joint(link, kdl.Joint.Fixed)
        else:
            moving = kdl.Joint(link, frame.p, frame.M * kdl.Vector(*axis), kdl.Joint.RotAxis)
        chain.addSegment(kdl.Segment(link, moving, frame))
    return chain


def _floats(element, key):
    text = "0 0 0" if element is None else element.get(key, "0 0 0")
    return [float(x) for x in text.split()]
