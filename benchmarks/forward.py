"""Forward kinematics and Jacobian beside their peers: one configuration, and 100,000 at once.

All answers are compared first, on the same random configurations. A batch is measured beside the
interfaces for batches that there are, and beside a loop over the peer that is the fastest on one.
"""

from __future__ import annotations

import argparse
from statistics import median

import numpy as np
from bench import OURS, Work, compared, in_turn, report, show_peers
from peers import FORWARD, KIN, installed, looped, random_joints

SAME = 1e-9  # m, rad
WORKS = {
    # name -> method, the package's own, shape of a result
    "FK": ("forward", KIN.forward_kinematics, (4, 4)),
    "Jacobian": ("jacobian", KIN.get_jacobian, (6, 5)),
}


def require_same(name, answers, expected):
    off = np.abs(answers - expected).max()
    if not off < SAME:
        raise SystemExit(f"{name} is {off:.1e} off the project's answer: nothing is timed")


def measure(work, peers, q):
    """The lines of forward kinematics or of the Jacobian: one configuration, and a batch."""
    method, own, shape = WORKS[work]
    peers = [peer for peer in peers if getattr(peer, method, None)]
    one_by_one, few = list(q[:5000]), q[:1000]
    for peer in peers:
        require_same(peer.name, [getattr(peer, method)(x) for x in few], own(few))
    times = in_turn({p.name: Work(getattr(p, method), one_by_one) for p in peers}, rounds=15)
    single = compared(f"{work}, one configuration", times, 1.0, "not slower")
    show_peers(single)

    works, names = {}, [peer.name for peer in peers if peer.name != OURS]
    fastest = min(names, key=lambda name: median(times[name]), default=None)
    for peer in peers:
        batch = getattr(peer, f"{method}_batch", None)
        if batch:
            require_same(peer.name, batch(few), own(few))
            works[peer.name] = Work(batch, [q], len(q))
        if peer.name == fastest:
            loop = looped(getattr(peer, method), shape)
            works[f"{peer.name} in a loop"] = Work(loop, [q], len(q))
    line = compared(f"{work}, {len(q):,}", in_turn(works), 0.2, "5 times faster")
    show_peers(line)
    return [single, line]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--batch", type=int, default=100_000)
    parser.add_argument("--seed", type=int, default=0)
    options = parser.parse_args()
    q = random_joints(np.random.default_rng(options.seed), options.batch)
    peers = installed(FORWARD)
    lines = [line for work in WORKS for line in measure(work, peers, q)]
    report("forward", lines, **vars(options))


if __name__ == "__main__":
    main()
