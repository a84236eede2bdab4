"""Progress for people: a bar on a terminal, lines in a log elsewhere, and nothing of quick work."""

from __future__ import annotations

import logging
import sys
import time
from contextlib import contextmanager

from .progress import listened_by

#: Work that takes no longer than this is not shown, s.
PATIENCE = 1.0
#: Time between two drawings of the bar, and between two lines of a log, s.
REDRAWN_EVERY, LOGGED_EVERY = 0.1, 5.0
_WIDTH = 30  # characters of a full bar
_ERASE = "\r\033[K"


@contextmanager
def shown(stream=None, log=logging.info):
    """Shows how far the work inside is.

    Args:
        stream: where a bar is drawn if it is a terminal; standard error if not given.
        log: takes a line where there is no terminal.
    """
    stream = sys.stderr if stream is None else stream
    if not stream.isatty():
        with logged(log):
            yield
        return
    try:
        with listened_by(_Every(REDRAWN_EVERY, lambda *state: _draw(stream, *state))):
            yield
    finally:
        stream.write(_ERASE)
        stream.flush()


def logged(log):
    """Logs how far the work inside is, by a function that takes a line."""
    return listened_by(_Every(LOGGED_EVERY, lambda *state: log(as_line(*state))))


def as_line(what: str, done: int, total: int) -> str:
    """``planning: 30 of 120 (25 %)``."""
    return f"{what}: {done} of {total} ({_fraction(done, total):.0%})"


def as_bar(what: str, done: int, total: int) -> str:
    """The same as a bar, for a terminal."""
    full = int(_WIDTH * _fraction(done, total))
    return f"[{'#' * full:{_WIDTH}}] {as_line(what, done, total)}"


def _draw(stream, *state) -> None:
    stream.write(_ERASE + as_bar(*state))
    stream.flush()


def _fraction(done: int, total: int) -> float:
    return min(done / total, 1.0) if total > 0 else 1.0


class _Every:
    """A listener that passes on what it hears every ``interval`` s, after ``PATIENCE``."""

    def __init__(self, interval: float, say):
        self._interval, self._say = interval, say
        self._next = time.monotonic() + PATIENCE

    def __call__(self, *state) -> None:
        now = time.monotonic()
        if now >= self._next:
            self._next = now + self._interval
            self._say(*state)
