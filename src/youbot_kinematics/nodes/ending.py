"""How a node ends before its work is done: told to by a signal, or left by its ROS master."""

from __future__ import annotations

import os
import signal
import sys
import threading
from typing import Callable

import rospy

SIGNALS = (signal.SIGINT, signal.SIGTERM)
#: How long a node may take to end once it is told to, before it is ended, s.
GRACE = 5.0


class Ending:
    """Shuts ROS down from a thread beside the node's own, and ends the process if that hangs.

    rospy would do it in a signal's handler: in the main thread, in the middle of whatever it does.
    If that is a call to the master, shutting down needs the lock which the call holds, and the node
    waits for itself for ever.
    """

    def __init__(self):
        self._begun, self._over = threading.Event(), threading.Event()

    def on_signals(self) -> None:
        """Shuts ROS down on SIGINT and SIGTERM. To be called in the main thread.

        Raises:
            ValueError: it is another thread.
        """
        read, write = os.pipe()
        os.set_blocking(write, False)
        signal.set_wakeup_fd(write, warn_on_full_buffer=False)
        for number in SIGNALS:
            signal.signal(number, _do_nothing)  # but write the number to the pipe, as Python does
        threading.Thread(target=self._wait_for_signal, args=(read,), daemon=True).start()

    def _wait_for_signal(self, pipe: int) -> None:
        (number,) = os.read(pipe, 1)
        self.begin(f"signal {number}", lambda: None, status=0)

    def begin(self, reason: str, last_words: Callable[[], None], status: int) -> None:
        """Shuts ROS down; if the node lives on after ``GRACE`` s, ends it with a status."""
        self._begun.set()
        threading.excepthook = _do_nothing  # rospy's threads, for sockets that close under them
        timer = threading.Timer(GRACE, _end, (last_words, status))
        timer.daemon = True
        timer.start()
        rospy.signal_shutdown(reason)
        self._over.set()

    def wait(self) -> None:
        """Returns when ROS is not being shut down, or no longer: the master knows by then."""
        if self._begun.is_set():
            self._over.wait(GRACE)


def _do_nothing(*_):
    pass


def _end(last_words, status):
    try:
        last_words()
        sys.stdout.flush()
    finally:
        os._exit(status)  # a thread cannot end the others any other way
