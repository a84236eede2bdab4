"""ROS 1 bags without ROS: those that are whole, and what a killed recorder left of one.

A bag is a header, then chunks of messages, each with an index behind it, then an index of all.
Nothing that it says about itself is believed: a chunk is unpacked no further than a limit, and the
messages must be as many as the index lists. So a bag is read as a whole or not at all, but for one
whose index was never written: its whole messages are recovered, and ``warning`` says so.
"""

from __future__ import annotations

import bz2
import os
import struct
from contextlib import contextmanager
from dataclasses import dataclass, field
from functools import lru_cache
from pathlib import Path
from typing import Iterator, NamedTuple

import lz4.frame
from rosbags.typesys import Stores, get_typestore

from . import bag_records
from .bag_records import CutShortError, Read, Record, read_record, records
from .exceptions import BagError

MAGIC = b"#ROSBAG V2.0\n"

# Bytes. What can be meant as a list of targets is smaller; what is larger is refused, not read.
_CHUNK_LIMIT = 64 << 20  # of a chunk once it is unpacked
_MESSAGE_LIMIT = 16 << 20  # of one message, which grows tenfold as Python's objects
_MESSAGES_LIMIT = 64 << 20  # of all messages of a topic

_DECOMPRESSORS = {"bz2": bz2.BZ2Decompressor, "lz4": lz4.frame.LZ4FrameDecompressor}


class Connection(NamedTuple):
    """One publisher on a topic."""

    id: int
    topic: str
    msgtype: str  # in rosbags' words, "sensor_msgs/msg/JointState"
    md5sum: str  # of the definition of its messages
    msgcount: int


@dataclass
class _Chunk:
    begin: int  # of its bytes in the file
    end: int
    compression: str
    size: int  # bytes of it once it is unpacked
    finished: bool = True
    counts: dict[int, int] = field(default_factory=dict)  # of messages, by connection


@lru_cache(maxsize=None)
def noetic_types():
    """The message definitions of ROS Noetic."""
    return get_typestore(Stores.ROS1_NOETIC)


@contextmanager
def open_rosbag1(path: Path):
    """Yields the ``Rosbag1`` in a file.

    Raises:
        BagError: it is damaged or cut short.
        OSError: it cannot be read.
    """
    with path.open("rb") as file:

        def read(at: int, size: int) -> bytes:
            return os.pread(file.fileno(), size, at)

        yield Rosbag1(read, os.fstat(file.fileno()).st_size)


class Rosbag1:
    """A bag's connections and messages.

    Attributes:
        warning: what is lost of a bag without an index, for people; empty for any other.
    """

    def __init__(self, read: Read, size: int):
        self._read = read
        self._connections: dict[int, Connection] = {}
        self._chunks: list[_Chunk] = []
        self.warning = ""
        header = read_record(read, len(MAGIC), size)
        if header.op != bag_records.BAG_HEADER or header.fields.get("encryptor"):
            raise BagError("the bag is encrypted, or its header is damaged")
        if header.number("index_pos", "<Q"):
            self._scan(header, size)
        else:
            self._recover(header.end, size)

    @property
    def connections(self) -> list[Connection]:
        """All that was recorded, each with its number of messages."""
        return [
            each._replace(msgcount=sum(chunk.counts.get(each.id, 0) for chunk in self._chunks))
            for each in self._connections.values()
        ]

    def messages(self, connections) -> Iterator[tuple[Connection, int, bytes]]:
        """The messages of some connections in order of time: connection, time in ns, bytes.

        Raises:
            BagError: they are damaged, too large, or not those that the index lists.
        """
        wanted = {connection.id: connection for connection in connections}
        for connection in connections:
            _require_noetic(connection)
        found, size = [], 0
        for chunk in self._chunks:
            if not chunk.counts.keys().isdisjoint(wanted):
                for message in self._messages_in(chunk, wanted):
                    found.append(message)
                    size += len(message[-1])
                    if size > _MESSAGES_LIMIT:
                        raise BagError(f"its messages have more than {_MESSAGES_LIMIT:,} bytes")
        found.sort(key=lambda message: message[1])
        yield from found

    def deserialize(self, raw: bytes, msgtype: str):
        """A message from its bytes."""
        return noetic_types().deserialize_ros1(raw, msgtype)

    def _scan(self, header: Record, size: int) -> None:
        """Finds the chunks and connections of a bag that has its index."""
        connections, chunk_infos = 0, 0
        for record in records(self._read, header.end, size):
            if record.op == bag_records.CHUNK:
                self._chunks.append(_chunk(record))
            elif record.op == bag_records.INDEX:
                self._chunks[-1].counts[record.number("conn")] = record.number("count")
            elif record.op == bag_records.CONNECTION:
                self._connect(record, self._read)
                connections += 1
            elif record.op == bag_records.CHUNK_INFO:
                chunk_infos += 1
            else:
                raise BagError(f"a record of type {record.op} does not belong there")
        counted, chunks = header.number("conn_count"), header.number("chunk_count")
        if (connections, chunk_infos, len(self._chunks)) != (counted, chunks, chunks):
            raise CutShortError(f"it has not the {chunks} chunks, {counted} connections it counts")

    def _recover(self, at: int, size: int) -> None:
        """Finds what is there of a bag whose recorder was killed before it wrote the index."""
        while at < size:
            try:
                record = read_record(self._read, at, size, cut=True)
            except CutShortError:
                break
            at = record.end
            if record.op == bag_records.CHUNK:
                chunk = _chunk(record)
                # The recorder writes a chunk's sizes, zero at first, when the chunk is finished.
                if chunk.size == 0 or chunk.end > size:
                    at = chunk.end = size
                    chunk.finished = False
                self._list_content(chunk)
                self._chunks.append(chunk)
        count = sum(connection.msgcount for connection in self.connections)
        self.warning = (
            f"the bag was never closed: recovered the {count} messages that are there as a whole,"
            " and what the recorder had yet to write is lost"
        )

    def _list_content(self, chunk: _Chunk) -> None:
        """Takes the connections in a chunk and counts its messages, for lack of an index."""
        content = self._content(chunk)
        for record in _chunk_records(content, chunk):
            if record.op == bag_records.CONNECTION:
                self._connect(record, bag_records.reader(content))
            else:
                c = record.number("conn")
                if c not in self._connections:
                    raise BagError(f"a message is of connection {c}, which is not described")
                chunk.counts[c] = chunk.counts.get(c, 0) + 1

    def _connect(self, record: Record, read: Read) -> None:
        """Takes the description of a connection, which may come again."""
        size = record.end - record.begin
        if size > _MESSAGE_LIMIT:
            raise BagError(f"a connection is described in {size:,} bytes")
        about = bag_records.named_values(read(record.begin, size))
        package, _, name = about["type"].decode().partition("/")
        topic, md5sum = record.fields["topic"].decode(), about["md5sum"].decode()
        new = Connection(record.number("conn"), topic, f"{package}/msg/{name}", md5sum, 0)
        if self._connections.setdefault(new.id, new) != new:
            raise BagError(f"connection {new.id} is described in two ways")

    def _messages_in(self, chunk: _Chunk, wanted) -> Iterator[tuple[Connection, int, bytes]]:
        """Connection, time in ns and bytes of each wanted message in a chunk."""
        content = self._content(chunk)
        counts = dict.fromkeys(wanted, 0)
        for record in _chunk_records(content, chunk):
            c = record.number("conn")
            if record.op == bag_records.MESSAGE and c in wanted:
                if record.end - record.begin > _MESSAGE_LIMIT:
                    raise BagError(f"a message has {record.end - record.begin:,} bytes")
                counts[c] += 1
                seconds, nanoseconds = struct.unpack("<LL", record.fields["time"])
                yield wanted[c], seconds * 10**9 + nanoseconds, content[record.begin : record.end]
        if any(count != chunk.counts.get(c, 0) for c, count in counts.items()):
            raise BagError("a chunk has not the messages that its index lists")

    def _content(self, chunk: _Chunk) -> bytes:
        """A chunk's bytes, unpacked.

        Raises:
            BagError: they are too many, or not as many as it says.
        """
        packed_size = chunk.end - chunk.begin
        if max(chunk.size, packed_size) > _CHUNK_LIMIT:
            raise BagError(f"a chunk has more than {_CHUNK_LIMIT:,} bytes: not read")
        content = self._read(chunk.begin, packed_size)
        if chunk.compression != "none":
            if chunk.compression not in _DECOMPRESSORS:
                raise BagError(f"compression {chunk.compression!r} is not known")
            decompressor = _DECOMPRESSORS[chunk.compression]()
            content = decompressor.decompress(content, (chunk.size or _CHUNK_LIMIT) + 1)
        if chunk.finished and len(content) != chunk.size:
            raise BagError(f"a chunk has not the {chunk.size:,} bytes that it says")
        return content


def _require_noetic(connection: Connection) -> None:
    """Raises BagError unless a connection's messages are defined as in ROS Noetic."""
    _, md5sum = noetic_types().generate_msgdef(connection.msgtype, ros_version=1)
    if connection.md5sum != md5sum:
        raise BagError(
            f"{connection.topic} is not of ROS Noetic's {connection.msgtype.replace('/msg/', '/')}:"
            f" the md5sum of its definition is {connection.md5sum}, not {md5sum}"
        )


def _chunk(record: Record) -> _Chunk:
    compression = record.fields["compression"].decode()
    return _Chunk(record.begin, record.end, compression, record.number("size"))


def _chunk_records(content: bytes, chunk: _Chunk) -> Iterator[Record]:
    """Connections and messages in a chunk; in one that is not finished, those that are whole."""
    read = bag_records.reader(content)
    for record in records(read, 0, len(content), cut=not chunk.finished):
        if record.op not in (bag_records.CONNECTION, bag_records.MESSAGE):
            raise BagError(f"a record of type {record.op} does not belong into a chunk")
        yield record
