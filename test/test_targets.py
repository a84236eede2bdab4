"""Bags of every form are read; what cannot be used ends in one sentence that says why."""

import os
from pathlib import Path

import numpy as np
import pytest
from broken_bags import write_topics
from rosbags.rosbag1 import Writer
from scipy.spatial.transform import Rotation

from youbot_kinematics import arm
from youbot_kinematics.bag_writer import COMPRESSIONS, make, make_header, write_bag
from youbot_kinematics.exceptions import BagError, InputError
from youbot_kinematics.kinematics import YoubotKinematics
from youbot_kinematics.make_bag import FORMS, make_bag, random_joints
from youbot_kinematics.targets import Targets, load_targets

LIMITS = arm.joint_limits("urdf")
JOINTS = random_joints(4, 1, LIMITS)
NONE = np.empty(0)
COURSE_BAG = Path(
    os.environ.get("YOUBOT_COURSE_BAG")
    or Path(__file__).parents[2] / "shared/bags/comp0127_cw2.bag"
)


def joint_state(names, positions):
    position = np.array(positions, dtype=float)
    return make("sensor_msgs/JointState", make_header(), list(names), position, NONE, NONE)


def pose(position=(0.2, 0.1, 0.3), quaternion=(0.0, 0.0, 0.0, 1.0)):
    return make(
        "geometry_msgs/Pose",
        make("geometry_msgs/Point", *position),
        make("geometry_msgs/Quaternion", *quaternion),
    )


@pytest.fixture
def bag(tmp_path):
    return tmp_path / "targets.bag"


def refusal(bag, **options):
    """The sentence with which a bag is refused: one line, and it names the bag."""
    with pytest.raises(BagError) as error:
        load_targets(bag, **options)
    sentence = str(error.value)
    assert sentence.isprintable() and Path(bag).name in sentence
    return sentence


# --- what is read ---------------------------------------------------------------------------------


@pytest.mark.parametrize("compression", COMPRESSIONS)
@pytest.mark.parametrize("form", FORMS)
def test_a_bag_of_every_form_gives_back_the_targets_it_was_made_of(bag, form, compression):
    made = Targets.from_joints(JOINTS)
    make_bag(bag, made, form, compression=compression)
    read = load_targets(bag)
    np.testing.assert_allclose(read.poses, made.poses, atol=1e-12)
    if "joint" in form:
        np.testing.assert_array_equal(read.joints, JOINTS)
    else:
        assert read.joints is None
    assert FORMS[form].topic in read.source and bag.name in read.source


@pytest.mark.skipif(not COURSE_BAG.exists(), reason="the course's bag is not here")
def test_the_courses_own_bag_is_read():
    targets = load_targets(COURSE_BAG)
    assert len(targets) == 4
    first = [4.62257656, 1.49199568, -2.44350691, 2.09365912, 0.99909748]
    np.testing.assert_allclose(targets.joints[0], first, atol=1e-8)


def test_a_bag_compressed_by_lz4_is_read(bag):
    write_topics(bag, {"goals": [joint_state([], q) for q in JOINTS]}, "lz4")
    np.testing.assert_array_equal(load_targets(bag).joints, JOINTS)


def test_other_joints_are_passed_over_and_the_order_of_names_does_not_matter(bag):
    names = ["wheel_fl", *arm.JOINT_NAMES[::-1], "gripper_finger_joint_l"]
    write_bag(bag, "t", [joint_state(names, [9.0, *JOINTS[0, ::-1], 9.0])])
    np.testing.assert_array_equal(load_targets(bag).joints, JOINTS[:1])


def test_the_only_topic_that_fits_is_found_among_others(bag):
    other = make("std_msgs/String", "hello")
    write_topics(bag, {"/chatter": [other], "/goals": [joint_state([], q) for q in JOINTS]})
    assert "/goals" in load_targets(bag).source


@pytest.mark.parametrize("asked", ["goals", "/goals"])
@pytest.mark.parametrize("recorded", ["goals", "/goals"])
def test_a_topic_is_the_same_with_and_without_its_leading_slash(bag, recorded, asked):
    write_topics(bag, {recorded: [joint_state([], JOINTS[0])], "/poses": [pose()]})
    assert load_targets(bag, topic=asked).joints is not None


def test_a_topic_recorded_from_two_publishers_is_one_topic_in_order_of_time(bag):
    states = [joint_state([], q) for q in JOINTS]
    write_topics(bag, {"goals": states[:1], "/goals": states[1:3]})
    assert len(load_targets(bag)) == 3


@pytest.mark.parametrize("frame", ["", "base_link", "/base_link"])
def test_poses_in_the_base_frame_are_read(bag, frame):
    write_bag(bag, "t", [make("geometry_msgs/PoseStamped", make_header(frame), pose())])
    np.testing.assert_array_equal(load_targets(bag).poses[0, :3, 3], [0.2, 0.1, 0.3])


def test_a_quaternion_that_was_rounded_is_normalised(bag):
    quaternion = Rotation.from_euler("z", 1.0).as_quat()
    write_bag(bag, "t", [pose(quaternion=quaternion * 1.0009)])
    R = load_targets(bag).poses[0, :3, :3]
    np.testing.assert_allclose(R, Rotation.from_quat(quaternion).as_matrix(), atol=1e-12)


def test_a_value_outside_of_its_limit_by_rounding_is_set_on_the_limit(bag):
    q = np.array([LIMITS.lower - 5e-7, LIMITS.upper + 5e-7])
    write_bag(bag, "t", [joint_state([], row) for row in q])
    np.testing.assert_array_equal(load_targets(bag).joints, [LIMITS.lower, LIMITS.upper])


def test_targets_come_in_the_order_of_time_and_may_be_many(bag):
    many = random_joints(3000, 5, LIMITS)
    make_bag(bag, Targets.from_joints(many), "unnamed_joint_state")
    np.testing.assert_array_equal(load_targets(bag).joints, many)


def write_rosbag2(folder, compression=None, **options):
    """A bag with the first of ``JOINTS``."""
    rosbag2 = pytest.importorskip("rosbags.rosbag2")
    from rosbags.typesys import Stores, get_typestore

    types = get_typestore(Stores.ROS2_HUMBLE)
    Header, Time = types.types["std_msgs/msg/Header"], types.types["builtin_interfaces/msg/Time"]
    JointState = types.types["sensor_msgs/msg/JointState"]
    message = JointState(Header(Time(0, 0), ""), list(arm.JOINT_NAMES), JOINTS[0], NONE, NONE)
    try:
        writer = rosbag2.Writer(folder, version=8, **options)
    except TypeError:  # rosbags before 0.10 has one version and one storage only
        writer = rosbag2.Writer(folder)
    if compression:
        writer.set_compression(compression, rosbag2.CompressionFormat.ZSTD)
    with writer:
        connection = writer.add_connection("/goals", JointState.__msgtype__, typestore=types)
        writer.write(connection, 10**9, types.serialize_cdr(message, JointState.__msgtype__))


def test_a_ros_2_bag_is_read_as_well(tmp_path):
    write_rosbag2(tmp_path / "bag")
    np.testing.assert_array_equal(load_targets(tmp_path / "bag").joints, JOINTS[:1])


def test_an_mcap_is_read_as_well(tmp_path):
    rosbag2 = pytest.importorskip("rosbags.rosbag2")
    storage = pytest.importorskip("rosbags.rosbag2.enums").StoragePlugin
    write_rosbag2(tmp_path / "bag", storage_plugin=storage.MCAP)
    np.testing.assert_array_equal(load_targets(tmp_path / "bag").joints, JOINTS[:1])
    write_rosbag2(tmp_path / "packed", rosbag2.CompressionMode.STORAGE, storage_plugin=storage.MCAP)
    assert "compressed ROS 2 bag" in refusal(tmp_path / "packed")


@pytest.mark.parametrize("mode", ["FILE", "MESSAGE"])
def test_a_compressed_ros_2_bag_which_could_be_of_any_size_is_refused(tmp_path, mode):
    rosbag2 = pytest.importorskip("rosbags.rosbag2")
    write_rosbag2(tmp_path / "bag", rosbag2.CompressionMode[mode])
    assert "compressed ROS 2 bag" in refusal(tmp_path / "bag")


@pytest.mark.parametrize("text", ["", "[1, 2]", "a: b", "rosbag2_bagfile_information: 3", "\t{"])
def test_a_folder_with_metadata_of_something_else_is_refused(tmp_path, text):
    (tmp_path / "metadata.yaml").write_text(text)
    assert str(tmp_path) in refusal(tmp_path)


# --- what is refused: the file --------------------------------------------------------------------


def test_files_that_are_no_bags_are_refused_by_what_they_are(tmp_path):
    empty, text, folder = tmp_path / "empty.bag", tmp_path / "text.bag", tmp_path / "folder"
    empty.touch()
    text.write_text("joint positions: 1 2 3 4 5\n")
    folder.mkdir()
    assert "empty" in refusal(empty)
    assert "not a ROS bag" in refusal(text)
    assert "metadata.yaml" in refusal(folder)
    assert "No such file" in refusal(tmp_path / "missing.bag")
    os.mkfifo(tmp_path / "pipe.bag")
    assert "neither a file" in refusal(tmp_path / "pipe.bag")


def test_a_bag_may_have_any_name(bag, tmp_path):
    make_bag(bag, Targets.from_joints(JOINTS))
    bag.rename(tmp_path / "targets.bag.active")
    assert len(load_targets(tmp_path / "targets.bag.active")) == len(JOINTS)


@pytest.mark.parametrize("compression", ["none", "bz2", "lz4"])
def test_a_bag_cut_short_anywhere_is_refused(bag, tmp_path, compression):
    write_topics(bag, {"goals": [joint_state([], q) for q in JOINTS]}, compression)
    whole = bag.read_bytes()
    cut = tmp_path / "cut.bag"
    inside_the_padding = range(200, 4000)
    for length in range(0, len(whole), 3):
        if length not in inside_the_padding:
            cut.write_bytes(whole[:length])
            refusal(cut)


def test_a_bag_with_any_byte_changed_is_read_or_refused(bag):
    make_bag(bag, Targets.from_joints(JOINTS[:2]), compression="bz2")
    whole = bag.read_bytes()
    rng = np.random.default_rng(0)
    for _ in range(300):
        content = bytearray(whole)
        beyond_the_padding = rng.integers(4100, len(whole))
        content[rng.choice([rng.integers(200), beyond_the_padding])] = rng.integers(256)
        bag.write_bytes(content)
        try:
            assert len(load_targets(bag)) == 2
        except BagError as error:
            assert str(error).isprintable() and len(str(error)) < 500


# --- what is refused: the topic -------------------------------------------------------------------


def test_a_bag_without_targets_is_told_what_it_has(bag):
    write_bag(bag, "/chatter", [make("std_msgs/String", "hello")])
    sentence = refusal(bag)
    assert "/chatter (std_msgs/String" in sentence and "sensor_msgs/JointState" in sentence


def test_several_fitting_topics_are_named_and_one_is_asked_for(bag):
    write_topics(bag, {"/a": [joint_state([], JOINTS[0])], "/b": [pose()]})
    sentence = refusal(bag)
    assert "/a" in sentence and "/b" in sentence and "topic" in sentence


def test_a_topic_that_is_not_in_the_bag_or_does_not_fit_is_refused(bag):
    write_topics(bag, {"/goals": [joint_state([], JOINTS[0])], "/s": [make("std_msgs/String", "")]})
    assert "no topic /gaols; it has /goals" in refusal(bag, topic="/gaols")
    assert "no targets in /s (std_msgs/String" in refusal(bag, topic="s")


def test_a_topic_of_two_message_types_is_refused(bag):
    write_topics(bag, {"/goals": [joint_state([], JOINTS[0])], "goals": [pose()]})
    assert "several types" in refusal(bag)


def test_a_bag_without_messages_is_refused(bag):
    with Writer(bag):
        pass
    assert "no topics at all" in refusal(bag)
    bag.unlink()
    trajectory = make("trajectory_msgs/JointTrajectory", make_header(), [], [])
    write_bag(bag, "/goals", [trajectory])
    assert "no targets in the messages of /goals" in refusal(bag)


def test_names_in_a_bag_cannot_speak_to_the_terminal(bag):
    write_topics(bag, {"/a": [joint_state([], JOINTS[0])], "/b\x1b[2J": [pose()]})
    assert "/b?[2J" in refusal(bag)


# --- what is refused: the values ------------------------------------------------------------------


@pytest.mark.parametrize(
    ("names", "positions", "part"),
    [
        ([], [0.1] * 4, "4 positions without names"),
        ([], [0.1] * 7, "7 positions without names"),
        (arm.JOINT_NAMES[:4], [0.1] * 4, "arm_joint_5 is missing"),
        ([*arm.JOINT_NAMES, "arm_joint_2"], [0.1] * 6, "arm_joint_2 is named twice"),
        (arm.JOINT_NAMES, [0.1] * 4, "4 positions for 5 joint names"),
        ([], [0.1, np.nan, -0.1, 0.1, 0.1], "arm_joint_2 is nan"),
        ([], [0.1, 0.1, -np.inf, 0.1, 0.1], "arm_joint_3 is -inf"),
    ],
)
def test_joints_that_are_not_the_arms_five_numbers_are_refused(bag, names, positions, part):
    write_bag(bag, "goals", [joint_state([], JOINTS[0]), joint_state(names, positions)])
    sentence = refusal(bag)
    assert part in sentence and "target 2 on goals" in sentence


def test_a_joint_outside_of_its_limits_is_named_with_its_value_and_limit(bag):
    q = JOINTS.copy()
    q[2, 3] = 3.6
    write_bag(bag, "goals", [joint_state([], row) for row in q])
    sentence = refusal(bag)
    assert "target 3 of 4" in sentence and "arm_joint_4 at 3.6000 rad" in sentence
    assert "3.5779" in sentence and "upright" not in sentence


def test_the_limits_are_those_of_the_profile(bag):
    write_bag(bag, "goals", [joint_state([], [0.005, 1, -1, 1, 1])])
    assert len(load_targets(bag)) == 1
    assert "0.0101" in refusal(bag, limits="hardware")
    with pytest.raises(InputError, match="no limit profile"):
        load_targets(bag, limits="none")


def test_readings_centred_on_the_upright_arm_are_hinted_at(bag):
    write_bag(bag, "goals", [joint_state([], q - arm.UPRIGHT) for q in JOINTS])
    assert "upright" in refusal(bag)


@pytest.mark.parametrize(
    ("quaternion", "part"),
    [
        ((0.0, 0.0, 0.0, 0.0), "norm 0 "),
        ((0.0, 0.0, 0.0, 1.002), "norm 1.002"),
        ((0.0, 0.0, 0.0, np.nan), "not finite"),
    ],
)
def test_a_quaternion_that_is_no_rotation_is_refused(bag, quaternion, part):
    write_bag(bag, "goals", [pose(quaternion=quaternion)])
    assert part in refusal(bag)


def test_a_pose_at_infinity_is_refused(bag):
    write_bag(bag, "goals", [pose((np.inf, 0.0, 0.0))])
    assert "not finite" in refusal(bag)


@pytest.mark.parametrize("kind", ["PoseStamped", "PoseArray", "TransformStamped"])
def test_targets_in_another_frame_are_refused_without_tf_and_taken_to_the_base_with_it(bag, kind):
    header = make_header("/camera")
    transform = make(
        "geometry_msgs/Transform",
        make("geometry_msgs/Vector3", 0.1, 0.2, 0.3),
        make("geometry_msgs/Quaternion", 0.0, 0.0, 0.0, 1.0),
    )
    in_camera = (0.1, 0.2, 0.3) if kind == "TransformStamped" else (0.2, 0.1, 0.3)
    contents = {
        "PoseStamped": [pose()],
        "PoseArray": [[pose()]],
        "TransformStamped": ["target", transform],
    }
    write_bag(bag, "goals", [make(f"geometry_msgs/{kind}", header, *contents[kind])])
    assert "'camera'" in refusal(bag)

    T_base_camera, asked = np.eye(4), []
    T_base_camera[:3] = [[0, -1, 0, 1], [1, 0, 0, 0], [0, 0, 1, 0]]
    targets = load_targets(bag, T_base_from=lambda frame: asked.append(frame) or T_base_camera)
    assert asked == ["camera"]
    expected = [1.0 - in_camera[1], in_camera[0], in_camera[2]]
    np.testing.assert_allclose(targets.poses[0, :3, 3], expected, atol=1e-15)
    np.testing.assert_allclose(targets.poses[0, :3, :3], T_base_camera[:3, :3], atol=1e-15)


def test_arrays_become_targets_under_the_same_rules():
    targets = Targets.from_joints(JOINTS.tolist())
    expected = YoubotKinematics().forward_kinematics(JOINTS)
    np.testing.assert_array_equal(targets.poses, expected)
    assert len(Targets.from_poses(targets.poses)) == 4
    for wrong in ([], JOINTS[0], JOINTS[:, :4], JOINTS + 10):
        with pytest.raises(InputError):
            Targets.from_joints(wrong)
    for wrong in (np.zeros((0, 4, 4)), np.eye(4), np.zeros((2, 4, 4))):
        with pytest.raises(InputError):
            Targets.from_poses(wrong)


# --- the real rosbag ------------------------------------------------------------------------------


@pytest.mark.parametrize("compression", ["none", "bz2", "lz4"])
def test_bags_that_the_real_rosbag_wrote_are_read(bag, compression):
    rosbag = pytest.importorskip("rosbag")
    messages = pytest.importorskip("sensor_msgs.msg")
    with rosbag.Bag(str(bag), "w", compression=compression) as file:
        for q in JOINTS:
            file.write("joint_data", messages.JointState(position=q.tolist()))
    np.testing.assert_array_equal(load_targets(bag).joints, JOINTS)


@pytest.mark.parametrize("compression", COMPRESSIONS)
@pytest.mark.parametrize("form", FORMS)
def test_the_real_rosbag_reads_the_bags_made_here(bag, form, compression):
    rosbag = pytest.importorskip("rosbag")
    make_bag(bag, Targets.from_joints(JOINTS), form, compression=compression)
    with rosbag.Bag(str(bag)) as file:
        topics = {topic for topic, _, _ in file.read_messages()}
    assert topics == {FORMS[form].topic}
