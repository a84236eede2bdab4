"""Names for how the arm holds itself: reaching forward or back, with the elbow up or down."""

from __future__ import annotations

import numpy as np

from . import arm

# A tool this near to joint 1's axis (m) is on it; an elbow with so small a sine is straight.
_ON_AXIS, _STRAIGHT = 1e-9, 1e-9


def configuration(q: np.ndarray) -> dict[str, np.ndarray]:
    """The names of configurations, and whether the arm is in them.

    ``front`` and ``back``: the tool is on the side of joint 1's axis that the arm faces, or on the
    other. ``elbow_up`` and ``elbow_down``: the elbow is above, or below, the line from the shoulder
    to the wrist. On the axis, and with a straight elbow, the arm is in both.

    Args:
        q: joint positions (..., 5), rad.

    Returns:
        For each name a bool (...).
    """
    t2, elbow, t4 = np.moveaxis((q + arm.OFFSET)[..., 1:4], -1, 0)
    wrist = arm.A[1] * np.sin(t2) + arm.A[2] * np.sin(t2 + elbow)  # before the shoulder, m
    pitch = t2 + elbow + t4
    reach = wrist - arm.A[0] - arm.A[3] * np.cos(pitch) - arm.D[4] * np.sin(pitch)
    up = np.where(wrist < 0, -1.0, 1.0) * np.sin(elbow)
    return {
        "front": reach >= -_ON_AXIS,
        "back": reach <= _ON_AXIS,
        "elbow_up": up >= -_STRAIGHT,
        "elbow_down": up <= _STRAIGHT,
    }
