"""Bags as they should not be: without their index, never finished, or with random damage."""

import struct

import numpy as np
from rosbags.rosbag1 import Writer

from youbot_kinematics import arm
from youbot_kinematics.bag_writer import noetic_types
from youbot_kinematics.make_bag import FORMS, random_joints
from youbot_kinematics.targets import Targets

COMPRESSIONS = ("none", "bz2", "lz4")
TARGETS = 4
EXTREMES = (0, 1, 0x7FFFFFFF, 0x80000000, 0xFFFFFFFF)
PADDING = range(120, 4100)  # of a bag's header: damage there is none


def write_topics(path, topics, compression="none"):
    """A bag with several topics: name -> messages, one a second from the same time on."""
    types = noetic_types()
    writer = Writer(path)
    if compression != "none":
        writer.set_compression(Writer.CompressionFormat[compression.upper()])
    with writer:
        for topic, messages in topics.items():
            msgtype = messages[0].__msgtype__
            connection = writer.add_connection(topic, msgtype, typestore=types)
            for second, message in enumerate(messages, start=1):
                raw = types.serialize_ros1(message, msgtype)
                writer.write(connection, second * 10**9, raw)


def real_bags(folder):
    """A bag of each form in each compression, and what a killed recorder leaves of each."""
    targets = Targets.from_joints(random_joints(TARGETS, 3, arm.joint_limits("urdf")))
    bags = []
    for name, form in FORMS.items():
        for compression in COMPRESSIONS:
            path = folder / f"{name}_{compression}.bag"
            write_topics(path, {form.topic: form.messages(targets)}, compression)
            whole = path.read_bytes()
            bags += [whole, unindexed(whole), never_finished(whole)]
    return bags


def unindexed(bag: bytes) -> bytes:
    """What is left of a bag whose recorder is killed behind a chunk: no index."""
    at = bag.index(b"index_pos=") + len(b"index_pos=")
    (index,) = struct.unpack("<Q", bag[at : at + 8])
    return bag[:at] + bytes(8) + bag[at + 8 : index]


def never_finished(bag: bytes, lost: int = 0) -> bytes:
    """What is left of a bag whose recorder is killed inside of its only chunk.

    The chunk's sizes, unpacked and packed, are still zero, and its last bytes may be lost.
    """
    bag = unindexed(bag)
    sizes = bag.index(b"size=", bag.index(b"compression=")) + len(b"size=")
    begin = sizes + 8
    (packed,) = struct.unpack("<L", bag[begin - 4 : begin])
    return bag[:sizes] + bytes(8) + bag[begin : begin + packed - lost]


def damaged(bag: bytes, others, rng: np.random.Generator) -> bytes:
    """A bag with one to three damages."""
    for _ in range(rng.integers(1, 4)):
        damage = DAMAGES[rng.integers(len(DAMAGES))]
        bag = bytes(damage(bytearray(bag), _place(bag, rng), others, rng))
    return bag


def _place(bag, rng) -> int:
    """A place in a bag outside of its padding."""
    while True:
        at = int(rng.integers(max(len(bag), 1)))
        if at not in PADDING or rng.random() < 0.02:
            return at


def _flip(bag, at, _others, rng):
    bag[at : at + 1] = bytes(byte ^ 1 << rng.integers(8) for byte in bag[at : at + 1])
    return bag


def _number(bag, at, _others, rng):
    """A number, and lengths are numbers, becomes an extreme one."""
    bag[at : at + 4] = struct.pack("<L", EXTREMES[rng.integers(len(EXTREMES))])
    return bag


def _length(bag, at, _others, rng):
    """The four bytes before a header's field, a record's header or data, become another number."""
    at = bag.find(b"=", at)
    return _number(bag, max(at - int(rng.integers(4, 24)), 0), None, rng)


def _cut(bag, at, _others, _rng):
    return bag[:at]


def _remove(bag, at, _others, rng):
    del bag[at : at + int(rng.integers(1, 100))]
    return bag


def _repeat(bag, at, _others, rng):
    end = at + int(rng.integers(1, 1000))
    return bag[:end] + bag[at:end] + bag[end:]


def _zeros(bag, at, _others, rng):
    end = min(at + int(rng.integers(1, 500)), len(bag))
    return bag[:at] + bytes(end - at) + bag[end:]


def _noise(bag, at, _others, rng):
    return bag[:at] + rng.bytes(int(rng.integers(1, 100))) + bag[at:]


def _splice(bag, at, others, rng):
    """Goes on as another bag."""
    other = others[rng.integers(len(others))]
    return bag[:at] + other[_place(other, rng) :]


DAMAGES = (_flip, _number, _length, _cut, _remove, _repeat, _zeros, _noise, _splice)
