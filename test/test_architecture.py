"""Imports go one way, from the top of a list to its bottom, and only the bottom knows ROS."""

import ast
import subprocess
import sys
from pathlib import Path

import pytest

PACKAGE = Path(__file__).resolve().parents[1] / "src/youbot_kinematics"

# A module may import those above it and none below it. "youbot_kinematics" is its __init__.py.
ROS_FREE = """
    exceptions resources files colours progress progress_bar
    arm formulas posture singularity intervals selection planar inverse position nearest kinematics
    kdl shapes
    bag_records rosbag1 rosbag2 bag_reader target_forms targets
    tour path trajectory track differential
    resolve.lines resolve.smoothing resolve.search resolve.route resolve.graph resolve.itinerary
    resolve.pitch resolve.roll resolve resolve.explain
    coursework optimal timing contract controller check parameters interface solvers planner summary
    bag_writer export plot page make_bag plan_job plan_bags plan_options plan_bag
    plan_reader check_trajectory
    youbot_kinematics
""".split()
ROS_BASED = """
    state_messages messages
    nodes nodes.ending nodes.master nodes.common nodes.frames nodes.joint_states
    nodes.arm_simulator nodes.view nodes.planner nodes.planner_start
    nodes.tool_trail nodes.joint_sliders nodes.demo
""".split()
ORDER = ROS_FREE + ROS_BASED

ROS = """
    actionlib catkin_pkg genpy geometry_msgs nav_msgs rosbag roscpp rosgraph rosgraph_msgs roslaunch
    roslib rosmaster rosnode rospkg rospy rostest rostopic sensor_msgs std_msgs std_srvs tf tf2_py
    tf2_ros trajectory_msgs visualization_msgs
""".split()
LOADED_ON_USE = "PyKDL fast_tsp matplotlib plotly urdf_parser_py".split()


def name_of(path):
    parts = path.relative_to(PACKAGE).with_suffix("").parts
    return ".".join(part for part in parts if part != "__init__") or "youbot_kinematics"


# With the stub of the one that is compiled
FILES = sorted([*PACKAGE.rglob("*.py"), *PACKAGE.rglob("*.pyi")])
MODULES = {name_of(path): path for path in FILES}


def imports_of(name):
    """Every name that the module imports, at its top or in a function, made absolute."""
    path = MODULES[name]
    package = ("youbot_kinematics", *path.relative_to(PACKAGE).parent.parts)
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            base = package[: len(package) - node.level + 1] if node.level else ()
            origin = ".".join([*base, *filter(None, [node.module])])
            yield from (f"{origin}.{alias.name}" for alias in node.names)


def modules_imported_by(name):
    """The package's own modules among them: ``from .arm import DOF`` means arm."""
    for imported in imports_of(name):
        first, _, rest = imported.partition(".")
        if first != "youbot_kinematics":
            continue
        while rest and rest not in MODULES:
            rest = rest.rpartition(".")[0]
        yield rest or "youbot_kinematics"


def test_every_module_has_its_place_in_the_order():
    unknown = sorted(set(MODULES) - set(ORDER))
    assert not unknown, f"put {unknown} into {__name__}.ORDER, below all that they import"


@pytest.mark.parametrize("name", [name for name in ORDER if name in MODULES])
def test_a_module_imports_only_what_stands_above_it(name):
    above = ORDER[: ORDER.index(name)]
    below = sorted(set(modules_imported_by(name)) - set(above))
    assert not below, f"{name} imports {below}, which do not stand above it in {__name__}.ORDER"


@pytest.mark.parametrize("name", [name for name in MODULES if name not in ROS_BASED])
def test_only_the_bottom_of_the_order_imports_ros(name):
    used = sorted({imported.partition(".")[0] for imported in imports_of(name)} & set(ROS))
    assert not used, f"{name} imports {used}: ROS belongs into one of {ROS_BASED}"


def loaded_by(*modules):
    """Which modules a new interpreter has after importing these."""
    code = f"import sys, {', '.join(modules)}; print(*sys.modules)"
    loaded = subprocess.check_output([sys.executable, "-c", code], text=True)
    return {module.partition(".")[0] for module in loaded.split()}


def test_importing_the_package_loads_no_ros_module_and_no_optional_one():
    loaded = loaded_by("youbot_kinematics")
    assert "numpy" in loaded
    assert not loaded & {*ROS, *LOADED_ON_USE}


def test_importing_all_that_is_ros_free_loads_no_ros_module():
    names = [name for name in MODULES if name in ROS_FREE and name != "youbot_kinematics"]
    assert not loaded_by(*(f"youbot_kinematics.{name}" for name in names)) & set(ROS)
