"""The memory that forward kinematics of 10,000,000 configurations takes, in a process of its own.

The joints are 0.4 GB and the poses 1.28 GB: little is left for anything between the two.
"""

from __future__ import annotations

import argparse
import json
import resource
import subprocess
import sys
import time

from bench import Line, report

MOST = 2e9  # bytes
STOP = 8 * 2**30  # bytes of addresses, so that a failure does not take the machine with it


def inside(count):
    """What the process of its own does: prints its peak and its time as JSON."""
    resource.setrlimit(resource.RLIMIT_AS, (STOP, STOP))
    import numpy as np
    from peers import KIN, LIMITS

    # In place: making the joints must not take more than having them.
    q = np.random.default_rng(0).random((count, 5))
    q *= LIMITS.upper - LIMITS.lower
    q += LIMITS.lower
    begin = time.perf_counter()
    try:
        T, failed = KIN.forward_kinematics(q), False
        assert np.array_equal(T[-1], KIN.forward_kinematics(q[-1]))
    except MemoryError:
        failed = True
    took = time.perf_counter() - begin
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024
    print(json.dumps({"peak": peak, "time": took, "failed": failed}))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--count", type=int, default=10_000_000)
    parser.add_argument("--inside", action="store_true", help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.inside:
        inside(options.count)
        return
    command = [sys.executable, __file__, "--inside", "--count", str(options.count)]
    found = json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)
    note = f"{found['time'] / options.count * 1e9:.0f} ns a configuration"
    if found["failed"]:
        note = f"stopped: more than {STOP / 1e9:.1f} GB"
    reached = not found["failed"] and found["peak"] < MOST
    work = f"memory, FK of {options.count:,}"
    goal = f"under {MOST / 1e9:g} GB"
    lines = [Line(work, found["peak"], {}, goal, reached, unit="B", note=note)]
    report("memory", lines, **found)


if __name__ == "__main__":
    main()
