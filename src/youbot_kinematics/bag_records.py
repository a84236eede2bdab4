"""Records, of which a ROS 1 bag is made: http://wiki.ros.org/Bags/Format/2.0.

A record is a header of named values, and data. Before each stands its length, which is held against
what is there before anything is read: no length in a damaged bag makes anyone read, or allocate,
more than the bag has.
"""

from __future__ import annotations

import struct
from typing import Callable, Iterator, NamedTuple

from .exceptions import BagError

# What a record holds, by its ``op``.
MESSAGE, BAG_HEADER, INDEX, CHUNK, CHUNK_INFO, CONNECTION = range(2, 8)

_HEADER_LIMIT = 1 << 16  # bytes

Read = Callable[[int, int], bytes]  # (where, how many bytes) -> the bytes


class CutShortError(BagError):
    """The bytes end before a record does."""


class Record(NamedTuple):
    """A record's header, and where its data are."""

    fields: dict[str, bytes]
    begin: int
    end: int

    @property
    def op(self) -> int:
        return self.number("op", "<B")

    def number(self, name: str, form: str = "<L") -> int:
        """A value of the header, in ``struct``'s form."""
        return struct.unpack(form, self.fields[name])[0]


def records(read: Read, begin: int, end: int, cut: bool = False) -> Iterator[Record]:
    """Record after record up to ``end``; if they may be cut short, those that are whole.

    Raises:
        BagError: one is damaged, or, unless they may be, cut short.
    """
    while begin < end:
        try:
            record = read_record(read, begin, end)
        except CutShortError:
            if cut:
                return
            raise
        yield record
        begin = record.end


def read_record(read: Read, at: int, end: int, cut: bool = False) -> Record:
    """The record at a place, whose data may end behind ``end`` only if they may be cut.

    Raises:
        CutShortError: it is not whole.
    """
    header, header_end = _block(read, at, end)
    if header_end - header > _HEADER_LIMIT:
        raise BagError(f"the header of a record has {header_end - header:,} bytes")
    if header == header_end:
        # They may reach into the record before this one, of which then no one knows.
        raise BagError("there are zeros, which were never written, where a record should be")
    data, data_end = _block(read, header_end, end, cut)
    return Record(named_values(read(header, header_end - header)), data, data_end)


def named_values(block: bytes) -> dict[str, bytes]:
    """The named values in a header, or in the description of a connection."""
    values, at, read = {}, 0, reader(block)
    while at < len(block):
        begin, at = _block(read, at, len(block))
        name, _, value = block[begin:at].partition(b"=")
        values[name.decode()] = value
    return values


def reader(content: bytes) -> Read:
    """Reads from bytes as from a file."""
    return lambda at, size: content[at : at + size]


def _block(read: Read, at: int, end: int, cut: bool = False) -> tuple[int, int]:
    """Where the bytes begin and end whose number stands at a place."""
    begin = at + 4
    size = struct.unpack("<L", read(at, 4))[0] if begin <= end else 0
    if begin > end or (begin + size > end and not cut):
        raise CutShortError(f"it ends after {end:,} bytes, inside of a record")
    return begin, begin + size
