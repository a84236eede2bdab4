"""./run fuzz: what load_targets makes of thousands of broken bags.

Each must be read, or refused in one sentence, in little time and memory. A bag with its index must
not be read in part, and one without it only with a warning. The same seed makes the same bags, and
those that fail are kept.
"""

import argparse
import logging
import multiprocessing
import resource
import shutil
import signal
import sys
import tempfile
import time
from collections import Counter
from contextlib import contextmanager
from pathlib import Path

import numpy as np
from broken_bags import TARGETS, damaged, real_bags

from youbot_kinematics.exceptions import BagError
from youbot_kinematics.targets import load_targets

MOST_SECONDS, MOST_BYTES = 5, 10**9
FINE = ("read", "recovered", "refused")


class TooLongError(BaseException):
    """A bag takes too long; no Exception, or it would be caught as one."""


class Fuzzer:
    """Broken bags by their numbers, and what becomes of each."""

    def __init__(self, seed: int, folder: Path):
        self._seed, self._folder = seed, folder
        self._bags = real_bags(folder)

    def content(self, number: int) -> bytes:
        rng = np.random.default_rng([self._seed, number])
        return damaged(self._bags[number % len(self._bags)], self._bags, rng)

    def __call__(self, number: int) -> tuple[str, float]:
        """What becomes of a bag, and after how many seconds."""
        path = self._folder / f"{number}.bag"
        path.write_bytes(self.content(number))
        began = time.monotonic()
        try:
            with at_most(MOST_SECONDS):
                outcome = judge(path)
        except TooLongError:
            outcome = f"too long: over {MOST_SECONDS} s"
        seconds = time.monotonic() - began
        if outcome in FINE:
            path.unlink()
            return outcome, seconds
        return f"{outcome} ({path.name})", seconds


def judge(path) -> str:
    """What becomes of a bag: one of ``FINE``, or what is wrong."""
    try:
        targets = load_targets(path)
    except BagError as error:
        if isinstance(error.__cause__, MemoryError):
            return "too large: out of memory"
        sentence = str(error)
        clear = sentence.isprintable() and path.name in sentence and len(sentence) < 700
        return "refused" if clear else f"unclear: {sentence!r}"
    except Exception as error:
        return f"raised: {error!r}"
    if targets.warning:
        return "recovered"
    return "read" if len(targets) >= TARGETS else f"in part: {len(targets)} targets, no warning"


@contextmanager
def at_most(seconds: int):
    """Raises TooLongError in what takes longer."""

    def ring(*_):
        raise TooLongError

    signal.signal(signal.SIGALRM, ring)
    signal.alarm(seconds)
    try:
        yield
    finally:
        signal.alarm(0)


def limit_memory() -> None:
    """From now on this process gets no more than ``MOST_BYTES``, beyond what it has."""
    pages = int(Path("/proc/self/statm").read_text().split()[0])
    most = pages * resource.getpagesize() + MOST_BYTES
    resource.setrlimit(resource.RLIMIT_AS, (most, most))


def fuzz(count: int, seed: int, folder: Path, jobs: int = 1):
    """The outcomes of so many bags, how often each, and the longest time in s."""
    outcomes, longest = Counter(), 0.0
    with multiprocessing.Pool(jobs, limit_memory) as pool:
        for outcome, seconds in pool.imap_unordered(Fuzzer(seed, folder), range(count), 50):
            outcomes[outcome] += 1
            longest = max(longest, seconds)
    return outcomes, longest


def main() -> int:
    parser = argparse.ArgumentParser(prog="./run fuzz", description=__doc__.splitlines()[0])
    parser.add_argument("count", nargs="?", type=int, default=10_000, help="(default: 10000)")
    parser.add_argument("--seed", type=int, default=0, help="of the damage (default: 0)")
    options = parser.parse_args()
    logging.disable()  # thousands of warnings that a bag was never closed
    folder = Path(tempfile.mkdtemp(prefix="broken_bags_"))
    outcomes, longest = fuzz(options.count, options.seed, folder, jobs=2)
    for outcome, times in outcomes.most_common():
        print(f"{times:7d}  {outcome}")
    largest = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 1000
    bad = sum(times for outcome, times in outcomes.items() if outcome not in FINE)
    print(
        f"{options.count} broken bags, {bad} not as they should: {folder if bad else 'none kept'}"
    )
    if not bad:
        shutil.rmtree(folder)
    print(f"longest {longest:.2f} s, largest process {largest:.0f} MB")
    return 1 if bad or largest * 1e6 > MOST_BYTES else 0


if __name__ == "__main__":
    sys.exit(main())
