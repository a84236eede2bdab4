"""The visiting order beside its peers: time, and length against the best that any of them found.

The best peer is the fastest of those whose paths are as short as the project's.
An open path from the start through all targets, as random points in the arm's reach. Each peer gets
its own closed or integer form of the problem; the lengths are all computed here.
"""

from __future__ import annotations

import argparse
from importlib import import_module
from statistics import median

import coursework
import numpy as np
from bench import OURS, Work, compared, in_turn, report, shown, table

from youbot_kinematics.tour import path_length, shortest_path

SIZES = (4, 10, 15, 20, 200)
EXACT = 15  # targets up to which the shortest path must be found
MANY = 100
SAME = 1e-9  # of the lengths
_LARGEST = 1_000_000  # of the integers for those who take them


def ours(points):
    return shortest_path(points[0], points[1:])[0]


def permutations(points):
    return np.array(coursework.shortest_order(points[0], points[1:]))


def held_karp(points):
    """PyPI's held-karp, on floats."""
    tour, _ = import_module("held_karp").solve(closed(points).tolist())
    return opened(tour, len(points))


def fast_tsp(points):
    """fast-tsp on 16-bit integers, looking for its default of two seconds at most."""
    matrix = integers(closed(points), 65535)
    return opened(import_module("fast_tsp").find_tour(matrix), len(points))


def elkai(points):
    """elkai, which is LKH: free for research only, and so a peer here and nothing else."""
    matrix = integers(closed(points), _LARGEST)
    return opened(import_module("elkai").DistanceMatrix(matrix).solve_tsp()[:-1], len(points))


def or_tools(points):
    """OR-Tools' routing: its first solution by the cheapest arc, and its local search."""
    routing = import_module("ortools.constraint_solver.pywrapcp")
    matrix = integers(closed(points), _LARGEST)
    manager = routing.RoutingIndexManager(len(matrix), 1, 0)
    model = routing.RoutingModel(manager)
    node = manager.IndexToNode
    cost = model.RegisterTransitCallback(lambda i, j: matrix[node(i)][node(j)])
    model.SetArcCostEvaluatorOfAllVehicles(cost)
    parameters = routing.DefaultRoutingSearchParameters()
    parameters.first_solution_strategy = 3  # PATH_CHEAPEST_ARC
    solution = model.SolveWithParameters(parameters)
    tour, index = [], model.Start(0)
    while not model.IsEnd(index):
        tour.append(node(index))
        index = solution.Value(model.NextVar(index))
    return opened(tour, len(points))


def python_tsp(points):
    """python-tsp: dynamic programming to 10, its simulated annealing's local search beyond."""
    matrix = closed(points)
    if len(points) <= 11:
        tour, _ = import_module("python_tsp.exact").solve_tsp_dynamic_programming(matrix)
    else:
        tour, _ = import_module("python_tsp.heuristics").solve_tsp_local_search(matrix)
    return opened(tour, len(points))


#: Name -> how to solve it, and up to how many targets that is worth waiting for.
SOLVERS = {
    OURS: (ours, 1000),
    "permutations": (permutations, 7),
    "held-karp": (held_karp, 15),
    "fast-tsp": (fast_tsp, 1000),
    "elkai": (elkai, 1000),
    "OR-Tools": (or_tools, 1000),
    "python-tsp": (python_tsp, 200),
}


def closed(points):
    """Distances with one more node, next to the start at no cost, which closes the open path."""
    distances = np.linalg.norm(points[:, None] - points, axis=-1)
    n = len(distances)
    distances = np.pad(distances, (0, 1), constant_values=distances.max())
    distances[n, [0, n]] = distances[0, n] = 0.0
    return distances


def integers(distances, largest):
    return np.round(distances * (largest / distances.max())).astype(int).tolist()


def opened(tour, n):
    """The order of the targets in a closed tour through ``n`` points and the closing node n."""
    tour = [int(node) for node in tour]
    tour = tour[tour.index(0) :] + tour[: tour.index(0)]
    if tour[1] == n:
        tour = tour[:1] + tour[:0:-1]
    return np.array([node - 1 for node in tour[1:] if node != n])


def solvers_for(n):
    """Name -> those that are worth waiting for with n targets, and are installed."""
    found, trial = {}, np.eye(5, 3)
    for name, (solve, most) in SOLVERS.items():
        try:
            solve(trial)
        except ImportError as error:
            print(f"{name}: left out, not installed ({error})")
            continue
        if n <= most:
            found[name] = solve
    return found


def lengths_of(solvers, tours):
    """Name -> length of each tour's path as a solver orders it, (k,) m."""
    lengths = {}
    for name, solve in solvers.items():
        orders = [np.asarray(solve(points), dtype=int) for points in tours]
        for order, points in zip(orders, tours):
            assert sorted(order) == list(range(len(points) - 1)), name
        paths = [points[np.append(0, order + 1)] for order, points in zip(orders, tours)]
        lengths[name] = np.array([path_length(path) for path in paths])
    return lengths


def measure(n, rng, count):
    """The line of tours with n targets."""
    tours = [rng.uniform(-0.5, 0.5, (n + 1, 3)) for _ in range(count if n < MANY else 2)]
    solvers = solvers_for(n)
    lengths = lengths_of(solvers, tours)
    best = np.min(list(lengths.values()), axis=0)
    above = {name: float((length / best - 1).max()) for name, length in lengths.items()}
    as_short = [name for name in above if name != OURS and above[name] <= above[OURS] + SAME]
    works = {
        name: Work(
            lambda all_of, solve=solve: [solve(one) for one in all_of], [tours] * 50, len(tours)
        )
        for name, solve in solvers.items()
    }
    times = in_turn(works, rounds=5) if n < MANY else in_turn(works, rounds=3, round_time=0)
    exact = n <= EXACT
    goal = "exact, and 2 times the time" if exact else "2 times the time"
    found = above[OURS] <= SAME or not exact
    line = compared(f"tour, {n} checkpoints", times, 2.0, goal, found, rivals=as_short)
    line.more = {"above_shortest": above}
    rows = [
        (name, shown(median(values)), f"{line.ours / median(values):.2f}", f"{above[name]:.3%}")
        for name, values in times.items()
    ]
    table((f"{n} targets", "each", "ours by it", "above shortest"), rows)
    print()
    return line


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--tours", type=int, default=5, help="of each size")
    parser.add_argument("--sizes", type=int, nargs="+", default=SIZES)
    options = parser.parse_args()
    rng = np.random.default_rng(options.seed)
    lines = [measure(n, rng, options.tours) for n in options.sizes]
    report("orders", lines, **vars(options))


if __name__ == "__main__":
    main()
