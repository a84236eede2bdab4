"""Makes bags of targets, in any of the forms that are met in the wild: no ROS needed.

The same command makes the same bag, byte for byte.
"""

from __future__ import annotations

import argparse
import sys
from typing import Callable, NamedTuple

import numpy as np
import yaml
from scipy.spatial.transform import Rotation

from . import arm
from .bag_writer import COMPRESSIONS, make, make_duration, make_header, write_bag
from .exceptions import InputError, YoubotError
from .targets import Targets

_NO_VALUES = np.empty(0)


class Form(NamedTuple):
    """A form of bag: its usual topic, and how its messages are made of targets."""

    topic: str
    messages: Callable[[Targets], list]


def _joint_states(names, positions) -> list:
    """A JointState for each row of positions."""
    header = make_header()
    return [
        make("sensor_msgs/JointState", header, list(names), row, _NO_VALUES, _NO_VALUES)
        for row in positions
    ]


def _joint_state(targets) -> list:
    return _joint_states(arm.JOINT_NAMES, targets.joints)


def _unnamed_joint_state(targets) -> list:
    return _joint_states((), targets.joints)


def _gripper_joint_state(targets) -> list:
    """Seven joints, the arm's in another order, as drivers of an arm with a gripper have it."""
    fingers = np.full((len(targets), 2), 0.0115)  # m
    names = ("gripper_finger_joint_l", "gripper_finger_joint_r", *reversed(arm.JOINT_NAMES))
    return _joint_states(names, np.hstack([fingers, targets.joints[:, ::-1]]))


def _joint_trajectory(targets) -> list:
    points = [
        make("trajectory_msgs/JointTrajectoryPoint", q, *3 * [_NO_VALUES], make_duration(0))
        for q in targets.joints
    ]
    names = list(arm.JOINT_NAMES)
    return [make("trajectory_msgs/JointTrajectory", make_header(), names, points)]


def _quaternion(T):
    return make("geometry_msgs/Quaternion", *Rotation.from_matrix(T[:3, :3]).as_quat())


def _transform(targets) -> list:
    return [
        make(
            "geometry_msgs/Transform",
            make("geometry_msgs/Vector3", *T[:3, 3]),
            _quaternion(T),
        )
        for T in targets.poses
    ]


def _transform_stamped(targets) -> list:
    header = make_header(arm.BASE_FRAME)
    return [
        make("geometry_msgs/TransformStamped", header, f"target_{number}", transform)
        for number, transform in enumerate(_transform(targets), start=1)
    ]


def _pose(targets) -> list:
    return [
        make("geometry_msgs/Pose", make("geometry_msgs/Point", *T[:3, 3]), _quaternion(T))
        for T in targets.poses
    ]


def _pose_stamped(targets) -> list:
    header = make_header(arm.BASE_FRAME)
    return [make("geometry_msgs/PoseStamped", header, pose) for pose in _pose(targets)]


def _pose_array(targets) -> list:
    return [make("geometry_msgs/PoseArray", make_header(arm.BASE_FRAME), _pose(targets))]


def _path(targets) -> list:
    return [make("nav_msgs/Path", make_header(arm.BASE_FRAME), _pose_stamped(targets))]


FORMS = {
    "joint_state": Form("/target_joint_states", _joint_state),
    "unnamed_joint_state": Form("joint_data", _unnamed_joint_state),
    "gripper_joint_state": Form("/target_joint_states", _gripper_joint_state),
    "joint_trajectory": Form("/target_joint_positions", _joint_trajectory),
    "transform": Form("target_position", _transform),
    "transform_stamped": Form("target_tf", _transform_stamped),
    "pose": Form("/target_pose", _pose),
    "pose_stamped": Form("/target_pose", _pose_stamped),
    "pose_array": Form("/target_poses", _pose_array),
    "path": Form("/target_path", _path),
}


def make_bag(
    path,
    targets: Targets,
    form: str = "joint_state",
    topic: str = "",
    compression: str = "none",
    force: bool = False,
) -> None:
    """Writes targets to a bag.

    Args:
        path: the bag, which ends in ``.bag``.
        targets: given as joint positions; forms of poses hold the tool's poses there.
        form: one of ``FORMS``.
        topic: topic of the messages; the form's usual one if empty.
        compression: one of ``COMPRESSIONS``.
        force: whether it may replace a file.

    Raises:
        InputError: there is no such form, or the file cannot be written.
    """
    if form not in FORMS:
        raise InputError(f"no form {form!r} of bag: choose one of {', '.join(FORMS)}")
    messages = FORMS[form].messages(targets)
    write_bag(path, topic or FORMS[form].topic, messages, compression, force)


def random_joints(count: int, seed: int, limits: arm.JointLimits) -> np.ndarray:
    """Joint positions (count, 5) in rad inside the limits, the same for the same seed."""
    return np.random.default_rng(seed).uniform(limits.lower, limits.upper, (count, arm.DOF))


def read_joints(path):
    """Rows of numbers from a YAML or JSON list of lists, or from CSV (``.csv``), not checked.

    Raises:
        InputError: the file cannot be read, or is not in the format that its name says.
    """
    try:
        if str(path).endswith(".csv"):
            return np.loadtxt(path, delimiter=",", ndmin=2)
        with open(path, encoding="utf-8") as file:
            return yaml.safe_load(file)
    except OSError as error:
        raise InputError(f"cannot read {path}: {error.strerror or error}") from error
    except (ValueError, yaml.YAMLError) as error:
        raise InputError(f"cannot read {path}: {' '.join(str(error).split())}") from error


def main(argv=None) -> int:
    """The command ``make_bag``; returns its exit status: 0, or 2 for bad input."""
    options = _parser().parse_args(argv)
    try:
        targets = Targets.from_joints(_joints(options), options.limits)
        make_bag(
            options.bag, targets, options.form, options.topic, options.compression, options.force
        )
    except YoubotError as error:
        print(f"make_bag: {error}", file=sys.stderr)
        return 2
    topic = options.topic or FORMS[options.form].topic
    print(f"{options.bag}: {len(targets)} targets on topic {topic} ({options.form})")
    return 0


def _joints(options):
    if options.targets:
        return read_joints(options.targets)
    if options.random is not None:
        return random_joints(options.random, options.seed, arm.joint_limits(options.limits))
    return options.target


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="make_bag",
        description="Makes a bag of targets for the youBot arm, without ROS.",
        formatter_class=argparse.ArgumentDefaultsHelpFormatter,
    )
    add = parser.add_argument
    add("bag", metavar="OUT", help="the bag to make, OUT.bag")
    source = parser.add_mutually_exclusive_group(required=True)
    source.add_argument(
        "--targets",
        metavar="FILE",
        help="file of joint positions (rad), five a target: a YAML or JSON list of lists, or .csv",
    )
    source.add_argument(
        "--target",
        nargs=arm.DOF,
        type=float,
        action="append",
        metavar=tuple(f"Q{i + 1}" for i in range(arm.DOF)),
        help="joint positions (rad) of a target; once for each target",
    )
    source.add_argument(
        "--random", type=_count, metavar="N", help="N targets at random inside the limits"
    )
    add("--seed", type=_count, default=0, help="of the random targets: same seed, same targets")
    add("--form", choices=FORMS, default="joint_state", help="what the messages are")
    add("--topic", default="", help="topic of the messages, if not the form's usual one")
    add("--limits", choices=arm.LIMITS, default="urdf", help="limits that the targets must keep")
    add("--compression", choices=COMPRESSIONS, default="none", help="of the bag")
    add("--force", action="store_true", help="replace a file of that name")
    return parser


def _count(text: str) -> int:
    value = int(text)
    if value < 0:
        raise argparse.ArgumentTypeError(f"{text} is negative")
    return value
