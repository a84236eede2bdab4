"""Targets in other frames than the arm's base: where those frames are, by TF."""

from __future__ import annotations

import numpy as np
import rospy
import tf2_ros

from .. import arm
from ..exceptions import BagError
from ..target_forms import transform_matrix
from .common import wait_for

#: How long TF may take to know a frame, s.
TIMEOUT = 5.0


def T_base_from(frame: str) -> np.ndarray:  # noqa: N802 (what textbooks call it)
    """The newest pose (4, 4), m, of a frame in ``base_link``.

    Raises:
        BagError: TF knows no way between the two.
        ShutdownError: ROS shuts down.
    """
    buffer = tf2_ros.Buffer()
    listener = tf2_ros.TransformListener(buffer)
    try:
        T = wait_for(lambda: _newest(buffer, frame), TIMEOUT)
    finally:
        listener.unregister()
    if T is None:
        raise BagError(
            f"given in frame {frame!r}, from which TF had no transform to {arm.BASE_FRAME} in"
            f" {TIMEOUT:g} s"
        )
    rospy.loginfo("targets in frame %s are taken to %s by TF, as it is now", frame, arm.BASE_FRAME)
    return T


def _newest(buffer, frame: str) -> np.ndarray | None:
    try:
        transform = buffer.lookup_transform(arm.BASE_FRAME, frame, rospy.Time()).transform
    except tf2_ros.TransformException:
        return None
    return transform_matrix(transform.translation, transform.rotation)
