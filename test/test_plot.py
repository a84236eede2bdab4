"""Pictures of plans are drawn, with what a person needs to read them."""

import sys
from dataclasses import replace
from xml.etree import ElementTree

import numpy as np
import pytest

from youbot_kinematics.colours import KIND_COLOURS
from youbot_kinematics.exceptions import InputError
from youbot_kinematics.planner import plan
from youbot_kinematics.plot import draw, plot_plan
from youbot_kinematics.targets import Targets
from youbot_kinematics.trajectory import interpolate

pytest.importorskip("matplotlib")

START = [0.5, 0.5, -2.0, 1.2, 0.6]
TARGETS = [[1.4, 0.4, -1.9, 1.0, 1.5], [0.9, 0.25, -1.8, 0.9, 1.0]]


@pytest.fixture(scope="module")
def planned():
    return plan(Targets.from_joints(TARGETS), START)


@pytest.fixture(scope="module")
def recorded(planned):
    times = np.arange(0.0, planned.trajectory.duration, 0.01)
    return times, interpolate(planned.trajectory, times - 0.05)[0]


def test_a_png_and_an_svg_are_drawn(planned, recorded, tmp_path):
    plot_plan(planned, tmp_path / "plan.png")
    plot_plan(planned, tmp_path / "plan.svg", recorded)
    assert (tmp_path / "plan.png").read_bytes().startswith(b"\x89PNG")
    assert ElementTree.parse(tmp_path / "plan.svg").getroot().tag.endswith("svg")


def test_every_axis_has_its_unit(planned):
    for axes in draw(planned).axes:
        assert any(unit in axes.get_ylabel() for unit in ("rad", "%", "mm", "(m)"))
        if axes.get_subplotspec().is_last_row() and axes.name != "3d":
            assert axes.get_xlabel() == "time (s)"


def test_targets_are_numbered_in_visiting_order(planned):
    (tour,) = [axes for axes in draw(planned).axes if axes.name == "3d"]
    assert [text.get_text() for text in tour.texts] == ["1", "2"]
    drawn_at = tour.texts[0].get_position_3d()
    np.testing.assert_allclose(drawn_at[:2], planned.targets.poses[1, :2, 3])


def test_the_tools_way_is_coloured_by_kind_and_the_legend_names_each_once(planned):
    first, *others = planned.trajectory.segments
    segments = (first._replace(kind="approach"), first._replace(kind="detour"), *others)
    trajectory = planned.trajectory._replace(segments=segments)
    (tour,) = [a for a in draw(replace(planned, trajectory=trajectory)).axes if a.name == "3d"]
    colours = {line.get_label(): line.get_color() for line in tour.lines}
    for kind in ("approach", "detour", "line"):
        assert colours[f"tool: {kind}"] == KIND_COLOURS[kind]
    names = [text.get_text() for text in tour.get_legend().get_texts()]
    assert len(names) == len(set(names))


def test_a_checkpoint_is_numbered_where_it_is_reached_and_nowhere_else(planned):
    last = planned.trajectory.segments[-1]
    middle = (last.start + last.end) / 2
    parts = (last._replace(end=middle), last._replace(start=middle, kind="reconfiguration"))
    trajectory = planned.trajectory._replace(segments=(*planned.trajectory.segments[:-1], *parts))
    figure = draw(replace(planned, trajectory=trajectory))
    (joint_1,) = [axes for axes in figure.axes if axes.get_ylabel() == "joint 1 (rad)"]
    assert [text.get_text() for text in joint_1.texts] == ["1", "2"]
    assert joint_1.texts[-1].xy[0] == last.end


def test_what_an_arm_did_is_drawn_over_what_was_planned(planned, recorded):
    def lines(figure):
        return sum(len(axes.lines) for axes in figure.axes)

    # once in space, once a joint, and its distance from the lines
    assert lines(draw(planned, recorded)) == lines(draw(planned)) + 7


def test_a_plan_without_straight_lines_is_drawn_as_well(planned, recorded, tmp_path):
    segments = tuple(s._replace(kind="reconfiguration") for s in planned.trajectory.segments)
    trajectory = planned.trajectory._replace(segments=segments)
    moved = type(planned)(**{**vars(planned), "trajectory": trajectory})
    plot_plan(moved, tmp_path / "plan.png", recorded)


def test_without_matplotlib_the_sentence_says_what_to_install(planned, tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "matplotlib.figure", None)
    with pytest.raises(InputError, match="python3-matplotlib"):
        plot_plan(planned, tmp_path / "plan.png")


def test_pictures_replace_no_file_and_have_a_known_format(planned, tmp_path):
    (tmp_path / "plan.png").write_text("mine")
    with pytest.raises(InputError, match="--force"):
        plot_plan(planned, tmp_path / "plan.png")
    with pytest.raises(InputError, match=r"\.svg"):
        plot_plan(planned, tmp_path / "plan.jpeg")
    assert [path.read_text() for path in tmp_path.iterdir()] == ["mine"]
