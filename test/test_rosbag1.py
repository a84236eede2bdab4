"""ROS 1 bags: what a killed recorder leaves is recovered; bombs and liars are refused, unread."""

import bz2
import struct
import tracemalloc
from pathlib import Path

import numpy as np
import pytest
from broken_bags import COMPRESSIONS, damaged, never_finished, real_bags, unindexed, write_topics
from fuzz import FINE, fuzz

from youbot_kinematics import arm
from youbot_kinematics.bag_writer import write_bag
from youbot_kinematics.exceptions import BagError
from youbot_kinematics.make_bag import FORMS, make_bag, random_joints
from youbot_kinematics.targets import Targets, load_targets

JOINTS = random_joints(4, 1, arm.joint_limits("urdf"))
STATES = FORMS["joint_state"].messages(Targets.from_joints(JOINTS))
DEMO = Path(__file__).parents[1] / "bags/demo.bag"
RECORDER_KILLED = "the bag was never closed"


@pytest.fixture
def bag(tmp_path):
    return tmp_path / "targets.bag"


def record(op, fields, data):
    """A record of a bag."""
    block = b""
    for name, value in {"op": bytes([op]), **fields}.items():
        entry = name.encode() + b"=" + value
        block += struct.pack("<L", len(entry)) + entry
    return struct.pack("<L", len(block)) + block + struct.pack("<L", len(data)) + data


def bag_of(chunk_size, content, compression=b"none", index_pos=10**4):
    """A bag of one chunk, which says that it unpacks to so many bytes."""
    header = {"index_pos": index_pos, "conn_count": 1, "chunk_count": 1}
    forms = {"index_pos": "<Q", "conn_count": "<L", "chunk_count": "<L"}
    fields = {name: struct.pack(forms[name], value) for name, value in header.items()}
    chunk = {"compression": compression, "size": struct.pack("<L", chunk_size)}
    md5sum = b"md5sum=3066dcd76a6cfaef579bd0f34173e9fd"
    values = [b"topic=goals", b"type=sensor_msgs/JointState", md5sum]
    about = b"".join(struct.pack("<L", len(value)) + value for value in values)
    zero = struct.pack("<L", 0)
    index = {"ver": b"\1\0\0\0", "conn": zero, "count": b"\1\0\0\0"}
    return b"".join(
        [
            b"#ROSBAG V2.0\n",
            record(3, fields, b" " * 100),
            record(5, chunk, content),
            record(4, index, bytes(12)),
            record(7, {"conn": zero, "topic": b"goals"}, about),
            record(6, {}, b""),
        ]
    )


def refusal(path):
    """The sentence with which a bag is refused, and the most memory in bytes that it took."""
    tracemalloc.start()
    try:
        with pytest.raises(BagError) as error:
            load_targets(path)
        return str(error.value), tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()


# --- what a killed recorder leaves ----------------------------------------------------------------


@pytest.mark.parametrize("compression", COMPRESSIONS)
@pytest.mark.parametrize("form", FORMS)
def test_a_bag_that_lacks_its_index_is_recovered_with_a_warning(bag, form, compression):
    made = Targets.from_joints(JOINTS)
    write_topics(bag, {FORMS[form].topic: FORMS[form].messages(made)}, compression)
    whole = bag.read_bytes()
    assert load_targets(bag).warning == ""
    for left in (unindexed(whole), never_finished(whole)):
        bag.write_bytes(left)
        targets = load_targets(bag)
        np.testing.assert_allclose(targets.poses, made.poses, atol=1e-12)
        assert RECORDER_KILLED in targets.warning and bag.name in targets.warning


def test_a_program_that_reads_such_a_bag_says_so(bag, caplog):
    bag.write_bytes(never_finished(DEMO.read_bytes()))
    load_targets(bag)
    assert RECORDER_KILLED in caplog.text and caplog.records[0].levelname == "WARNING"


def test_of_an_unfinished_bag_every_whole_message_is_recovered_and_no_other(bag):
    write_bag(bag, "goals", STATES)
    whole = bag.read_bytes()
    found = []
    for lost in range(0, 900):
        bag.write_bytes(never_finished(whole, lost))
        try:
            joints = load_targets(bag).joints
        except BagError:
            joints = JOINTS[:0]
        np.testing.assert_array_equal(joints, JOINTS[: len(joints)])
        found.append(len(joints))
    assert found[:2] == [4, 3]  # a single byte less is a message less
    assert set(found) == {4, 3, 2, 1, 0} and sorted(found, reverse=True) == found


def test_zeros_at_the_end_of_an_unfinished_bag_are_not_taken_for_joints(bag):
    write_bag(bag, "goals", STATES)
    whole = bag.read_bytes()
    for lost in range(0, 300):  # as after a power cut: the file has its length, and not its bytes
        bag.write_bytes(never_finished(whole, lost) + bytes(4000))
        try:
            joints = load_targets(bag).joints
        except BagError:
            continue
        np.testing.assert_array_equal(joints, JOINTS[: len(joints)])
    bag.write_bytes(never_finished(whole) + bytes(4000))
    assert "there are zeros" in refusal(bag)[0]


def test_an_unfinished_bag_that_is_damaged_before_its_end_is_refused(bag):
    write_bag(bag, "goals", STATES)
    content = never_finished(bag.read_bytes())
    at = content.index(b"op=\x02") + 3  # of the first message
    bag.write_bytes(content[:at] + b"\x09" + content[at + 1 :])
    assert "type 9" in refusal(bag)[0]


@pytest.mark.parametrize("compression", COMPRESSIONS)
def test_what_the_real_recorder_leaves_is_recovered(bag, compression):
    rosbag = pytest.importorskip("rosbag")
    messages = pytest.importorskip("sensor_msgs.msg")
    file = rosbag.Bag(str(bag), "w", compression=compression, chunk_threshold=200)
    for q in JOINTS:
        file.write("goals", messages.JointState(position=q.tolist()))
    file._file.flush()  # as if it were killed here
    left = bag.read_bytes()
    file.close()
    bag.write_bytes(left)
    targets = load_targets(bag)
    assert RECORDER_KILLED in targets.warning
    np.testing.assert_array_equal(targets.joints, JOINTS[: len(targets)])
    assert len(targets) >= 3


# --- bombs and liars ------------------------------------------------------------------------------


@pytest.mark.parametrize("index_pos", [0, 10**4])
@pytest.mark.parametrize("compression", [b"none", b"bz2", b"lz4"])
def test_a_chunk_that_declares_4_gigabytes_is_not_allocated(bag, compression, index_pos):
    bag.write_bytes(bag_of(0xFFFFFFFF, bz2.compress(bytes(1000)), compression, index_pos))
    sentence, memory = refusal(bag)
    assert "more than 67,108,864 bytes" in sentence
    assert memory < 10e6


@pytest.fixture(scope="module")
def bomb():
    """200 MB in less than a kilobyte."""
    packer = bz2.BZ2Compressor()
    return b"".join([packer.compress(bytes(10**7)) for _ in range(20)] + [packer.flush()])


@pytest.mark.parametrize("index_pos", [0, 10**4])
@pytest.mark.parametrize("declared", [1, 1000, 2**26])
def test_a_bomb_is_unpacked_no_further_than_it_says(bag, bomb, declared, index_pos):
    assert len(bomb) < 1000
    bag.write_bytes(bag_of(declared, bomb, b"bz2", index_pos))
    sentence, memory = refusal(bag)
    assert f"has not the {declared:,} bytes that it says" in sentence
    assert memory < 150e6


def test_a_bomb_in_a_chunk_that_was_never_finished_goes_no_further_than_the_limit(bag, bomb):
    bag.write_bytes(never_finished(bag_of(1000, bomb, b"bz2")))
    _, memory = refusal(bag)
    assert memory < 300e6


def test_a_file_that_is_mostly_a_hole_is_not_read_into_memory(bag):
    bag.write_bytes(bag_of(1000, b""))
    with bag.open("r+b") as file:
        file.seek(bag.stat().st_size)
        file.write(struct.pack("<L", 0xF0000000))
        file.truncate(5 * 10**9)
    sentence, memory = refusal(bag)
    assert "header of a record" in sentence and memory < 10e6


def test_a_chunk_must_have_the_messages_that_its_index_lists(bag):
    write_bag(bag, "goals", STATES)
    content = bag.read_bytes()
    at = content.index(b"count=", content.index(b"op=\x04")) + len(b"count=")
    bag.write_bytes(content[:at] + struct.pack("<L", 3) + content[at + 4 :])
    assert "index" in refusal(bag)[0]


def test_messages_of_another_definition_are_refused(bag):
    write_bag(bag, "goals", STATES)
    content = bag.read_bytes()
    bag.write_bytes(content.replace(b"3066dcd76a6cfaef", b"0123456789abcdef"))
    assert "md5sum" in refusal(bag)[0]


def test_an_encrypted_bag_is_refused(bag):
    write_bag(bag, "goals", STATES)
    content = bag.read_bytes()
    header = content.index(b"\x04\x00\x00\x00op=\x03")
    field = b"encryptor=rosbag/AesCbcEncryptor"
    (size,) = struct.unpack("<L", content[header - 4 : header])
    entry = struct.pack("<L", len(field)) + field
    bigger = struct.pack("<L", size + len(entry)) + entry
    bag.write_bytes(content[: header - 4] + bigger + content[header:])
    assert "encrypted" in refusal(bag)[0]


def test_more_targets_than_can_be_meant_are_refused(bag, monkeypatch):
    make_bag(bag, Targets.from_joints(JOINTS))
    monkeypatch.setattr("youbot_kinematics.targets.MOST_TARGETS", 4)
    assert len(load_targets(bag)) == 4
    monkeypatch.setattr("youbot_kinematics.targets.MOST_TARGETS", 3)
    assert "more than 3 targets" in refusal(bag)[0]


# --- fuzzing: ./run fuzz does more of it ----------------------------------------------------------


def test_bags_with_random_damage_are_read_recovered_or_refused_in_a_sentence(tmp_path):
    outcomes, longest = fuzz(600, seed=12345, folder=tmp_path)
    assert set(outcomes) == set(FINE) and sum(outcomes.values()) == 600
    assert longest < 5.0


def test_random_damage_is_damage(tmp_path):
    bags = real_bags(tmp_path)
    rng = np.random.default_rng(1)
    assert all(damaged(bag, bags, rng) != bag for bag in bags)


def test_a_bag_made_by_make_bag_is_not_damaged(bag):
    make_bag(bag, Targets.from_joints(JOINTS))
    assert load_targets(bag).warning == "" and load_targets(DEMO).warning == ""
