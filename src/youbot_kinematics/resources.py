"""Where the package's own files are, however it was installed."""

from pathlib import Path

from .exceptions import InputError

_HERE = Path(__file__).resolve()
_ROOTS = (
    _HERE.parents[2],  # the source tree, for a devel space too
    _HERE.parents[4] / "share" / "youbot_kinematics",  # PREFIX/lib/python3*/*-packages/here/this.py
)


def resource_path(relative: str) -> Path:
    """The path of one of the package's own files or folders, such as ``urdf/youbot_arm.urdf``.

    Raises:
        InputError: it is in none of the places where an installation puts it.
    """
    candidates = [root / relative for root in _ROOTS]
    for path in candidates:
        if path.exists():
            return path
    searched = ", ".join(map(str, candidates))
    raise InputError(f"youbot_kinematics has no file {relative}; searched: {searched}")
