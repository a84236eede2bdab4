"""The offline command: results on standard output, one sentence on error, and its exit status."""

import json
import os
import subprocess
import sys
from dataclasses import fields
from pathlib import Path

import pytest

from youbot_kinematics import plan_bag, plan_job, plan_options
from youbot_kinematics.make_bag import make_bag
from youbot_kinematics.parameters import Parameters
from youbot_kinematics.targets import Targets

ROOT = Path(__file__).resolve().parents[1]
DEMO = str(ROOT / "bags/demo.bag")
COURSE_BAG = Path(
    os.environ.get("YOUBOT_COURSE_BAG") or ROOT.parent / "shared/bags/comp0127_cw2.bag"
)
START = ["--start", "0.5", "0.5", "-2.0", "1.2", "0.6"]


@pytest.fixture
def bag(tmp_path):
    q = [[1.4, 0.4, -1.9, 1.0, 1.5], [0.9, 0.25, -1.8, 0.9, 1.0]]
    make_bag(tmp_path / "targets.bag", Targets.from_joints(q))
    return str(tmp_path / "targets.bag")


def run(*arguments):
    """The command as a process of its own."""
    command = [sys.executable, str(ROOT / "scripts/plan_bag"), *arguments]
    return subprocess.run(command, capture_output=True, text=True, timeout=120, check=False)


def test_the_bundled_bag_is_planned_from_the_folded_arm():
    result = run(DEMO)
    assert result.returncode == 0
    assert "5 from demo.bag" in result.stdout and "2 5 3 1 4" in result.stdout
    assert "all joints at zero" in result.stderr and "Traceback" not in result.stderr


@pytest.mark.skipif(not COURSE_BAG.exists(), reason="the course's bag is not here")
def test_the_courses_own_bag_is_planned_from_near_its_first_target(tmp_path):
    start = ["--start", "4.6", "1.5", "-2.4", "2.1", "1.0"]
    assert plan_bag.main([str(COURSE_BAG), *start, "--output", str(tmp_path / "plan.json")]) == 0
    read = json.loads((tmp_path / "plan.json").read_text())
    assert read["order"] == [0, 1, 2, 3] and read["report"]["passed"]


def test_a_plan_is_written_in_every_format_and_drawn(bag, tmp_path, capsys):
    pytest.importorskip("matplotlib")
    files = [tmp_path / name for name in ("plan.json", "plan.csv", "plan.bag")]
    outputs = [word for file in files for word in ("--output", str(file))]
    picture = tmp_path / "plan.png"
    assert plan_bag.main([bag, *START, *outputs, "--plot", str(picture)]) == 0
    printed = capsys.readouterr()
    assert "WARNING" not in printed.err  # a slow machine may show progress there
    for file in (*files, picture):
        assert file.stat().st_size > 1000 and str(file) in printed.out


def test_every_parameter_of_the_planner_is_an_option_with_its_default():
    options = vars(plan_options.parser().parse_args(["some.bag"]))
    assert {f.name: options[f.name] for f in fields(Parameters)} == vars(Parameters())


def test_options_are_taken_with_dashes_and_with_underscores(bag, tmp_path):
    values = ["--num_points=3", "--velocity-scaling", "0.5", "--order", "given"]
    assert plan_bag.main([bag, *START, *values, "--output", str(tmp_path / "plan.json")]) == 0
    read = json.loads((tmp_path / "plan.json").read_text())
    assert read["parameters"]["num_points"] == 3
    assert read["parameters"]["velocity_scaling"] == 0.5
    assert read["parameters"]["start"] == [0.5, 0.5, -2.0, 1.2, 0.6]
    assert read["order"] == [0, 1]


def test_a_start_may_have_small_numbers_as_they_are_printed(bag, tmp_path):
    start = ["--start", "0.5", "0.5", "-2e0", "1.2", "6e-1"]
    assert plan_bag.main([bag, *start, "--output", str(tmp_path / "plan.json")]) == 0
    read = json.loads((tmp_path / "plan.json").read_text())
    assert read["start"] == [0.5, 0.5, -2.0, 1.2, 0.6]


def test_a_bag_that_cannot_be_read_ends_in_status_2(tmp_path):
    (tmp_path / "broken.bag").write_bytes(b"#ROSBAG V2.0\nE")
    result = run(str(tmp_path / "broken.bag"))
    assert result.returncode == 2 and result.stdout == ""
    assert result.stderr.startswith("plan_bag: ") and result.stderr.count("\n") == 1


@pytest.mark.parametrize(
    "options",
    [
        ["--num-points", "-1"],
        ["--velocity-scaling", "2"],
        ["--start", "9", "0", "0", "0", "0"],
        ["--start", "nan", "0", "0", "0", "0"],
        ["--topic", "elsewhere"],
        ["--output", "plan.txt"],
        ["--output", "missing/plan.json"],
        ["--plot", "plan.jpeg"],
    ],
)
def test_bad_options_end_in_status_2_and_one_sentence(bag, capsys, options):
    assert plan_bag.main([bag, *START, *options]) == 2
    printed = capsys.readouterr()
    assert printed.out == "" and printed.err.count("\n") == 1


@pytest.mark.parametrize("options", [["--unknown", "1"], ["--num-points", "x"], ["--start", "1"]])
def test_options_that_argparse_refuses_end_in_status_2(bag, options):
    with pytest.raises(SystemExit) as end:
        plan_bag.main([bag, *options])
    assert end.value.code == 2


def test_targets_that_cannot_be_visited_end_in_status_1(tmp_path, capsys):
    # Through the hollow around the arm's base, from one side to the other.
    q = [[0.2, 1.8, -2.2, 1.9, 1.0], [3.3, 1.8, -2.2, 1.9, 1.0]]
    make_bag(tmp_path / "hard.bag", Targets.from_joints(q))
    output = ["--output", str(tmp_path / "plan.json")]
    status = plan_bag.main([str(tmp_path / "hard.bag"), *output, "--solver", "pseudo_inverse"])
    assert status == 1
    assert "cannot be tracked" in capsys.readouterr().err
    assert not (tmp_path / "plan.json").exists()


def test_files_that_exist_are_refused_before_any_planning(bag, tmp_path, monkeypatch, capsys):
    (tmp_path / "plan.json").write_text("mine")
    monkeypatch.setattr(plan_job, "plan", lambda *_: pytest.fail("planned for nothing"))
    assert plan_bag.main([bag, *START, "--output", str(tmp_path / "plan.json")]) == 2
    assert "--force" in capsys.readouterr().err


def test_an_interruption_ends_in_status_130(bag, monkeypatch, capsys):
    def interrupt(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr(plan_bag, "plan_job", interrupt)
    assert plan_bag.main([bag, *START]) == 130
    assert capsys.readouterr().err == "plan_bag: interrupted\n"


def test_a_plan_on_standard_output_is_nothing_but_the_plan(bag, capfd):
    assert plan_bag.main([bag, *START, "--output", "-"]) == 0
    printed = capfd.readouterr()
    assert json.loads(printed.out)["order"] and "duration" in printed.err


@pytest.mark.parametrize(("name", "start"), [("-.csv", b"time_s,"), ("-.bag", b"#ROSBAG V2.0")])
def test_standard_output_takes_every_format(bag, capfdbinary, name, start):
    assert plan_bag.main([bag, *START, "--output", name]) == 0
    assert capfdbinary.readouterr().out.startswith(start)


def test_a_reader_that_has_seen_enough_is_no_error(bag):
    command = [sys.executable, str(ROOT / "scripts/plan_bag"), bag, *START, "--output", "-"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE) as process:
        process.stdout.close()
        assert b"Traceback" not in process.stderr.read()
    assert process.returncode == 0


@pytest.mark.parametrize("outputs", [["a.json", "./a.json"], ["-", "-.csv"]])
def test_the_same_output_twice_is_refused_before_any_planning(bag, capsys, monkeypatch, outputs):
    monkeypatch.setattr(plan_job, "plan", lambda *_: pytest.fail("planned for nothing"))
    names = [word for output in outputs for word in ("--output", output)]
    assert plan_bag.main([bag, *START, *names]) == 2
    assert "twice" in capsys.readouterr().err


def test_the_help_names_every_exit_status_format_and_parameter():
    text = plan_options.parser().format_help()
    for word in (".json", ".csv", ".bag", "{folder}", "0 planned, 1 there is no plan, 2 bad input"):
        assert word in text
    for f in fields(Parameters):
        assert "--" + f.name.replace("_", "-") in text
