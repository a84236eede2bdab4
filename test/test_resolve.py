"""Joint paths along straight lines: on the line, inside the limits, with the fewest stops."""

import heapq

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from youbot_kinematics import YoubotKinematics, arm
from youbot_kinematics.exceptions import PlanningError
from youbot_kinematics.resolve import Options, resolve
from youbot_kinematics.resolve.graph import lay_out
from youbot_kinematics.resolve.lines import straight_line
from youbot_kinematics.resolve.search import (
    APPROACH_COST,
    DETOUR,
    REACH,
    RECONFIGURATION_COST,
    SAME,
    SMOOTH,
    SWAPPED,
    TEAR,
    best_walk,
)

KINEMATICS = {profile: YoubotKinematics(profile) for profile in arm.LIMITS}
ZEROS = np.zeros(5)
MIDDLE = (arm.LIMITS["urdf"].lower + arm.LIMITS["urdf"].upper) / 2
# The targets of the course's bag, in their shortest order from all zeros.
COURSE = np.array(
    [
        [4.05421051, 0.79926992, -2.28874961, 1.26920201, 2.64558435],
        [4.70848438, 1.37521755, -3.21426182, 1.78876146, 1.73020361],
        [1.43876323, 0.70547762, -2.5123522, 1.38666657, 1.62116132],
        [4.62257656, 1.49199568, -2.44350691, 2.09365912, 0.99909748],
    ]
)


def tool(q, profile="urdf"):
    return KINEMATICS[profile].forward_kinematics(q)[..., :3, 3]


def tour_of(joints, profile="urdf"):
    return joints[0], tool(np.asarray(joints), profile)


def random_tours(n, seed=5):
    rng = np.random.default_rng(seed)
    for i in range(n):
        profile = ("urdf", "hardware")[i % 2]
        limits = arm.LIMITS[profile]
        joints = rng.uniform(limits.lower, limits.upper, (rng.integers(2, 6), 5))
        yield (*tour_of(joints, profile), limits)


def dense(path, per_step=7):
    index = np.arange(0, len(path.s) - 1 + 1e-9, 1 / per_step)
    return path.spline()(np.interp(index, np.arange(len(path.s)), path.s))


def distance_to_line(points, a, b):
    along = (b - a) / np.linalg.norm(b - a)
    done = np.clip((points - a) @ along, 0, np.linalg.norm(b - a))
    return np.linalg.norm(points - a - done[:, None] * along, axis=1)


def assert_sound(paths, start, points, limits):
    """All that every answer promises: no jump, no limit passed, the tool on its lines."""
    np.testing.assert_array_equal(paths[0].joints[0], start)
    np.testing.assert_allclose(tool(paths[-1].joints[-1]), points[-1], atol=1e-9)
    for before, after in zip(paths, paths[1:]):
        np.testing.assert_array_equal(before.joints[-1], after.joints[0])
    for path in paths:
        q = dense(path)
        assert limits.contain(q, 1e-9).all(), path.kind
        assert np.abs(np.diff(q, axis=0)).max() < 0.3 or path.kind != "line"
        if path.kind == "line":
            a, b = points[path.from_checkpoint], points[path.to_checkpoint]
            assert distance_to_line(tool(q), a, b).max() < 5e-5
        elif path.kind != "detour":
            np.testing.assert_allclose(tool(path.joints[0]), tool(path.joints[1]), atol=1e-8)
    visited = [path.from_checkpoint for path in paths] + [paths[-1].to_checkpoint]
    assert visited == sorted(visited) and set(visited) == set(range(len(points)))


@pytest.mark.parametrize("start", [ZEROS, MIDDLE])
def test_the_course_tour_is_solved_from_zeros_and_from_the_middle(start):
    start, points = tour_of(np.vstack([start, COURSE]))
    assert_sound(resolve(start, points, arm.LIMITS["urdf"]), start, points, arm.LIMITS["urdf"])


def test_the_course_tour_needs_no_reconfiguration_after_its_first_move():
    paths = resolve(*tour_of(np.vstack([ZEROS, COURSE])), arm.LIMITS["urdf"])
    assert [path.kind for path in paths] == ["approach"] + ["line"] * 4


@pytest.mark.parametrize("start, points, limits", list(random_tours(12)))
def test_random_tours_of_both_profiles_are_solved(start, points, limits):
    assert_sound(resolve(start, points, limits), start, points, limits)


def test_a_start_a_hair_outside_of_its_limits_is_left_from_where_it_is():
    start = np.array([-1e-7, 0.3, 2e-8, 0.4, 1.0])
    points = tool(np.array([start, [0.5, 0.6, -0.7, 0.8, 1.0]]))
    paths = resolve(start, points, arm.LIMITS["urdf"])
    np.testing.assert_array_equal(paths[0].joints[0], start)
    assert np.abs(arm.LIMITS["urdf"].excess(dense(paths[-1]))).max() <= 1e-7


def test_a_line_through_joint_1s_axis_bends_over_its_back_and_leaves_joint_1_alone():
    points = np.array([[0.2, 0.0, 0.45], [-0.2, 0.0, 0.45]])
    start = starts_at(points[0])
    paths = resolve(start, points, arm.LIMITS["urdf"])
    assert_sound(paths, start, points, arm.LIMITS["urdf"])
    line = [path for path in paths if path.kind == "line"]
    assert sum(np.ptp(path.joints[:, 0]) for path in line) < 1e-9


@pytest.mark.parametrize("offset", [1e-7, 1e-5, 1e-3])
def test_a_line_close_to_joint_1s_axis_turns_joint_1_and_stays_on_the_line(offset):
    points = np.array([[0.2, offset, 0.45], [-0.2, offset, 0.45]])
    start = starts_at(points[0])
    assert_sound(resolve(start, points, arm.LIMITS["urdf"]), start, points, arm.LIMITS["urdf"])


def test_two_checkpoints_at_one_place_are_no_trouble():
    q = np.array([2.0, 1.0, -1.5, 1.2, 2.0])
    points = tool(np.array([q, q, [2.2, 1.0, -1.4, 1.2, 2.0]]))
    paths = resolve(q, points, arm.LIMITS["urdf"])
    assert paths[-1].to_checkpoint == 2


def test_a_joint_target_ends_at_exactly_its_joints():
    start, points = tour_of(np.vstack([ZEROS, COURSE]))
    exact = [None, *COURSE[:, None]]
    paths = resolve(start, points, arm.LIMITS["urdf"], exact=exact)
    assert_sound(paths, start, points, arm.LIMITS["urdf"])
    for number, q in enumerate(COURSE, start=1):
        ends = [path.joints[-1] for path in paths if path.to_checkpoint == number]
        assert any((end == q).all() for end in ends)


def test_an_orientation_is_followed_where_it_counts():
    start, points = tour_of(np.vstack([ZEROS, COURSE]))
    R = KINEMATICS["urdf"].forward_kinematics(np.vstack([ZEROS, COURSE]))[:, :3, :3]
    misses = []
    for weight in (0.0, 30.0):
        options = Options(orientation_weight=weight)
        paths = resolve(start, points, arm.LIMITS["urdf"], rotations=R, options=options)
        assert_sound(paths, start, points, arm.LIMITS["urdf"])
        reached = KINEMATICS["urdf"].forward_kinematics(
            [next(p.joints[-1] for p in paths[::-1] if p.to_checkpoint == i) for i in range(1, 5)]
        )[:, :3, :3]
        cosine = (np.einsum("nij,nij->n", R[1:], reached) - 1) / 2
        misses.append(np.arccos(np.clip(cosine, -1, 1)).sum())
    assert misses[1] < 0.5 * misses[0]


def test_joint_5_never_jumps_by_a_whole_turn():
    start, points = tour_of(np.vstack([ZEROS, COURSE]))
    R = KINEMATICS["urdf"].forward_kinematics(np.vstack([ZEROS, COURSE]))[:, :3, :3]
    options = Options(orientation_weight=30.0)
    for path in resolve(start, points, arm.LIMITS["urdf"], rotations=R, options=options):
        if path.kind == "line":
            assert np.abs(np.diff(path.joints[:, 4])).max() < 0.2


def starts_at(point, profile="urdf"):
    """Some joints inside the limits with the tool at a point."""
    azimuth = Rotation.from_euler("z", np.arctan2(point[1], point[0]))
    T = np.eye(4)
    T[:3, 3] = point
    for pitch in np.linspace(-3, 3, 61):
        T[:3, :3] = (azimuth * Rotation.from_euler("y", pitch)).as_matrix()
        solutions = KINEMATICS[profile].inverse_kinematics(T)
        if len(solutions):
            return solutions[0]
    raise AssertionError("no start at that point")


def tour_that(kind):
    """The first random tour whose answer has a path of a kind."""
    for start, points, limits in random_tours(80, seed=1):
        if kind in [path.kind for path in resolve(start, points, limits)]:
            return start, points, limits
    raise AssertionError(f"no tour with a {kind}")


@pytest.mark.parametrize("kind, option", [("reconfiguration", "reconfigure"), ("detour", "detour")])
def test_what_is_forbidden_is_refused_with_the_segment_and_the_point(kind, option):
    start, points, limits = tour_that(kind)
    with pytest.raises(PlanningError, match=r"segment \d to \d, at \("):
        resolve(start, points, limits, options=Options(**{option: False}))


def test_a_checkpoint_out_of_reach_is_named():
    with pytest.raises(PlanningError, match=r"checkpoint 1 at .* is out of reach"):
        resolve(ZEROS, np.array([tool(ZEROS), [0.9, 0, 0.2]]), arm.LIMITS["urdf"])


def neighbours(graph, k, cell, arrived):
    """Every change that the arm may make at a waypoint, and every step on: brute force."""
    n_pitches = graph.valid.shape[2]
    joints = graph.joints.astype(float).reshape(len(graph.valid), -1, 4)

    def move_time(a, b):
        d = np.abs(a - b).max()
        return 2 * np.sqrt(d / graph.rate) if d * graph.rate < 1 else d + 1 / graph.rate

    confined = graph.confined.get(k)
    if arrived:
        if confined is None or cell in confined:
            yield (k, cell, False), 0.0
        price = RECONFIGURATION_COST if k else APPROACH_COST
        price += 0.0 if graph.checkpoint[k] else 1 / graph.rate
        for other in np.flatnonzero(graph.valid[k].ravel()):
            if other != cell and (confined is None or other in confined):
                time = move_time(joints[k, cell], joints[k, other])
                yield (k, int(other), False), time + price
        return
    link = graph.links[k]
    if link == SMOOTH:
        branch, pitch = divmod(cell, n_pitches)
        for i in range(-REACH, REACH + 1):
            other = branch * n_pitches + (pitch + i) % n_pitches
            time = np.abs(joints[k, cell] - joints[k + 1, other]).max()
            if time <= TEAR:
                yield (k + 1, other, True), time
    elif link in (SAME, SWAPPED):
        other = (cell + (2 * n_pitches if link == SWAPPED else 0)) % (4 * n_pitches)
        if graph.valid[k + 1].ravel()[other]:
            yield (k + 1, other, True), 0.0
    else:
        price = 0.0 if link == DETOUR else RECONFIGURATION_COST
        for other in np.flatnonzero(graph.valid[k + 1].ravel()):
            time = move_time(joints[k, cell], joints[k + 1, other])
            yield (k + 1, int(other), True), time + price


def cheapest_by_dijkstra(graph):
    """The least cost through the graph, by a search that shares nothing with the real one."""
    best, queue = {}, [(0.0, (0, graph.start, True))]
    while queue:
        cost, node = heapq.heappop(queue)
        if node in best:
            continue
        best[node] = cost
        k, cell, arrived = node
        if k == len(graph.valid) - 1 and not arrived:
            return cost
        for other, extra in neighbours(graph, k, cell, arrived):
            if other not in best:
                heapq.heappush(queue, (cost + extra, other))
    return np.inf


def thinned(graph, every=8):
    """The graph with each so many-th pitch only, for the brute force."""
    n = graph.valid.shape[2]
    branch, pitch = divmod(graph.start, n)
    keep = (np.arange(0, n, every) + pitch) % n
    keep.sort()
    column = {int(p): i for i, p in enumerate(keep)}
    return graph._replace(
        joints=graph.joints.take(keep, axis=2),
        valid=graph.valid.take(keep, axis=2),
        start=branch * len(keep) + column[pitch],
    )


@pytest.mark.parametrize("seed", range(10))
def test_no_walk_has_fewer_reconfigurations_or_less_time_than_the_one_found(seed):
    limits = arm.LIMITS[("urdf", "hardware")[seed % 2]]
    rng = np.random.default_rng(seed)
    points = tool(rng.uniform(limits.lower, limits.upper, (3, 5)))
    start = rng.uniform(limits.lower, limits.upper)
    points[0] = tool(start)
    lines = [straight_line(a, b) for a, b in zip(points[:-1], points[1:])]
    graph = thinned(lay_out(lines, [start[None], None, None], limits, rate=3 / 1.57).graph)
    every = np.zeros(len(graph.valid), dtype=bool)
    every[::2] = True  # half of the waypoints will do, and all the checkpoints
    every |= graph.checkpoint
    graph = without(graph, ~every) if (graph.links != DETOUR).all() else graph
    walk, expected = best_walk(graph), cheapest_by_dijkstra(graph)
    if walk is None:
        assert expected == np.inf
    else:
        assert walk.cost // RECONFIGURATION_COST == expected // RECONFIGURATION_COST
        assert walk.cost == pytest.approx(expected, abs=1e-4)


def without(graph, dropped):
    index = np.flatnonzero(~dropped)
    return graph._replace(
        joints=graph.joints[index],
        valid=graph.valid[index],
        links=graph.links[index[1:] - 1],
        checkpoint=graph.checkpoint[index],
    )
