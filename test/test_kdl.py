"""The Denavit-Hartenberg table and the URDF describe one arm; no URDF but this arm's is taken."""

import builtins

import numpy as np
import pytest

from youbot_kinematics import InputError, YoubotKinematics, arm
from youbot_kinematics.kdl import YoubotKDL
from youbot_kinematics.resources import resource_path

pytest.importorskip("PyKDL")
pytest.importorskip("urdf_parser_py")

DH, KDL = YoubotKinematics(), YoubotKDL()
URDF = resource_path("urdf/youbot_arm.urdf").read_text()


def random_joints(n, seed=0):
    return np.random.default_rng(seed).uniform(KDL.limits.lower, KDL.limits.upper, (n, 5))


def load(tmp_path, text):
    path = tmp_path / "arm.urdf"
    path.write_text(text)
    return YoubotKDL(path)


def test_forward_kinematics_agrees_with_denavit_hartenberg_on_10000_joints():
    q = random_joints(10_000)
    assert np.abs(KDL.forward_kinematics(q) - DH.forward_kinematics(q)).max() < 1e-9


def test_the_jacobian_agrees_with_denavit_hartenberg_on_10000_joints():
    q = random_joints(10_000)
    assert np.abs(KDL.get_jacobian(q) - DH.get_jacobian(q)).max() < 1e-9


def test_the_singularity_check_is_the_same():
    q = random_joints(200)
    q[:50, 2] = np.deg2rad(-146)
    assert (KDL.check_singularity(q) == DH.check_singularity(q)).all()
    assert KDL.check_singularity(q[0]) is True


def test_intermediate_frames_are_the_links_of_the_urdf():
    q = np.zeros(5)
    assert (KDL.forward_kinematics(q, 0) == np.eye(4)).all()
    assert np.allclose(KDL.forward_kinematics(q, 1)[:3, 3], [0, 0, 0.126])
    for joint in (2, 3, 4):  # on joint `joint`, where Denavit-Hartenberg has the frame before
        origin = DH.forward_kinematics(q, joint - 1)[:3, 3]
        assert np.allclose(KDL.forward_kinematics(q, joint)[:3, 3], origin)
    assert np.allclose(KDL.forward_kinematics(q, 5), DH.forward_kinematics(q))


def test_a_batch_of_any_shape_gives_what_its_members_give():
    q = random_joints(6).reshape(2, 3, 5)
    assert (KDL.forward_kinematics(q)[1, 2] == KDL.forward_kinematics(q[1, 2])).all()
    assert (KDL.get_jacobian(q)[1, 2] == KDL.get_jacobian(q[1, 2])).all()
    assert KDL.forward_kinematics(q[:0]).shape == (0, 3, 4, 4)


def test_limits_come_from_the_urdf_unless_others_are_given():
    for ours, table in zip(KDL.limits, arm.LIMITS["urdf"]):
        assert np.allclose(ours, table, rtol=0, atol=1e-12)
    assert YoubotKDL(limits="hardware").limits is arm.LIMITS["hardware"]


@pytest.mark.parametrize("q", [[0] * 4, [np.nan] * 5, "folded"])
def test_joints_that_are_none_are_refused(q):
    for function in (KDL.forward_kinematics, KDL.get_jacobian):
        with pytest.raises(InputError, match="joint positions must"):
            function(q)
    with pytest.raises(InputError, match="integer 0 to 5"):
        KDL.forward_kinematics([0] * 5, up_to_joint=6)


def test_a_missing_urdf_is_named(tmp_path):
    with pytest.raises(InputError, match=r"cannot read the URDF .*nowhere\.urdf: No such file"):
        YoubotKDL(tmp_path / "nowhere.urdf")
    with pytest.raises(InputError, match="cannot read the URDF"):
        YoubotKDL(tmp_path)


@pytest.mark.parametrize(
    ("old", "new", "sentence"),
    [
        ("</robot>", "", "is not XML"),
        ("<robot ", "<!DOCTYPE robot><robot ", "has a DOCTYPE"),
        ("<robot name", "<sdf name", "is not XML"),
        ('xyz="0 0 0.155"', 'xyz="0 0"', "is not a valid URDF"),
        ('xyz="0 0 0.155" rpy="0 2', 'xyz="0 0 nan" rpy="0 2', "not finite"),
        ('<axis xyz="0 1 0"/>', '<axis xyz="0 0 0"/>', "axis of zeros"),
        ('upper="2.70526034059"', 'upper="-1"', "leave it no range"),
        ('upper="2.70526034059"', 'upper="inf"', "not finite"),
        ('"arm_joint_2" type="revolute"', '"arm_joint_2" type="fixed"', "must move by arm_joint_1"),
        ('"arm_joint_2" type="revolute"', '"arm_joint_2" type="prismatic"', "prismatic"),
        ('"arm_joint_2" type="revolute"', '"shoulder" type="revolute"', "it has arm_joint_1"),
        ('child link="arm_link_ee"', 'child link="arm_link_1"', "no chain from base_link"),
        ('parent link="base_link"', 'parent link="arm_link_5"', "no chain from base_link"),
    ],
)
def test_a_urdf_of_no_such_arm_is_refused_with_one_sentence(tmp_path, old, new, sentence):
    assert old in URDF
    with pytest.raises(InputError, match=sentence) as refusal:
        load(tmp_path, URDF.replace(old, new))
    assert "\n" not in str(refusal.value)


def test_a_urdf_without_a_limit_is_refused(tmp_path):
    text = URDF.replace(
        '<limit lower="0" upper="2.70526034059" velocity="1.5707963267949" effort="9.5"/>', ""
    )
    with pytest.raises(InputError, match="no limit for arm_joint_2"):
        load(tmp_path, text)


def test_entities_neither_expand_nor_read_other_files(tmp_path):
    bomb = '<!DOCTYPE r [<!ENTITY a "aaaaaaaaaa"><!ENTITY b "&a;&a;&a;&a;">]><robot name="&b;"/>'
    secret = '<!DOCTYPE r [<!ENTITY a SYSTEM "file:///etc/hostname">]><robot name="x">&a;</robot>'
    for text in (bomb, secret):
        with pytest.raises(InputError, match="DOCTYPE"):
            load(tmp_path, text)


def test_without_kdl_the_refusal_says_what_to_install(monkeypatch):
    real = builtins.__import__

    def without_kdl(name, *arguments, **named):
        if name == "PyKDL":
            raise ImportError("No module named 'PyKDL'")
        return real(name, *arguments, **named)

    monkeypatch.setattr(builtins, "__import__", without_kdl)
    with pytest.raises(InputError, match=r"apt-get install python3-pykdl"):
        YoubotKDL()
