"""Progress: silence for quick work, a bar on a terminal, and lines in a log elsewhere."""

import io

import numpy as np
import pytest

from youbot_kinematics import progress_bar
from youbot_kinematics.make_bag import make_bag
from youbot_kinematics.parameters import Parameters
from youbot_kinematics.planner import plan
from youbot_kinematics.progress import listened_by, with_progress
from youbot_kinematics.progress_bar import as_bar, as_line, shown
from youbot_kinematics.targets import Targets, load_targets


class Terminal(io.StringIO):
    def isatty(self):
        return True


@pytest.fixture
def clock(monkeypatch):
    """A clock that moves on by 0.4 s whenever it is read."""
    times = iter(np.arange(0.0, 1000.0, 0.4))
    monkeypatch.setattr(progress_bar.time, "monotonic", lambda: next(times))


def test_a_loop_without_a_listener_is_the_loop_alone():
    assert list(with_progress("abc", "spelling", 3)) == ["a", "b", "c"]


def test_a_listener_hears_every_step_and_the_end_inside_its_block_only():
    heard = []
    with listened_by(lambda *state: heard.append(state)):
        list(with_progress("ab", "spelling", 2))
    list(with_progress("cd", "spelling", 2))
    assert heard == [("spelling", 0, 2), ("spelling", 1, 2), ("spelling", 2, 2)]


def test_work_of_less_than_a_second_shows_nothing():
    stream, lines = io.StringIO(), []
    with shown(stream, lines.append):
        list(with_progress(range(100), "counting", 100))
    assert lines == [] and stream.getvalue() == ""


def test_long_work_draws_a_bar_on_a_terminal_and_takes_it_away(clock):
    terminal, lines = Terminal(), []
    with shown(terminal, lines.append):
        list(with_progress(range(20), "counting", 20))
    drawn = terminal.getvalue()
    assert "counting: 20 of 20 (100%)" in drawn and "#" * 30 in drawn
    assert drawn.endswith("\r\033[K") and lines == []


def test_long_work_writes_a_line_now_and_then_elsewhere(clock):
    stream, lines = io.StringIO(), []
    with shown(stream, lines.append):
        list(with_progress(range(100), "counting", 100))
    assert 5 < len(lines) < 15 and stream.getvalue() == ""
    assert all(line.startswith("counting: ") for line in lines)


def test_a_wrong_total_does_no_harm():
    assert as_line("reading", 5, 0) == "reading: 5 of 0 (100%)"
    assert len(as_bar("reading", 7, 5)) == len(as_bar("reading", 5, 5))


@pytest.mark.parametrize(
    ("solver", "work"),
    [
        ("pseudo_inverse", "tracking the lines"),
        ("closed_form", "searching the joints along the tour"),
    ],
)
def test_reading_and_planning_say_how_far_they_are(tmp_path, solver, work):
    q = [[1.4, 0.4, -1.9, 1.0, 1.5], [0.9, 0.25, -1.8, 0.9, 1.0]]
    make_bag(tmp_path / "targets.bag", Targets.from_joints(q))
    heard = set()
    with listened_by(lambda what, done, total: heard.add((what, done == total))):
        targets = load_targets(tmp_path / "targets.bag")
        plan(targets, [0.5, 0.5, -2.0, 1.2, 0.6], Parameters(solver=solver))
    assert {("reading the targets", True), (work, True), ("timing the lines", True)} <= heard
