"""Choosing among solutions, each criterion against its own words."""

import numpy as np
import pytest

from youbot_kinematics import InputError, YoubotKinematics

KIN = YoubotKinematics()
LIMITS = KIN.limits


def all_four():
    """A pose with four solutions, front and back, elbow up and down."""
    rng = np.random.default_rng(0)
    while True:
        q = rng.uniform(LIMITS.lower, LIMITS.upper)
        solutions = KIN.inverse_kinematics(KIN.forward_kinematics(q))
        if len(solutions) == 4:
            return solutions


SOLUTIONS = all_four()
SEED = SOLUTIONS[2] + 0.05


def test_least_movement_is_the_solution_next_to_the_seed():
    for q in SOLUTIONS:
        assert (KIN.select_solution(SOLUTIONS, "movement", seed=q + 0.01) == q).all()


def test_farthest_from_the_limits_has_the_largest_smallest_margin():
    chosen = KIN.select_solution(SOLUTIONS, "limits")
    margins = np.minimum(SOLUTIONS - LIMITS.lower, LIMITS.upper - SOLUTIONS) / (
        LIMITS.upper - LIMITS.lower
    )
    assert (chosen == SOLUTIONS[np.argmax(margins.min(axis=1))]).all()


def test_farthest_from_singularities_has_the_largest_smallest_singular_value():
    chosen = KIN.select_solution(SOLUTIONS, "singularity")
    assert KIN.smallest_singular_value(chosen) == max(map(KIN.smallest_singular_value, SOLUTIONS))


def test_smoothest_goes_on_as_it_came():
    for q in SOLUTIONS:
        step = 0.3 * (q - SOLUTIONS.mean(axis=0))
        assert (
            KIN.select_solution(SOLUTIONS, "smoothness", seed=q - step, previous=q - 2 * step) == q
        ).all()


@pytest.mark.parametrize("name", ["front", "back", "elbow_up", "elbow_down"])
def test_a_named_configuration_is_chosen_by_its_name(name):
    chosen = KIN.select_solution(SOLUTIONS, {name: 10.0, "movement": 1.0}, seed=SEED)
    assert KIN.configuration(chosen)[name]
    others = SOLUTIONS[KIN.configuration(SOLUTIONS)[name]]
    assert np.abs(chosen - SEED).sum() == np.abs(others - SEED).sum(axis=1).min()


def test_front_and_elbow_up_are_where_the_frames_are():
    q = np.random.default_rng(1).uniform(LIMITS.lower, LIMITS.upper, (2000, 5))
    named = KIN.configuration(q)
    facing = np.stack([np.cos(np.deg2rad(170) - q[:, 0]), np.sin(np.deg2rad(170) - q[:, 0])], -1)
    shoulder, elbow, wrist, tool = (KIN.forward_kinematics(q, i)[:, :3, 3] for i in (1, 2, 3, 5))
    assert (named["front"] == ((tool[:, :2] * facing).sum(-1) >= 0)).all()
    along = ((wrist - shoulder)[:, :2] * facing).sum(-1)
    elbow_along = ((elbow - shoulder)[:, :2] * facing).sum(-1)
    line = shoulder[:, 2] + (wrist - shoulder)[:, 2] * elbow_along / along
    assert (named["elbow_up"] == (elbow[:, 2] >= line)).all()


def test_weights_combine_criteria():
    movement = KIN.select_solution(SOLUTIONS, {"movement": 1.0, "limits": 1e-9}, seed=SEED)
    limits = KIN.select_solution(SOLUTIONS, {"movement": 1e-9, "limits": 1.0}, seed=SEED)
    assert (movement == KIN.select_solution(SOLUTIONS, "movement", seed=SEED)).all()
    assert (limits == KIN.select_solution(SOLUTIONS, "limits")).all()


def test_ties_are_broken_the_same_way_in_whatever_order_the_solutions_come():
    rng = np.random.default_rng(2)
    by_name = {tuple(KIN.select_solution(rng.permutation(SOLUTIONS), "front")) for _ in range(20)}
    assert len(by_name) == 1
    nearest_of_tied = KIN.select_solution(SOLUTIONS, {"front": 0.0}, seed=SOLUTIONS[3])
    assert (nearest_of_tied == SOLUTIONS[3]).all()


@pytest.mark.parametrize(
    ("solutions", "criterion", "sentence"),
    [
        (np.empty((0, 5)), "limits", "no solutions to choose from"),
        (np.zeros(5), "limits", r"got \(5,\)"),
        (np.full((1, 5), np.nan), "limits", "must be finite"),
        (SOLUTIONS, "beauty", "choose one of movement, limits, singularity, smoothness, front"),
        (SOLUTIONS, "movement", "needs seed="),
        (SOLUTIONS, {"smoothness": 1.0}, "needs seed="),
    ],
)
def test_what_cannot_be_chosen_from_is_refused_with_a_sentence(solutions, criterion, sentence):
    with pytest.raises(InputError, match=sentence):
        KIN.select_solution(solutions, criterion)
