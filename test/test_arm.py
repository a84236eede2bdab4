"""The arm's numbers: one set in Python, one in the URDF, and both the same."""

from xml.etree import ElementTree

import numpy as np
import pytest

from youbot_kinematics import InputError, YoubotKinematics, arm
from youbot_kinematics.resources import resource_path

URDF = ElementTree.parse(resource_path("urdf/youbot_arm.urdf")).getroot()
URDF_LIMITS = {joint.get("name"): joint.find("limit") for joint in URDF.iter("joint")}
URDF_INERTIALS = {link.get("name"): link.find("inertial") for link in URDF.iter("link")}


@pytest.mark.parametrize("field", arm.JointLimits._fields)
def test_the_urdf_gives_the_limits_of_the_urdf_profile(field):
    in_urdf = [float(URDF_LIMITS[name].get(field)) for name in arm.JOINT_NAMES]
    assert np.allclose(in_urdf, getattr(arm.LIMITS["urdf"], field), rtol=0, atol=1e-12)


def test_the_urdf_runs_from_the_base_frame_to_the_tool_frame():
    children = {joint.find("child").get("link") for joint in URDF.iter("joint")}
    parents = {joint.find("parent").get("link") for joint in URDF.iter("joint")}
    assert parents - children == {arm.BASE_FRAME}
    assert children - parents == {arm.TOOL_FRAME}


def test_every_inertia_in_the_urdf_is_one_that_a_body_can_have():
    bodies = [f"arm_link_{i}" for i in range(6)]
    for name in bodies:
        tensor = URDF_INERTIALS[name].find("inertia")
        smallest, middle, largest = sorted(
            float(tensor.get(axis)) for axis in ("ixx", "iyy", "izz")
        )
        assert smallest > 0 and smallest + middle > largest, name
    assert [name for name, inertial in URDF_INERTIALS.items() if inertial is not None] == bodies


def test_the_urdf_needs_no_mesh_files():
    assert not list(URDF.iter("mesh"))


def test_the_real_arm_accepts_nothing_that_the_description_refuses():
    urdf, hardware = arm.LIMITS["urdf"], arm.LIMITS["hardware"]
    assert (hardware.lower >= urdf.lower).all() and (hardware.upper <= urdf.upper).all()


def test_no_joint_turns_a_whole_turn_so_a_branch_has_one_solution_at_most():
    for limits in arm.LIMITS.values():
        assert (limits.upper - limits.lower < 2 * np.pi).all()


def test_the_upright_arm_stands_upright():
    tool = YoubotKinematics().forward_kinematics(arm.UPRIGHT)[:3, 3]
    # Reach: shoulder 33 mm out, tool offset 2 mm back. Height: the sum of all links.
    assert np.allclose(tool, [0.033 - 0.002, 0, 0.145 + 0.155 + 0.135 + 0.185], atol=1e-12)


def test_excess_is_negative_below_positive_above_and_zero_inside():
    limits = arm.LIMITS["urdf"]
    q = [limits.lower - 0.1, (limits.lower + limits.upper) / 2, limits.upper + 0.2]
    assert np.allclose(limits.excess(q), np.outer([-0.1, 0.0, 0.2], np.ones(5)))


def test_a_joint_exactly_on_its_limit_is_inside():
    limits = arm.LIMITS["hardware"]
    assert limits.contain([limits.lower, limits.upper]).all()
    assert not limits.contain(limits.upper + 1e-6)
    assert limits.contain(limits.upper + 1e-6, tolerance=2e-6)


def test_a_violation_is_described_by_the_joint_that_is_farthest_outside():
    text = arm.LIMITS["urdf"].describe_violation(np.array([6.0, 1.0, 0.5, 1.0, 1.0]))
    assert text == "arm_joint_3 at 0.5000 rad is 0.5 rad above its upper limit 0.0000 rad"


def test_an_unknown_limit_profile_is_refused_with_the_known_ones():
    with pytest.raises(InputError, match="choose one of urdf, hardware"):
        arm.joint_limits("simulation")


def test_own_limits_pass_through():
    own = arm.LIMITS["urdf"]._replace(lower=arm.LIMITS["hardware"].lower)
    assert YoubotKinematics(own).limits is own


def test_readings_from_the_upright_arm_convert_there_and_back():
    assert np.allclose(arm.from_upright(np.zeros(5)), arm.UPRIGHT)
    q = np.array([[1.0, 2.0, -3.0, 0.5, 4.0], [0.0, 0.0, 0.0, 0.0, 0.0]])
    assert np.allclose(arm.from_upright(arm.to_upright(q)), q, rtol=0, atol=1e-15)


def test_the_limits_as_readings_from_the_upright_arm_are_the_ones_that_sources_print():
    lower, upper = (np.rad2deg(arm.to_upright(limit)) for limit in arm.LIMITS["urdf"][:2])
    # Joint 1 counts from 170 degrees here and from 169 there.
    assert np.allclose(lower, [-170, -65, -151, -102.5, -167.5], atol=1e-6)
    assert np.allclose(upper, [168, 90, 146, 102.5, 167.5], atol=1e-6)


@pytest.mark.parametrize(
    ("lower", "sentence"),
    [
        (np.full(5, 7.0), "below its upper"),
        (np.zeros(4), "5 lower"),
        (np.full(5, -7.0), "whole turn"),
    ],
)
def test_own_limits_that_are_none_are_refused(lower, sentence):
    with pytest.raises(InputError, match=sentence):
        YoubotKinematics(arm.LIMITS["urdf"]._replace(lower=lower))
