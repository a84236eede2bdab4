"""ROS 2 bags, through rosbags, which unpacks as much as a bag says: compressed ones are refused.

What is not compressed is no larger in memory than the files are.
"""

from __future__ import annotations

import struct
from contextlib import contextmanager
from pathlib import Path

import yaml

from .exceptions import BagError

METADATA = "metadata.yaml"

# MCAP's records: https://mcap.dev/spec
_MCAP_MAGIC = b"\x89MCAP0\r\n"
_MCAP_RECORD = struct.Struct("<BQ")  # kind, length
_MCAP_CHUNK, _MCAP_COMPRESSION_AT = 0x06, 28  # behind times, size and checksum


@contextmanager
def open_rosbag2(folder: Path):
    """Yields rosbags' reader of a bag's folder.

    Raises:
        BagError: it is compressed, or its description is none.
    """
    _require_not_compressed(folder)
    from rosbags.highlevel import AnyReader  # slow to import, and only this needs it
    from rosbags.typesys import Stores, get_typestore

    with AnyReader([folder], default_typestore=get_typestore(Stores.ROS2_HUMBLE)) as reader:
        yield reader


def _require_not_compressed(folder: Path) -> None:
    about = yaml.safe_load((folder / METADATA).read_text(encoding="utf-8"))
    about = about.get("rosbag2_bagfile_information") if isinstance(about, dict) else None
    if not isinstance(about, dict):
        raise BagError(f"{METADATA} does not describe a ROS 2 bag")
    if about.get("compression_mode") or any(map(_has_compressed_chunk, folder.glob("*.mcap"))):
        raise BagError("a compressed ROS 2 bag: ros2 bag convert can write it uncompressed")


def _has_compressed_chunk(path: Path) -> bool:
    """Whether a chunk of an MCAP file is compressed, by its records' heads."""
    with path.open("rb") as file:
        if file.read(len(_MCAP_MAGIC)) != _MCAP_MAGIC:
            return False  # no such file, which rosbags says
        while len(head := file.read(_MCAP_RECORD.size)) == _MCAP_RECORD.size:
            kind, length = _MCAP_RECORD.unpack(head)
            end = file.tell() + length
            if kind == _MCAP_CHUNK:
                file.seek(_MCAP_COMPRESSION_AT, 1)
                if file.read(4) != bytes(4):  # the length of the compression's name
                    return True
            file.seek(end)
    return False
