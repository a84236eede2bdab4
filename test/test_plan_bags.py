"""Several bags at once: one that is bad costs the others nothing."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from youbot_kinematics import PlanningError, plan_bag
from youbot_kinematics.make_bag import make_bag
from youbot_kinematics.plan_bags import Outcome, alone, table
from youbot_kinematics.targets import Targets

SCRIPT = Path(__file__).resolve().parents[1] / "scripts/plan_bag"
Q = [[1.4, 0.4, -1.9, 1.0, 1.5], [0.9, 0.25, -1.8, 0.9, 1.0]]
HARD = [[0.2, 1.8, -2.2, 1.9, 1.0], [3.3, 1.8, -2.2, 1.9, 1.0]]
OPTIONS = ["--start", "0.5", "0.5", "-2.0", "1.2", "0.6", "--solver", "pseudo_inverse"]


@pytest.fixture
def submissions(tmp_path):
    """A folder for each student, with a bag of the same name."""
    paths = []
    for student, joints in {"ada": Q, "bob": HARD, "cyd": Q}.items():
        (tmp_path / student).mkdir()
        paths.append(tmp_path / student / "targets.bag")
        make_bag(paths[-1], Targets.from_joints(joints))
    (tmp_path / "dan").mkdir()
    paths.append(tmp_path / "dan/targets.bag")
    paths[-1].write_text("not a bag")
    return [str(path) for path in paths]


def test_each_bag_has_its_row_and_its_files_and_the_worst_decides(submissions, tmp_path, capsys):
    output = ["--output", str(tmp_path / "{folder}.json")]
    assert plan_bag.main([*submissions, *OPTIONS, *output]) == 2
    titles, *rows, count = capsys.readouterr().out.splitlines()
    assert titles.split()[:3] == ["bag", "result", "targets"]
    assert [row.split()[0] for row in rows] == submissions
    assert [row.split("  ")[1].strip() for row in rows] == [
        "planned",
        "no plan",
        "planned",
        "bad input",
    ]
    assert count == "4 bags: 2 planned, 1 no plan, 1 bad input"
    assert sorted(path.stem for path in tmp_path.glob("*.json")) == ["ada", "cyd"]
    assert json.loads((tmp_path / "ada.json").read_text())["report"]["passed"]


def test_the_program_itself_plans_several_bags(submissions):
    command = [sys.executable, str(SCRIPT), submissions[0], submissions[2], *OPTIONS]
    result = subprocess.run(command, capture_output=True, text=True, timeout=120, check=False)
    assert result.returncode == 0 and result.stdout.endswith("2 bags: 2 planned\n")


def test_without_a_bad_one_the_status_is_that_of_no_plan(submissions):
    assert plan_bag.main([*submissions[:2], *OPTIONS]) == 1


@pytest.mark.parametrize("name", ["plan.json", "{bag}.json", "-"])
def test_bags_that_would_share_a_file_are_refused(submissions, tmp_path, monkeypatch, capsys, name):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(plan_bag, "plan_bags", lambda *_: pytest.fail("planned for nothing"))
    assert plan_bag.main([*submissions, *OPTIONS, "--output", name]) == 2
    assert "{folder}" in capsys.readouterr().err


def test_a_process_that_dies_is_an_error_and_no_more():
    with pytest.raises(PlanningError, match="died"):
        alone(os._exit, 1)


def test_what_a_process_raises_is_raised_here():
    with pytest.raises(ZeroDivisionError):
        alone(divmod, 1, 0)


def test_the_columns_of_the_table_are_aligned():
    planned = Outcome("a.bag", 0, "closed_form", "4", "1.250", "12.30", "1")
    lines = table([planned, Outcome("b", 1, "out of reach")])
    starts = [lines[0].index("solver"), lines[1].index("closed"), lines[2].index("out of")]
    assert len(set(starts)) == 1
