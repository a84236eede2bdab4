"""Files that appear whole or not at all, and never in the place of another unless asked to."""

from __future__ import annotations

import tempfile
from contextlib import contextmanager
from pathlib import Path

from .exceptions import InputError


def require_writable(path, force: bool = False) -> Path:
    """The path of a file that may be written: in a folder that exists, replacing nothing.

    Args:
        path: path of the file.
        force: whether it may replace a file.

    Raises:
        InputError: the folder does not exist, or there is such a file and no ``force``.
    """
    path = Path(path)
    if not path.parent.is_dir():
        raise InputError(f"cannot write {path}: there is no folder {path.parent}")
    if path.is_dir():
        raise InputError(f"cannot write {path}: it is a folder")
    if path.exists() and not force:
        raise InputError(f"{path} exists already, and is replaced only by force (--force)")
    return path


@contextmanager
def new_file(path, force: bool = False):
    """Yields the path of a file to write, which takes the name ``path`` once all went well.

    Until then it is in a hidden folder beside it, which is gone whatever happens.

    Raises:
        InputError: as ``require_writable`` has it, or the file system refuses.
    """
    path = require_writable(path, force)
    try:
        with tempfile.TemporaryDirectory(prefix=".", dir=path.parent) as folder:
            unfinished = Path(folder) / path.name
            yield unfinished
            unfinished.replace(path)
    except OSError as error:
        raise InputError(f"cannot write {path}: {error.strerror or error}") from error
