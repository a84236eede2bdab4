"""Targets of a tour, and how to read them from a bag.

A target is where the tool shall go: the arm's joint positions, or a pose of ``arm_link_ee`` in
``base_link``. Which messages can hold targets is a table in ``target_forms``.
"""

from __future__ import annotations

import os
from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path
from typing import Callable

import numpy as np

from . import arm
from .bag_reader import choose_topic, describe, one_sentence, open_bag, ros1_name
from .exceptions import BagError, InputError
from .inverse import as_transforms
from .kinematics import YoubotKinematics, as_joints
from .progress import with_progress
from .target_forms import FORMS

# A joint this little outside of its limit (rad) is on the limit: its value went through single
# precision or a decimal text on the way here.
_LIMIT_ROUNDING = 1e-6

#: So many targets are read from a bag, and no more: memory is for those that can be meant.
MOST_TARGETS = 200_000

_BASE_FRAMES = ("", arm.BASE_FRAME)


@dataclass(frozen=True, eq=False)
class Targets:
    """Where the tool shall go, in the order given."""

    poses: np.ndarray  # (n, 4, 4): arm_link_ee in base_link, m
    joints: np.ndarray | None  # (n, 5) rad where given as joint positions, or None
    source: str  # for people: where they are from
    warning: str = ""  # for people: what was lost on the way

    def __len__(self) -> int:
        return len(self.poses)

    @classmethod
    def from_joints(cls, joints, limits="urdf", source: str = "joint positions") -> Targets:
        """Targets from joint positions (n, 5), rad.

        A value outside of its limit by no more than rounding is set on the limit.

        Raises:
            InputError: none, another shape, or a value that is not finite or outside its limits.
        """
        model = YoubotKinematics(limits)
        joints = as_joints(joints)
        if joints.ndim != 2 or not len(joints):
            raise InputError(f"targets must be one row of joints each, (n, 5), not {joints.shape}")
        _require_inside(joints, model.limits)
        joints = np.clip(joints, model.limits.lower, model.limits.upper)
        return cls(model.forward_kinematics(joints), joints, source)

    @classmethod
    def from_poses(cls, poses, source: str = "poses") -> Targets:
        """Targets from poses of ``arm_link_ee`` in ``base_link``, (n, 4, 4), m.

        Raises:
            InputError: none, or not an array of rigid transforms.
        """
        poses = as_transforms(poses)
        if poses.ndim != 3 or not len(poses):
            raise InputError(f"targets must be one pose each, (n, 4, 4), not {poses.shape}")
        return cls(poses, None, source)


def no_transform(frame: str) -> np.ndarray:
    """Stands in for TF where there is none.

    Raises:
        BagError: always.
    """
    raise BagError(
        f"given in frame {frame!r}; without TF only poses in {arm.BASE_FRAME} can be used"
    )


def load_targets(
    bag,
    topic: str = "",
    limits="urdf",
    T_base_from: Callable[[str], np.ndarray] = no_transform,
) -> Targets:
    """Reads the targets in a bag, in the bag's order.

    Of a bag that was never closed, as a killed recorder leaves it, the messages that are there as a
    whole are read, and ``warning`` says so.

    Args:
        bag: path of a ROS 1 bag (``.bag``), or of a ROS 2 bag's folder.
        topic: topic of the targets, with or without the leading slash; found by itself if empty.
        limits: profile of joint limits, or ``JointLimits``, that joint targets must keep.
        T_base_from: gives the pose (4, 4), m, of another frame in ``base_link`` by its name, or
            raises a BagError; asked once for each frame.

    Raises:
        BagError: it cannot be read, no topic or several topics fit, or a target cannot be used.
        InputError: there is no such profile of limits.
    """
    limits = arm.joint_limits(limits)
    path = Path(os.path.expanduser(str(bag)))
    with one_sentence(path):
        values, origin, warning = _read(path, topic, T_base_from)
        source = f"{path.name}, {origin}"
        if values[0].shape == (arm.DOF,):
            targets = Targets.from_joints(values, limits, source)
        else:
            targets = Targets.from_poses(values, source)
        return replace(targets, warning=warning and f"{path.name}: {warning}")


def _read(path: Path, topic: str, T_base_from) -> tuple[list[np.ndarray], str, str]:
    """Every target in a bag, arrays (5,) or (4, 4), one at least; topic and type; what is lost."""
    with open_bag(path) as bag:
        connections = choose_topic(bag.connections, topic, FORMS, "targets")
        values = _read_messages(bag, connections, lru_cache(maxsize=None)(T_base_from))
        if not values:
            raise BagError(f"no targets in the messages of {describe(connections)}")
        origin = f"topic {connections[0].topic} ({ros1_name(connections[0].msgtype)})"
        return values, origin, getattr(bag, "warning", "")


def _read_messages(bag, connections, T_base_from) -> list[np.ndarray]:
    values: list[np.ndarray] = []
    count = sum(connection.msgcount for connection in connections)
    messages = with_progress(bag.messages(connections), "reading the targets", count)
    for connection, _, raw in messages:
        message = bag.deserialize(raw, connection.msgtype)
        try:
            for frame, value in FORMS[connection.msgtype](message):
                values.append(value if frame in _BASE_FRAMES else T_base_from(frame) @ value)
        except InputError as error:
            raise BagError(f"target {len(values) + 1} on {connection.topic}: {error}") from error
        if len(values) > MOST_TARGETS:
            raise BagError(f"more than {MOST_TARGETS:,} targets on {connection.topic}")
    return values


def _require_inside(joints: np.ndarray, limits: arm.JointLimits) -> None:
    """Joint targets (n, 5) rad must keep the limits, up to rounding."""
    inside = limits.contain(joints, _LIMIT_ROUNDING)
    if inside.all():
        return
    i = int(np.argmin(inside))
    hint = ""
    if limits.contain(joints + arm.UPRIGHT, _LIMIT_ROUNDING).all():
        offsets = ", ".join(f"{offset:.6f}" for offset in arm.UPRIGHT)
        hint = (
            "; these look like readings centred on the upright arm, where the URDF's are zero at"
            f" the folded arm: add ({offsets}) rad to each, and all targets fit"
        )
    raise InputError(
        f"target {i + 1} of {len(joints)}: {limits.describe_violation(joints[i])}{hint}"
    )
