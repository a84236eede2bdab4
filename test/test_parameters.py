"""Parameters are checked once, before anything moves."""

import pytest

from youbot_kinematics import InputError
from youbot_kinematics.parameters import Parameters


def test_the_defaults_are_valid():
    assert Parameters.from_dict({}) == Parameters()


def test_an_integer_will_do_for_a_number():
    assert Parameters(acceleration=2).acceleration == 2.0


@pytest.mark.parametrize(
    ("values", "sentence"),
    [
        ({"oder": "given"}, "did you mean 'order'"),
        ({"nonsense": 1}, "known: "),
        ({"order": "random"}, "must be 'shortest' or 'given', not 'random'"),
        ({"num_points": 1.5}, "num_points must be a whole number"),
        ({"detour": "no"}, "detour must be true or false"),
        ({"topic": 3}, "topic must be a text"),
        ({"num_points": -1}, "at least 0, not -1"),
        ({"num_points": True}, "num_points must be"),
        ({"acceleration": 0.0}, "at least 0.01, not 0"),
        ({"acceleration": float("nan")}, "must be finite"),
        ({"velocity_scaling": 1.5}, "at most 1, not 1.5"),
        ({"dt": "fast"}, "dt must be"),
        ({"limits": "none"}, "'urdf' or 'hardware'"),
        ({"start": [0, 0]}, "five finite numbers"),
        ({"start": [0, 0, 0, 0, float("inf")]}, "five finite numbers"),
        ({"start": "home"}, "five numbers"),
        ({"solver": "pseudo_inverse", "checkpoint": "pose"}, "solver and checkpoint contradict"),
        ({"solver": "pseudo_inverse", "checkpoint": "joints"}, "solver and checkpoint contradict"),
        ({"solver": "pseudo_inverse", "orientation_weight": 1.0}, "orientation_weight contradict"),
        ({"solver": "closed_form", "kinematics": "kdl"}, "solver and kinematics contradict"),
    ],
)
def test_a_bad_value_is_refused_in_a_sentence(values, sentence):
    with pytest.raises(InputError, match=sentence):
        Parameters.from_dict(values)
