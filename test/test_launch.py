"""The launch files, as roslaunch reads them."""

from __future__ import annotations

import dataclasses
import subprocess
from pathlib import Path
from xml.etree import ElementTree

import pytest
import yaml

roslaunch = pytest.importorskip("roslaunch")
rospkg = pytest.importorskip("rospkg")
try:
    rospkg.RosPack().get_path("youbot_kinematics")
except rospkg.ResourceNotFound:
    pytest.skip("needs a ROS environment with this package", allow_module_level=True)

from youbot_kinematics import interface  # noqa: E402
from youbot_kinematics.interface import NodeParameters  # noqa: E402
from youbot_kinematics.resources import resource_path  # noqa: E402

GIVEN = {
    "bag": "2024",
    "topic": "joint_data",
    "start": [0.1, 0.2, -0.3, 0.4, 0.5],
    "order": "given",
    "num_points": 7,
    "kinematics": "kdl",
    "limits": "hardware",
    "velocity_scaling": 0.5,
    "acceleration": 2,
    "dt": 0.01,
    "start_timeout": 1.5,
    "subscriber_timeout": 10,
}


EXEC_DEPENDS = [
    depend.text for depend in ElementTree.parse(resource_path("package.xml")).iter("exec_depend")
]
LAUNCH_FILES = sorted(resource_path("launch").glob("*.launch"))


def load(name, *arguments):
    """Private parameters of its nodes by name, and the nodes, of a launch file."""
    path = str(resource_path(f"launch/{name}"))
    config = roslaunch.config.load_config_default([(path, list(arguments))], None)
    assert config.config_errors == []
    params = {p.key: p.value for p in config.params.values() if p.key.count("/") == 2}
    return params, config.nodes


def test_planner_launch_has_an_argument_for_every_parameter():
    defaults = {f.name: f.default for f in dataclasses.fields(NodeParameters)}
    given = {**defaults, **GIVEN}
    params, _ = load("planner.launch", *(f"{name}:={value}" for name, value in given.items()))
    assert {name.rpartition("/")[2] for name in params} == set(given)
    read = {name.rpartition("/")[2]: value for name, value in params.items()}
    assert dataclasses.asdict(NodeParameters.from_dict(read)) == dataclasses.asdict(
        NodeParameters.from_dict(given)
    )


def test_what_is_not_given_to_planner_launch_is_left_to_the_planner():
    params, _ = load("planner.launch", "bag:=targets.bag")
    assert params == {"/planner_node/bag": "targets.bag"}


def test_planner_launch_sends_where_it_is_told():
    _, [node] = load("planner.launch", "bag:=x", "command_topic:=arm_1/arm_controller/command")
    [(_, topic)] = [pair for pair in node.remap_args if "command" in pair[0]]
    assert topic == "arm_1/arm_controller/command"


def test_demo_launch_shows_rviz_and_the_trail_of_the_tool_only_if_asked():
    without = [node.type for node in load("demo.launch")[1]]
    with_rviz = [node.type for node in load("demo.launch", "rviz:=true")[1]]
    assert sorted([*without, "rviz", "tool_trail"]) == sorted(with_rviz)


def test_demo_launch_plans_with_the_limits_of_the_simulated_arm():
    params, _ = load("demo.launch", "limits:=hardware")
    assert params["/planner_node/limits"] == params["/arm_simulator/limits"] == "hardware"


def test_youbot_launch_has_the_drivers_topics_and_limits_and_passes_everything_on():
    params, [node] = load("youbot.launch", "bag:=x", "num_points:=7", "timing:=cubic")
    assert dict(node.remap_args) == {
        "EffortJointInterface_trajectory_controller/command": "arm_1/arm_controller/command",
        "joint_states": "joint_states",
    }
    read = {name.rpartition("/")[2]: value for name, value in params.items()}
    assert read == {
        "bag": "x",
        "num_points": 7,
        "timing": "cubic",
        "limits": "hardware",
        "velocity_scaling": 0.5,
    }


def test_display_launch_has_sliders_unless_told_otherwise():
    params, nodes = load("display.launch", "limits:=hardware")
    assert "joint_sliders" in [node.type for node in nodes]
    assert params["/joint_sliders/limits"] == "hardware"
    _, without = load("display.launch", "sliders:=false")
    assert "joint_sliders" not in [node.type for node in without]


@pytest.mark.parametrize("path", LAUNCH_FILES, ids=lambda path: path.name)
def test_every_launch_file_is_read_with_all_that_it_includes(path):
    said = subprocess.run(
        ["roslaunch", "--files", str(path), "bag:=x"], capture_output=True, text=True, check=True
    )
    files = said.stdout.split()
    assert str(path) in files and all(Path(file).is_file() for file in files)


@pytest.mark.parametrize("path", LAUNCH_FILES, ids=lambda path: path.name)
def test_every_argument_of_a_launch_file_says_what_it_is_for(path):
    for argument in ElementTree.parse(path).getroot().findall("arg"):
        assert argument.get("doc"), argument.get("name")


@pytest.mark.parametrize("path", LAUNCH_FILES, ids=lambda path: path.name)
def test_every_node_of_a_launch_file_is_ours_or_a_dependency(path):
    for switch in ("true", "false"):
        for node in load(path.name, "bag:=x", f"rviz:={switch}", f"sliders:={switch}")[1]:
            if node.package == "youbot_kinematics":
                assert resource_path(f"scripts/{node.type}").stat().st_mode & 0o111
            else:
                assert node.package in EXEC_DEPENDS


def test_rviz_is_set_up_for_every_topic_that_there_is_to_see():
    config = yaml.safe_load(resource_path("config/demo.rviz").read_text())
    displays = config["Visualization Manager"]["Displays"]
    topics = {display.get("Topic") or display.get("Marker Topic") for display in displays} - {None}
    names = ("CHECKPOINTS", "PATH", "SEGMENTS", "GOAL", "TRAIL")
    assert topics == {getattr(interface, name).name for name in names}
    assert all(display["Enabled"] for display in displays)
