"""Bags of targets are made as asked, the same each time, and never half."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from youbot_kinematics import arm
from youbot_kinematics.exceptions import InputError
from youbot_kinematics.make_bag import FORMS, main, make_bag
from youbot_kinematics.targets import Targets, load_targets

ROOT = Path(__file__).resolve().parents[1]
Q = [[1.0, 1.0, -1.0, 1.0, 1.0], [2.0, 1.0, -2.0, 1.0, 0.5]]


@pytest.fixture
def bag(tmp_path):
    return tmp_path / "made.bag"


def test_the_command_in_the_bags_readme_makes_the_bundled_bag(bag):
    assert main([str(bag), "--targets", str(ROOT / "bags/demo.yaml")]) == 0
    assert bag.read_bytes() == (ROOT / "bags/demo.bag").read_bytes()
    assert "scripts/make_bag bags/demo.bag --targets" in (ROOT / "bags/README.md").read_text()


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("q.yaml", "# two\n- [1, 1, -1, 1, 1.0]\n- [2, 1, -2, 1, 5e-1]\n"),
        ("q.json", "[[1, 1, -1, 1, 1], [2, 1, -2, 1, 0.5]]"),
        ("q.csv", "# two\n1, 1, -1, 1, 1\n2, 1, -2, 1, 0.5\n"),
    ],
)
def test_targets_come_from_yaml_json_and_csv_files(bag, tmp_path, name, text):
    (tmp_path / name).write_text(text)
    assert main([str(bag), "--targets", str(tmp_path / name)]) == 0
    np.testing.assert_array_equal(load_targets(bag).joints, Q)


def test_targets_come_from_the_command_line(bag):
    words = [word for q in Q for word in ["--target", *map(str, q)]]
    assert main([str(bag), *words, "--form", "joint_trajectory", "--topic", "goals"]) == 0
    targets = load_targets(bag, topic="goals")
    np.testing.assert_array_equal(targets.joints, Q)


def test_random_targets_are_the_same_for_the_same_seed_and_inside_the_limits(tmp_path):
    bags = [tmp_path / f"{i}.bag" for i in range(3)]
    for bag, seed in zip(bags, (7, 7, 8)):
        options = ["--random", "50", "--seed", str(seed), "--limits", "hardware"]
        assert main([str(bag), *options]) == 0
    assert bags[0].read_bytes() == bags[1].read_bytes() != bags[2].read_bytes()
    assert arm.joint_limits("hardware").contain(load_targets(bags[0]).joints).all()


def test_no_file_is_replaced_unless_forced(bag, capsys):
    bag.write_text("mine")
    assert main([str(bag), "--random", "2"]) == 2
    assert bag.read_text() == "mine" and "--force" in capsys.readouterr().err
    assert main([str(bag), "--random", "2", "--force"]) == 0
    assert len(load_targets(bag)) == 2


@pytest.mark.parametrize(
    ("options", "part"),
    [
        (["--target", "1", "1", "1", "1", "1"], "arm_joint_3"),
        (["--random", "0"], "targets must be"),
        (["--targets", "missing.yaml"], "No such file"),
    ],
)
def test_bad_targets_end_in_one_sentence_and_leave_no_file(bag, capsys, options, part):
    assert main([str(bag), *options]) == 2
    sentence = capsys.readouterr().err
    assert part in sentence and sentence.count("\n") == 1
    assert list(bag.parent.iterdir()) == []


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("q.yaml", "- [1, 2\n"),
        ("q.yaml", "{a: 1}"),
        ("q.yaml", "- [1, 1, -1, 1]\n"),
        ("q.yaml", ""),
        ("q.csv", "a, b, c, d, e\n"),
        ("q.csv", "1, 2, 3\n1, 2\n"),
    ],
)
def test_files_that_hold_no_joint_positions_are_refused(bag, tmp_path, capsys, name, text):
    (tmp_path / name).write_text(text)
    assert main([str(bag), "--targets", str(tmp_path / name)]) == 2
    assert capsys.readouterr().err.count("\n") == 1
    assert not bag.exists()


def test_a_bag_must_be_named_as_one_and_have_a_folder(tmp_path):
    targets = Targets.from_joints(Q)
    for path in ("targets.txt", "no_such_folder/targets.bag"):
        with pytest.raises(InputError):
            make_bag(tmp_path / path, targets)
    with pytest.raises(InputError, match=next(iter(FORMS))):
        make_bag(tmp_path / "targets.bag", targets, form="unheard_of")


def test_the_script_is_the_command(bag):
    command = [sys.executable, str(ROOT / "scripts/make_bag"), str(bag), "--random", "3"]
    run = subprocess.run(command, capture_output=True, text=True, timeout=60, check=True)
    assert "3 targets" in run.stdout and len(load_targets(bag)) == 3
