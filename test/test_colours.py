"""Colours stand for every kind of segment, and for one each."""

import pytest

from youbot_kinematics.colours import KIND_COLOURS, rgb
from youbot_kinematics.trajectory import KINDS


def test_every_kind_of_segment_has_a_colour_of_its_own():
    assert set(KIND_COLOURS) == set(KINDS)
    assert len(set(KIND_COLOURS.values())) == len(KIND_COLOURS)


def test_a_colours_parts_are_fractions():
    assert rgb("#FF8000") == pytest.approx((1.0, 128 / 255, 0.0))
