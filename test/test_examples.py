"""The examples and benchmarks still run; their figures are held by the other tests."""

import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]


def run(script, *arguments):
    command = [sys.executable, str(ROOT / script), *map(str, arguments)]
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def test_the_planar_example_draws_its_picture(tmp_path):
    pytest.importorskip("matplotlib")
    picture = tmp_path / "picture.png"
    printed = run("examples/planar_redundancy.py", picture)
    assert picture.read_bytes().startswith(b"\x89PNG")
    assert printed.count("joint 4 from") == 2


def test_the_closed_forms_promises_hold_on_a_few_poses():
    printed = run("benchmarks/closed_form.py", "--scale", "0.002")
    assert "2000 reachable poses: 100.0000% solved" in printed
    assert "200 unreachable poses: 0 claimed solved" in printed
    assert "100.0000% with a reason for each branch" in printed


def test_the_comparison_leaves_out_what_is_not_installed():
    printed = run("benchmarks/inverse.py", "--poses", 3, "--batch", 10)
    assert "youbot_kinematics 100.0 %" in " ".join(printed.split())
