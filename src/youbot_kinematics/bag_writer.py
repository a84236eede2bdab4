"""ROS 1 bags without ROS: messages by name and fields, written the same to the last byte."""

from __future__ import annotations

from rosbags.rosbag1 import Writer

from .exceptions import InputError
from .files import new_file
from .rosbag1 import noetic_types

_SECOND = 1_000_000_000  # ns

#: LZ4 is not among them: the frames that rosbags writes are not those that ROS's reader takes.
COMPRESSIONS = ("none", "bz2")


def make(msgtype: str, *values, **fields):
    """A message of a type such as ``sensor_msgs/JointState``, from its fields."""
    package, name = msgtype.split("/")
    return noetic_types().types[f"{package}/msg/{name}"](*values, **fields)


def make_header(frame: str = ""):
    """A header in a frame, with stamp zero: for a command, now."""
    return make("std_msgs/Header", 0, make_time(0), frame)


def make_time(nanoseconds: int):
    """A time, in whole seconds and nanoseconds."""
    return make("builtin_interfaces/Time", *divmod(nanoseconds, _SECOND))


def make_duration(nanoseconds: int):
    """A duration, in whole seconds and nanoseconds."""
    return make("builtin_interfaces/Duration", *divmod(nanoseconds, _SECOND))


def write_bag(path, topic: str, messages, compression: str = "none", force: bool = False) -> None:
    """Writes messages of one type to a bag, one a second from second 1 on.

    Args:
        path: the bag, which ends in ``.bag``.
        topic: the messages' topic.
        messages: one message or more, as ``make`` makes them.
        compression: of the bag's chunks, one of ``COMPRESSIONS``.
        force: whether it may replace a file.

    Raises:
        InputError: the file cannot be written.
    """
    if not str(path).endswith(".bag"):
        raise InputError(f"cannot write {path}: the name of a bag ends in .bag")
    types = noetic_types()
    with new_file(path, force) as unfinished:
        writer = Writer(unfinished)
        if compression != "none":
            writer.set_compression(Writer.CompressionFormat[compression.upper()])
        with writer:
            msgtype = messages[0].__msgtype__
            connection = writer.add_connection(topic, msgtype, typestore=types)
            for second, message in enumerate(messages, start=1):
                raw = types.serialize_ros1(message, msgtype)
                writer.write(connection, second * _SECOND, raw)
