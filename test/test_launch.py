"""The launch files, as roslaunch reads them."""

from __future__ import annotations

import dataclasses

import pytest

roslaunch = pytest.importorskip("roslaunch")
rospkg = pytest.importorskip("rospkg")
try:
    rospkg.RosPack().get_path("youbot_kinematics")
except rospkg.ResourceNotFound:
    pytest.skip("needs a ROS environment with this package", allow_module_level=True)

from youbot_kinematics.nodes.planner import NodeParameters  # noqa: E402
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


def test_demo_launch_shows_rviz_only_if_asked():
    without = [node.type for node in load("demo.launch")[1]]
    with_rviz = [node.type for node in load("demo.launch", "rviz:=true")[1]]
    assert sorted([*without, "rviz"]) == sorted(with_rviz)


def test_demo_launch_plans_with_the_limits_of_the_simulated_arm():
    params, _ = load("demo.launch", "limits:=hardware")
    assert params["/planner_node/limits"] == params["/arm_simulator/limits"] == "hardware"
