"""The command that judges trajectories: what it reads, what it says, and its exit status."""

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from youbot_kinematics import arm, export
from youbot_kinematics.bag_writer import make, make_duration, make_header, write_bag
from youbot_kinematics.check_trajectory import main
from youbot_kinematics.make_bag import make_bag
from youbot_kinematics.parameters import Parameters
from youbot_kinematics.planner import plan
from youbot_kinematics.targets import Targets

ROOT = Path(__file__).resolve().parents[1]
START = [0.5, 0.5, -2.0, 1.2, 0.6]
TARGETS = Targets.from_joints([[1.4, 0.4, -1.9, 1.0, 1.5], [0.9, 0.25, -1.8, 0.9, 1.0]])


@pytest.fixture(scope="module")
def planned():
    return plan(TARGETS, START, Parameters(limits="hardware", acceleration=2.0))


@pytest.fixture
def document(planned):
    """A plan's JSON as Python has it, to be changed."""
    return json.loads(json.dumps(export.as_dict(planned)))


@pytest.fixture
def judge(tmp_path, capsys):
    """Writes JSON, judges it, and returns the status, the results and the errors."""

    def judge(content, *options):
        file = tmp_path / "plan.json"
        file.write_text(content if isinstance(content, str) else json.dumps(content))
        status = main([str(file), *options])
        return (status, *capsys.readouterr())

    return judge


def point(seconds, q=START, v=(0.0,) * 5, a=(0.0,) * 5):
    nanoseconds = round(seconds * 1e9)
    rows = (np.array(row, dtype=float) for row in (q, v, a, ()))
    return make("trajectory_msgs/JointTrajectoryPoint", *rows, make_duration(nanoseconds))


def message(points, names=arm.JOINT_NAMES):
    return make("trajectory_msgs/JointTrajectory", make_header(), list(names), points)


def test_a_plan_s_json_is_judged_by_the_plan_s_own_parameters(document, judge):
    status, out, err = judge(document)
    assert (status, err) == (0, "")
    assert "limits hardware, acceleration 2 " in out and "off the lines" in out
    assert "every promise" in out


def test_the_options_come_before_the_plan_s_parameters(document, judge):
    status, out, _ = judge(document, "--acceleration", "1", "--limits", "urdf")
    assert status == 1
    assert "limits urdf" in out and "acceleration is" in out


def test_a_plan_with_the_way_home_is_judged_to_its_end(judge):
    home = plan(TARGETS, START, Parameters(return_home=True))
    document = export.as_dict(home)
    assert judge(document)[0] == 0
    document["segments"][-1]["to"] = 4
    status, _, err = judge(document)
    assert status == 2 and "checkpoint 4" in err


def test_a_bag_of_commands_is_judged_message_by_message(planned, tmp_path, capsys):
    export.write_plan(tmp_path / "plan.bag", planned)
    assert main([str(tmp_path / "plan.bag")]) == 0
    good = export._message(planned.trajectory)
    write_bag(tmp_path / "two.bag", "/command", [good, message([point(0), point(1, v=[9] * 5)])])
    assert main([str(tmp_path / "two.bag")]) == 1
    out = capsys.readouterr().out
    assert "message 1 of 1" in out and "message 2 of 2" in out
    assert "moves at 9.0000 rad/s" in out


@pytest.mark.parametrize(
    ("broken", "sentence"),
    [
        (message([point(0)], ["a", "b\x1b[2J"]), "the joints are a, b?[2J;"),
        (message([point(0)], arm.JOINT_NAMES[::-1]), "in this order"),
        (message([]), "no points"),
        (message([point(0, q=START[:4])]), "4 values of position"),
        (message([point(0, a=())]), "0 values of acceleration"),
        (message([point(0, q=[np.nan, *START[1:]])]), "position of arm_joint_1 is nan"),
        (message([point(0), point(0)]), "does not come after"),
        (message([point(-1)]), "before the start"),
        (message([point(0), point(0.5), point(2)]), "apart"),
    ],
)
def test_a_broken_message_gets_a_sentence(tmp_path, capsys, broken, sentence):
    write_bag(tmp_path / "broken.bag", "/command", [broken])
    assert main([str(tmp_path / "broken.bag")]) == 1
    assert sentence in capsys.readouterr().out


def test_a_command_of_years_is_judged_in_no_time(tmp_path):
    write_bag(tmp_path / "slow.bag", "/command", [message([point(0), point(2**31 - 1)])])
    assert main([str(tmp_path / "slow.bag")]) == 0


def test_the_targets_of_a_bag_must_be_met(planned, tmp_path, capsys):
    export.write_plan(tmp_path / "plan.bag", planned)
    export.write_plan(tmp_path / "plan.json", planned)
    make_bag(tmp_path / "targets.bag", TARGETS)
    other = np.vstack([TARGETS.joints[0], TARGETS.joints[1] + 0.1])
    make_bag(tmp_path / "other.bag", Targets.from_joints(other))
    for name in ("plan.bag", "plan.json"):
        assert main([str(tmp_path / name), "--targets", str(tmp_path / "targets.bag")]) == 0
        assert main([str(tmp_path / name), "--targets", str(tmp_path / "other.bag")]) == 1
        assert "is missed by" in capsys.readouterr().out


def test_a_tool_that_leaves_its_line_is_found_from_the_json_alone(document, judge):
    k = len(document["points"]) // 4
    for point in document["points"][k : k + 3]:
        point["positions"][1] += 0.01
    status, out, _ = judge(document)
    assert status == 1 and "leaves its line" in out


def test_null_in_the_json_is_not_a_number(document, judge):
    document["points"][3]["velocities"][2] = None
    status, out, _ = judge(document)
    assert status == 1 and "velocity of arm_joint_3 is nan" in out


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        (lambda d: d.pop("points"), "has no 'points'"),
        (lambda d: d.update(points={}), "must be a list"),
        (lambda d: d["points"].append(7), "must be an object"),
        (lambda d: d["points"][1].pop("time_from_start"), "point 1 has no"),
        (lambda d: d["points"][1].update(time_from_start=True), "must be a number"),
        (lambda d: d["points"][1].update(time_from_start=1e300), "a time in s"),
        (lambda d: d["points"][1].update(positions=[0, "1", 0, 0, 0]), "must be a number"),
        (lambda d: d["points"][1].update(time_from_start=10**400), "a time in s"),
        (lambda d: d.update(joint_names=[1]), "must be a text"),
        (lambda d: d["segments"][0].update(kind="leap"), "'leap'"),
        (lambda d: d["segments"][0].update(end=-1.0), "backwards"),
        (lambda d: d["segments"].reverse(), "before the one before"),
        (lambda d: d["targets"].update(poses=[[1], [2, 3]]), "(4, 4)"),
        (lambda d: d.update(order=[0, 0]), "each of 2 targets once"),
        (lambda d: d["parameters"].update(acceleration=-1), "parameter acceleration"),
        (lambda d: d["parameters"].update(acceleration=10**400), "too large"),
        (lambda d: d["parameters"].update(limits=[]), "parameter limits"),
    ],
)
def test_json_of_another_form_ends_in_status_2_and_one_sentence(document, judge, change, sentence):
    change(document)
    status, out, err = judge(document)
    assert (status, out) == (2, "") and err.count("\n") == 1
    assert sentence in err and "plan.json" in err


@pytest.mark.parametrize("text", ["", "{", "[]", "1" * 5000, "[" * 100_000, "\x00"])
def test_what_is_no_plan_at_all_ends_in_status_2_and_one_sentence(judge, text):
    status, out, err = judge(text)
    assert (status, out) == (2, "") and err.count("\n") == 1


def test_points_alone_are_judged_as_well(document, judge):
    bare = {name: document[name] for name in ("joint_names", "points")}
    status, out, _ = judge(bare)
    assert status == 0 and "limits urdf" in out and "off the lines" not in out


def test_files_and_options_that_are_wrong_end_in_status_2(tmp_path, document, judge, capsys):
    make_bag(tmp_path / "targets.bag", TARGETS)
    targets = str(tmp_path / "targets.bag")
    assert main([str(tmp_path / "missing.json")]) == 2
    assert main([str(tmp_path / "missing.bag")]) == 2
    assert main([targets]) == 2
    assert "no topic holds trajectories" in capsys.readouterr().err
    assert judge(document, "--acceleration", "0")[0] == 2
    assert judge(document, "--targets", str(tmp_path / "missing.bag"))[0] == 2
    make_bag(tmp_path / "one.bag", Targets.from_joints(TARGETS.joints[:1]))
    assert "2 were planned" in judge(document, "--targets", str(tmp_path / "one.bag"))[2]


def test_the_script_runs_it(tmp_path, planned):
    export.write_plan(tmp_path / "plan.json", planned)
    command = [sys.executable, str(ROOT / "scripts/check_trajectory"), str(tmp_path / "plan.json")]
    result = subprocess.run(command, capture_output=True, text=True, timeout=60, check=False)
    assert result.returncode == 0 and result.stdout.endswith("every promise\n")
