"""How ``planner_node`` starts: it watches the arm while it imports what plans.

That the arm stands still takes 0.3 s to see, and the import takes as long.
"""

from __future__ import annotations

from ..interface import NodeParameters
from .common import read_parameters, run_node
from .joint_states import JointStates


def main() -> None:
    run_node("planner_node", _start)


def _start() -> None:
    parameters = read_parameters(NodeParameters.from_dict)
    joint_states = JointStates()
    from .planner import PlannerNode

    PlannerNode(parameters, joint_states).run()
