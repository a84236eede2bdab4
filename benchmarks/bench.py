"""What the benchmarks share: the clock, lines of results with their goals, tables and files."""

from __future__ import annotations

import json
import os
import platform
import time
from dataclasses import asdict, dataclass, field
from importlib import metadata
from pathlib import Path
from statistics import median
from typing import NamedTuple

OURS = "youbot_kinematics"
#: Where results go; ``./run bench`` says it, and nothing is written without it.
RESULTS = os.environ.get("YOUBOT_BENCH")
_PEERS = """
    eaik elkai fast-tsp held-karp ikpy numpy optik-py ortools pin python-tsp roboticstoolbox-python
""".split()

_UNITS = {"s": [(1.0, "s"), (1e-3, "ms"), (1e-6, "us"), (1e-9, "ns")], "B": [(1e9, "GB")]}


class Work(NamedTuple):
    """Something to time: a function of one input, and inputs for it."""

    function: object
    inputs: list
    items: int = 1  # how many things one call does: the time is that of one of them


def in_turn(works, rounds=9, round_time=0.05):
    """Name -> the times of an item, s, one a round. In each round every work has its turn.

    So whatever slows the machine for a while slows all of them alike, and the ratio of two times of
    the same round stays true. A turn takes ``round_time`` s or one call, whichever is longer; 0 is
    for work that takes seconds, and has been done before.
    """
    prepared, times = {}, {name: [] for name in works}
    for name, (function, inputs, items) in works.items():
        used = inputs[:1]
        if round_time:
            function(inputs[0])  # what only the first call does
            used = inputs[: max(int(round_time / _took(function, used)), 1)]
        prepared[name] = function, used, items * len(used)
    for _ in range(rounds):
        for name, (function, inputs, items) in prepared.items():
            times[name].append(_took(function, inputs) / items)
    return times


def _took(function, inputs):
    begin = time.perf_counter()
    for value in inputs:
        function(value)
    return time.perf_counter() - begin


@dataclass
class Line:
    """One figure of the project beside those of its peers, and whether it reaches its goal."""

    work: str
    ours: float
    peers: dict[str, float]
    goal: str
    reached: bool
    unit: str = "s"
    best: str | None = None  # the peer that counts
    ratio: float | None = None  # ours by that peer's, of the same rounds
    most: float | None = None  # of the ratio, to reach the goal
    note: str = ""
    more: dict = field(default_factory=dict)


def compared(work, times, most, goal, required=True, note="", rivals=None):
    """The line of a work that is done by the project and by peers, all ``in_turn``.

    Args:
        times: name -> times, s, one a round; the project's are among them.
        most: what the median ratio of the project's time to the best peer's may be.
        required: whatever else the goal asks for.
        rivals: the peers that count as the best; all, if not given.
    """
    medians = {name: median(values) for name, values in times.items()}
    ours = medians.pop(OURS)
    ratio, best = None, min(rivals or medians, key=medians.get, default=None)
    if best:
        ratio = median(a / b for a, b in zip(times[OURS], times[best]))
    reached = bool(required and ratio is not None and ratio <= most)
    return Line(work, ours, medians, goal, reached, "s", best, ratio, most, note)


def shown(value, unit="s"):
    """A value in the unit that suits it."""
    for scale, name in _UNITS.get(unit, [(1.0, unit)]):
        text = f"{value / scale:.3g} {name}".rstrip()
        if abs(value) >= scale:
            break
    return text


def table(header, rows, left=(0,)):
    """Prints rows of texts or numbers in columns: those of ``left`` left-aligned, others right."""
    cells = [[str(cell) for cell in row] for row in (header, *rows)]
    widths = [max(map(len, column)) for column in zip(*cells)]
    cells.insert(1, ["-" * width for width in widths])
    for row in cells:
        columns = enumerate(zip(row, widths))
        aligned = [cell.ljust(w) if i in left else cell.rjust(w) for i, (cell, w) in columns]
        print("  ".join(aligned).rstrip(), flush=True)


def show_peers(line):
    """Prints a line's figures, one below the other."""
    everyone = {OURS: line.ours, **line.peers}
    table(
        (line.work, line.unit and "each", "ours by it"),
        [
            (name, shown(value, line.unit), f"{line.ours / value:.2f}")
            for name, value in everyone.items()
        ],
    )
    print()


def show_lines(lines):
    """Prints the table of ratios."""
    rows = []
    for line in lines:
        best = line.best
        rows.append(
            (
                line.work,
                shown(line.ours, line.unit),
                f"{best} {shown(line.peers[best], line.unit)}" if best else "-",
                "-" if line.ratio is None else f"{line.ratio:.2f}",
                line.goal,
                "reached" if line.reached else "MISSED",
            )
        )
    table(("", "project", "best peer", "ratio", "goal", ""), rows, left=(0, 4, 5))
    for line in lines:
        if line.note:
            print(f"  {line.work}: {line.note}")
    print()


def report(name, lines, **more):
    """Prints a row's lines, and writes them as JSON to build/bench/NAME.json."""
    show_lines(lines)
    write(name, {"lines": [asdict(line) for line in lines], **more})


def write(name, results):
    """Writes results as JSON, with the machine that they are from, to build/bench/NAME.json."""
    if not RESULTS:
        return
    path = Path(RESULTS) / f"{name}.json"
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(json.dumps({"machine": machine(), **results}, indent=1, default=str) + "\n")
    print(f"written: {path}\n")


def read(name):
    """What ``write`` wrote, or None."""
    path = Path(RESULTS or "") / f"{name}.json"
    return json.loads(path.read_text()) if path.exists() else None


def machine():
    """The processor, and the versions of all that took part."""
    versions = {}
    for name in _PEERS:
        try:
            versions[name] = metadata.version(name)
        except metadata.PackageNotFoundError:
            pass
    return {
        "processor": _processor(),
        "python": platform.python_version(),
        "time": time.strftime("%Y-%m-%d %H:%M"),
        "versions": versions,
    }


def _processor():
    try:
        lines = Path("/proc/cpuinfo").read_text().splitlines()
    except OSError:
        return platform.processor()
    return next((line.split(":")[1].strip() for line in lines if line.startswith("model name")), "")
