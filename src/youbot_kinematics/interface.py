"""The nodes' ROS interface as data: parameters, topics and services, defined once.

The nodes take their names from here, and so do the tables in the documents::

    python3 -m youbot_kinematics.interface
"""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import NamedTuple

from . import arm
from .exceptions import InputError
from .parameters import Checked, Parameters, parameter

_FOLDED = (0.0,) * arm.DOF


@dataclass(frozen=True)
class NodeParameters(Parameters):
    """The planner's parameters, and what only the node needs."""

    bag: str = parameter("", "bag file with the targets; required")
    start_timeout: float = parameter(
        5.0, "how long to wait for the arm's joint states, s", at_least=0.0, at_most=3600.0
    )
    subscriber_timeout: float = parameter(
        30.0, "how long to wait for a controller to listen, s", at_least=0.0, at_most=3600.0
    )

    def __post_init__(self):
        super().__post_init__()
        if not self.bag:
            raise InputError("parameter bag is required: the file with the targets (_bag:=FILE)")


@dataclass(frozen=True)
class SimulatorParameters(Checked):
    """What the simulator can be told."""

    start: tuple[float, ...] = parameter(_FOLDED, "where the arm stands at first, rad")
    limits: str = parameter("urdf", "profile of joint limits", choices=tuple(arm.LIMITS))
    rate: float = parameter(100.0, "joint states a second, Hz", at_least=1.0, at_most=1000.0)


@dataclass(frozen=True)
class TrailParameters(Checked):
    """What the trail can be told."""

    spacing: float = parameter(
        0.02, "how far the tool goes from one point of the trail to the next, m", at_least=0.001
    )
    points: int = parameter(
        3000, "length of the trail; its oldest points go first", at_least=2, at_most=100_000
    )
    rate: float = parameter(5.0, "how often a trail that grows is published, Hz", at_least=0.1)


@dataclass(frozen=True)
class SliderParameters(Checked):
    """What the sliders can be told."""

    start: tuple[float, ...] = parameter(_FOLDED, "where the sliders stand at first, rad")
    limits: str = parameter("urdf", "profile of joint limits", choices=tuple(arm.LIMITS))
    rate: float = parameter(30.0, "joint states a second, Hz", at_least=1.0, at_most=100.0)


class Channel(NamedTuple):
    """A topic or a service; a name without a slash can be remapped, ``~`` is the node's own."""

    name: str
    kind: str  # "published", "subscribed" or "service"
    type: str  # package/Type
    help: str


COMMAND = Channel(
    "EffortJointInterface_trajectory_controller/command",
    "published",
    "trajectory_msgs/JointTrajectory",
    "the trajectory, once a controller listens; not latched",
)
JOINT_STATES = Channel(
    "joint_states", "subscribed", "sensor_msgs/JointState", "where the arm is, by the joints' names"
)
CHECKPOINTS = Channel(
    "checkpoint_positions",
    "published",
    "visualization_msgs/MarkerArray",
    "the checkpoints with their frames, numbered as they are visited; latched",
)
PATH = Channel("planned_path", "published", "nav_msgs/Path", "the waypoints of the tool; latched")
SEGMENTS = Channel(
    "planned_segments",
    "published",
    "visualization_msgs/MarkerArray",
    "the way of the tool, coloured by what each segment is for; latched",
)
GOAL = Channel(
    "goal_arm",
    "published",
    "visualization_msgs/MarkerArray",
    "the arm as it stands at the end; latched",
)
REPLAN = Channel(
    "~replan", "service", "std_srvs/Trigger", "plans again, from where the arm stands now"
)
TRAIL = Channel(
    "tool_trail", "published", "visualization_msgs/Marker", "the way of the tool as it really went"
)

#: All that ``planner_node`` says and hears.
CHANNELS = (COMMAND, CHECKPOINTS, PATH, SEGMENTS, GOAL, JOINT_STATES, REPLAN)


def parameter_table(parameters=NodeParameters) -> str:
    """The parameters of a class as a Markdown table."""
    rows = [
        (f"`{f.name}`", _default(f), _values(f), f.metadata["help"]) for f in fields(parameters)
    ]
    return _table(("parameter", "default", "values", "meaning"), rows)


def channel_table(channels=CHANNELS) -> str:
    """Topics and services as a Markdown table."""
    rows = [(f"`{c.name}`", c.kind, f"`{c.type}`", c.help) for c in channels]
    return _table(("topic or service", "", "type", "what it carries"), rows)


def _default(f) -> str:
    if f.default is None or f.default == "":
        return ""
    return f"`{str(f.default).lower() if isinstance(f.default, bool) else f.default}`"


def _values(f) -> str:
    """What a parameter may be: a choice, or a range."""
    rule = f.metadata
    if rule["choices"]:
        return ", ".join(f"`{choice}`" for choice in rule["choices"])
    if isinstance(f.default, bool):
        return "`true`, `false`"
    if rule["at_least"] is None:
        return "text" if f.default == "" else "list"
    if rule["at_most"] is None:
        return f"at least {rule['at_least']:g}"
    return f"{rule['at_least']:g} to {rule['at_most']:g}"


def _table(titles, rows) -> str:
    lines = [titles, ["---"] * len(titles), *rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines)


if __name__ == "__main__":
    print(parameter_table(), channel_table(), sep="\n\n")
