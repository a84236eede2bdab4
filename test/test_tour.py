"""The visiting order: exact where it says so, checked against every permutation."""

from itertools import permutations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from youbot_kinematics.tour import (
    EXACT_UP_TO,
    held_karp,
    local_search,
    path_length,
    shortest_path,
)


def random_points(n, seed):
    points = np.random.default_rng(seed).uniform(-0.5, 0.5, (n + 1, 3))
    return points[0], points[1:]


def way(start, positions, order, home):
    """The points that the tool passes, (m, 3)."""
    return np.vstack([start, positions[list(order)], *([start] if home else [])])


def shortest_of_all(start, positions, home=False):
    """The length of the best of all permutations, as the coursework finds it."""
    orders = permutations(range(len(positions)))
    return min(path_length(way(start, positions, order, home)) for order in orders)


@pytest.mark.parametrize("home", [False, True])
@pytest.mark.parametrize("n", range(8))
def test_the_order_is_as_short_as_the_best_of_all_permutations(n, home):
    for seed in range(3):
        start, positions = random_points(n, seed)
        order, length = shortest_path(start, positions, home)
        assert sorted(order) == list(range(n))
        assert length == pytest.approx(shortest_of_all(start, positions, home), abs=1e-12)
        assert length == pytest.approx(path_length(way(start, positions, order, home)))


def shortest_by_sets(distances, home):
    """The length of the shortest path by Held and Karp's recursion, as the textbooks have it."""
    n = len(distances) - 1
    best = {(1 << j, j): distances[0, j + 1] for j in range(n)}
    for visited in range(1, 2**n):
        for j in (j for j in range(n) if visited >> j & 1 and visited != 1 << j):
            before = visited ^ 1 << j
            best[visited, j] = min(
                best[before, i] + distances[i + 1, j + 1] for i in range(n) if before >> i & 1
            )
    back = distances[1:, 0] if home else np.zeros(n)
    return min(best[2**n - 1, j] + back[j] for j in range(n))


@pytest.mark.parametrize("home", [False, True])
@pytest.mark.parametrize(
    "place",
    [
        lambda rng, n: rng.uniform(-0.5, 0.5, (n, 3)),
        lambda rng, n: rng.integers(0, 3, (n, 3)) * 0.1,  # many ways are of one length
        lambda rng, n: np.repeat(rng.uniform(-0.5, 0.5, (n // 3, 3)), 3, axis=0),
        lambda rng, n: rng.integers(0, 2, (n, 1)) + rng.normal(0, 0.01, (n, 3)),  # two heaps
        lambda rng, n: np.outer(rng.permutation(n), [1, 0, 0]),  # on a line
        lambda rng, n: np.zeros((n, 3)),
    ],
)
def test_the_order_is_exact_wherever_the_targets_are(place, home):
    points = place(np.random.default_rng(5), 12)
    distances = np.linalg.norm(points[:, None] - points, axis=-1)
    order, length = shortest_path(points[0], points[1:], home)
    assert sorted(order) == list(range(11))
    assert length == pytest.approx(shortest_by_sets(distances, home), abs=1e-12)


def test_the_exact_order_is_never_longer_than_the_local_search_s():
    for seed in range(10):
        start, positions = random_points(EXACT_UP_TO, seed)
        points = np.vstack([start, positions])
        order = local_search(np.linalg.norm(points[:, None] - points, axis=-1))
        length = path_length(points[np.append(0, order + 1)])
        assert shortest_path(start, positions)[1] <= length + 1e-12


def test_too_many_targets_for_an_exact_order_are_refused():
    with pytest.raises(ValueError, match="at most 21 nodes"):
        held_karp(np.zeros((EXACT_UP_TO + 2, EXACT_UP_TO + 2)))


def test_the_way_home_counts():
    targets = [[1, 0, 0], [1, 0.9, 0], [0, 0.95, 0]]
    assert shortest_path([0, 0, 0], targets)[1] == pytest.approx(2.85, abs=0.01)
    order, length = shortest_path([0, 0, 0], targets, return_home=True)
    assert order[1] == 1 and length == pytest.approx(3.85, abs=0.01)


@pytest.mark.parametrize("n", range(1, 7))
def test_a_tour_that_returns_home_is_the_best_of_all_permutations_too(n):
    for seed in range(5):
        start, positions = random_points(n, seed)
        order, length = shortest_path(start, positions, return_home=True)
        ways = (np.vstack([start, positions[list(o)], start]) for o in permutations(range(n)))
        assert length == pytest.approx(min(map(path_length, ways)), abs=1e-12)
        assert length == pytest.approx(path_length(np.vstack([start, positions[order], start])))


def test_the_length_is_the_tool_s_way_and_does_not_return_to_the_start():
    order, length = shortest_path([0, 0, 0], [[3, 0, 0], [1, 0, 0]])
    assert order.tolist() == [1, 0]
    assert length == 3.0


def test_repeated_targets_are_each_visited():
    order, length = shortest_path([0, 0, 0], [[1, 0, 0]] * 3)
    assert sorted(order) == [0, 1, 2]
    assert length == 1.0


@settings(max_examples=30)
@given(st.integers(2, 7), st.integers(0, 2**32 - 1), st.randoms(use_true_random=False))
def test_a_permutation_of_the_targets_does_not_change_the_length(n, seed, random):
    start, positions = random_points(n, seed)
    shuffled = list(range(n))
    random.shuffle(shuffled)
    assert shortest_path(start, positions[shuffled])[1] == pytest.approx(
        shortest_path(start, positions)[1], abs=1e-12
    )


@pytest.mark.parametrize("seed", range(5))
def test_the_local_search_finds_the_exact_order_of_a_small_tour(seed):
    start, positions = random_points(9, seed)
    points = np.vstack([start, positions])
    order = local_search(np.linalg.norm(points[:, None] - points, axis=-1))
    length = path_length(points[np.append(0, order + 1)])
    assert length == pytest.approx(shortest_path(start, positions)[1], rel=1e-3)


def test_the_local_search_can_return_home():
    start, positions = random_points(9, 0)
    points = np.vstack([start, positions])
    order = local_search(np.linalg.norm(points[:, None] - points, axis=-1), return_home=True)
    length = path_length(points[[0, *(order + 1), 0]])
    assert length == pytest.approx(shortest_path(start, positions, True)[1], rel=1e-3)


def test_many_targets_are_each_visited_once_by_a_short_path():
    start, positions = random_points(10 * EXACT_UP_TO, 0)
    order, length = shortest_path(start, positions)
    assert sorted(order) == list(range(len(positions)))
    nearest = greedy_length(start, positions)
    assert length < nearest


def greedy_length(start, positions):
    here, left, length = start, list(range(len(positions))), 0.0
    while left:
        away = np.linalg.norm(positions[left] - here, axis=1)
        here = positions[left.pop(int(np.argmin(away)))]
        length += away.min()
    return length
