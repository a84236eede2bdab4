"""What the benchmarks share: tables, files of results, and the clock."""

from __future__ import annotations

import json
import os
import platform
import time
from pathlib import Path

RESULTS = Path(os.environ.get("YOUBOT_BENCH") or Path(__file__).parents[1] / "build/bench")


def seconds(function, repeats=5):
    """The median time that a call takes, s, and what the last one returned."""
    times = []
    for _ in range(repeats):
        begin = time.perf_counter()
        result = function()
        times.append(time.perf_counter() - begin)
    return sorted(times)[len(times) // 2], result


def duration(value):
    """A time in the unit that suits it."""
    for unit, scale in (("s", 1.0), ("ms", 1e3), ("us", 1e6)):
        if value * scale >= 1 or unit == "us":
            return f"{value * scale:.3g} {unit}"
    return ""


def table(header, rows):
    """Prints rows of texts or numbers in columns: the first one left-aligned, the others right."""
    cells = [[str(cell) for cell in row] for row in (header, *rows)]
    widths = [max(map(len, column)) for column in zip(*cells)]
    cells.insert(1, ["-" * width for width in widths])
    for name, *others in cells:
        aligned = [cell.rjust(width) for cell, width in zip(others, widths[1:])]
        print("  ".join([name.ljust(widths[0]), *aligned]), flush=True)


def write(name, results):
    """Writes results as JSON, with the machine that they are from, to build/bench/NAME.json."""
    RESULTS.mkdir(parents=True, exist_ok=True)
    machine = {"processor": _processor(), "python": platform.python_version()}
    path = RESULTS / f"{name}.json"
    path.write_text(json.dumps({"machine": machine, **results}, indent=1) + "\n")
    print(f"written: {path}\n")


def _processor():
    try:
        lines = Path("/proc/cpuinfo").read_text().splitlines()
    except OSError:
        return platform.processor()
    return next((line.split(":")[1].strip() for line in lines if line.startswith("model name")), "")
