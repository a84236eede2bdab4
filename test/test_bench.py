"""What the benchmarks count with; their figures are held by no test."""

import sys
from pathlib import Path

import numpy as np
import pytest

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "benchmarks"))
import bench  # noqa: E402
import coursework  # noqa: E402
import urdf_chain  # noqa: E402

from youbot_kinematics import YoubotKinematics  # noqa: E402


def test_the_ratio_is_that_of_times_of_the_same_round():
    slow_machine_in_between = {bench.OURS: [1.0, 50.0, 1.0], "peer": [2.0, 100.0, 2.0]}
    line = bench.compared("work", slow_machine_in_between, 1.0, "faster")
    assert (line.best, line.ratio, line.reached) == ("peer", 0.5, True)


def test_the_fastest_peer_counts_unless_its_answer_does_not():
    times = {bench.OURS: [2.0], "fast": [1.0], "right": [4.0]}
    assert not bench.compared("work", times, 1.0, "faster").reached
    assert bench.compared("work", times, 1.0, "faster", rivals=["right"]).reached


def test_a_goal_that_asks_for_more_than_time_is_missed_without_it():
    times = {bench.OURS: [1.0], "peer": [2.0]}
    assert not bench.compared("work", times, 1.0, "faster, and 100 %", required=False).reached


def test_all_works_have_their_turn_in_each_round():
    calls = []
    works = {name: bench.Work(calls.append, [name]) for name in "ab"}
    times = bench.in_turn(works, rounds=3, round_time=0)
    assert "".join(calls) == "ababab"
    assert all(len(values) == 3 for values in times.values())


def test_the_peers_chain_is_the_packages_arm():
    pytest.importorskip("PyKDL")
    peers = pytest.importorskip("peers")
    q = peers.random_joints(np.random.default_rng(0), 20)
    kdl = peers.Kdl()
    for joints in q:
        expected = YoubotKinematics().forward_kinematics(joints)
        assert np.abs(kdl.forward(joints) - expected).max() < 1e-9
    assert [joint.fixed for joint in urdf_chain.urdf_chain(peers.URDF)].count(False) == 5


def test_the_coursework_takes_a_given_order():
    start = np.array([2.9, 1.0, -1.2, 1.7, 2.9])
    positions = YoubotKinematics().forward_kinematics(start + [[0.1] * 5, [0.05] * 5])[:, :3, 3]
    best, _ = coursework.plan(start, positions, 3)
    given, found = coursework.plan(start, positions, 3, order=[1, 0])
    assert found.all()
    assert np.array_equal(best, given)
