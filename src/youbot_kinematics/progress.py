"""How far long work is: loops say what they do, and whoever runs them decides what becomes of it.

A loop over ``with_progress(items, "doing this", n)`` is the loop over ``items`` and nothing else,
until a listener is set around the work::

    with listened_by(print):
        plan(targets, start)
"""

from __future__ import annotations

from contextlib import contextmanager
from contextvars import ContextVar
from typing import Callable, Iterable, Iterator, TypeVar

#: Called with what is done, and how many of how many steps of it are done.
Listener = Callable[[str, int, int], None]
T = TypeVar("T")

_listener: ContextVar[Listener | None] = ContextVar("listener", default=None)


def with_progress(items: Iterable[T], what: str, total: int) -> Iterator[T]:
    """Yields ``total`` items, and tells the listener, if there is one, how many are done."""
    for done, item in enumerate(items):
        _tell(what, done, total)
        yield item
    _tell(what, total, total)


@contextmanager
def listened_by(listener: Listener):
    """Work inside is heard by ``listener``, in this thread alone."""
    token = _listener.set(listener)
    try:
        yield
    finally:
        _listener.reset(token)


def _tell(what: str, done: int, total: int) -> None:
    listener = _listener.get()
    if listener is not None:
        listener(what, done, total)
