"""Bags without ROS: the messages of one topic, and one sentence for all that can be wrong."""

from __future__ import annotations

import logging
from contextlib import contextmanager
from pathlib import Path

from .exceptions import BagError, InputError, YoubotError
from .rosbag1 import MAGIC, open_rosbag1
from .rosbag2 import METADATA, open_rosbag2

_log = logging.getLogger("youbot_kinematics")


@contextmanager
def one_sentence(path: Path):
    """Makes a BagError that begins with the bag's path of everything that goes wrong with it."""
    try:
        yield
    except InputError as error:
        raise BagError(printable(f"{path}: {error}")) from error
    except YoubotError:
        raise
    except Exception as error:
        if isinstance(error, OSError) and error.strerror:
            raise BagError(f"{path}: {error.strerror}") from error
        # Broken bytes surface as nearly anything: struct.error, KeyError, EOFError, AssertionError,
        # UnicodeDecodeError, a decompressor's own ... They all mean the same.
        detail = printable(str(error)[:80]).rstrip(".") or type(error).__name__
        raise BagError(f"{path}: the bag is damaged ({detail})") from error


@contextmanager
def open_bag(path: Path):
    """Yields the reader of a ROS 1 bag, or rosbags' own of a ROS 2 bag's folder.

    Raises:
        BagError: it is not a bag at first sight.
        OSError: it cannot be read; and ``one_sentence`` says what else.
    """
    _require_bag(path)
    if not path.is_dir():
        with open_rosbag1(path) as bag:
            if bag.warning:
                _log.warning("%s: %s", path, bag.warning)
            yield bag
        return
    with open_rosbag2(path) as reader:
        yield reader


def choose_topic(connections, topic: str, types, what: str) -> list:
    """The connections of the topic that is asked for, or of the only one that fits.

    Args:
        connections: those of a bag.
        topic: with or without the leading slash; found by itself if empty.
        types: the types of message, in rosbags' words, of which one fits.
        what: such messages hold, in the plural, for people.

    Raises:
        BagError: no topic or several topics fit.
    """
    by_name: dict[str, list] = {}
    for connection in connections:
        by_name.setdefault(connection.topic.strip("/"), []).append(connection)
    known = f"; types that can: {', '.join(map(ros1_name, types))}"
    if topic:
        chosen = by_name.get(topic.strip("/"))
        if chosen is None:
            raise BagError(f"no topic {topic}; it has {describe(connections)}")
    else:
        fitting = [each for each in by_name.values() if _fits(each, types)]
        if not fitting:
            raise BagError(f"no topic holds {what}; it has {describe(connections)}{known}")
        chosen = _only_one(fitting, what)
    if len({c.msgtype for c in chosen}) > 1:
        raise BagError(f"the topic has messages of several types: {describe(chosen)}")
    if not _fits(chosen, types):
        raise BagError(f"no {what} in {describe(chosen)}{known}")
    return chosen


def describe(connections) -> str:
    """Topics, types and numbers of messages, for people."""
    found = [f"{c.topic} ({ros1_name(c.msgtype)}, messages: {c.msgcount})" for c in connections]
    return ", ".join(found) or "no topics at all"


def ros1_name(msgtype: str) -> str:
    """``sensor_msgs/JointState`` for rosbags' ``sensor_msgs/msg/JointState``."""
    return msgtype.replace("/msg/", "/")


def _only_one(topics: list, what: str) -> list:
    if len(topics) > 1:
        names = describe([topic[0] for topic in topics])
        raise BagError(f"several topics can hold the {what}: choose by parameter 'topic': {names}")
    return topics[0]


def _fits(connections, types) -> bool:
    return any(c.msgtype in types and c.msgcount for c in connections)


def printable(text: str) -> str:
    """``text`` on one line, with ? for what a broken bag may do to a terminal."""
    return "".join(c if c.isprintable() else "?" for c in " ".join(text.split()))


def _require_bag(path: Path) -> None:
    """Raises BagError for what is not a bag at first sight, OSError for what cannot be read."""
    if path.is_dir():
        if not (path / METADATA).is_file():
            raise BagError(f"a folder, but without {METADATA} not a ROS 2 bag")
        return
    if path.exists() and not path.is_file():
        raise BagError("neither a file nor a folder")
    with path.open("rb") as file:
        start = file.read(len(MAGIC))
    if not start:
        raise BagError("the file is empty")
    if start != MAGIC:
        raise BagError("not a ROS bag of version 2.0: '#ROSBAG V2.0' is not its first line")
