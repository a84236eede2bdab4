"""Several bags at once, each planned in a process of its own, and what became of them."""

from __future__ import annotations

import multiprocessing
import os
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor, as_completed
from concurrent.futures.process import BrokenProcessPool
from typing import NamedTuple

from .bag_reader import printable
from .exceptions import InputError, PlanningError, YoubotError
from .plan_job import Job, plan_job
from .progress import with_progress

PLANNED, NO_PLAN, BAD_INPUT = 0, 1, 2
RESULTS = {PLANNED: "planned", NO_PLAN: "no plan", BAD_INPUT: "bad input"}


class Outcome(NamedTuple):
    """What became of a bag."""

    bag: str
    status: int  # one of RESULTS
    note: str  # the solver that found the plan, or why there is none
    targets: str = ""
    length: str = ""  # of the tour, m
    duration: str = ""  # of the trajectory, s
    stops: str = ""  # reconfigurations and detours


def plan_bags(jobs: list[Job], workers: int = 0) -> list[Outcome]:
    """Plans bags in parallel; what is wrong with one does not stop the others.

    Args:
        jobs: a bag each.
        workers: how many at a time; as many as there are processors for 0.

    Returns:
        What became of each, in the order of the jobs.
    """
    threads = ThreadPoolExecutor(workers or len(os.sched_getaffinity(0)))
    futures = [threads.submit(_outcome, job) for job in jobs]
    try:
        for _ in with_progress(as_completed(futures), "planning the bags", len(jobs)):
            pass
    finally:
        for future in futures:  # after an interruption no other bag is begun
            future.cancel()
        threads.shutdown()
    return [future.result() for future in futures]


def status_of(error: YoubotError) -> int:
    """The exit status of an error: 2 for bad input, 1 for any other."""
    return BAD_INPUT if isinstance(error, InputError) else NO_PLAN


def table(outcomes: list[Outcome]) -> list[str]:
    """What became of the bags: a line each, under a line of titles, and one that counts them."""
    titles = ("bag", "result", "targets", "tour m", "time s", "stops", "solver, or why not")
    rows = [titles] + [
        (o.bag, RESULTS[o.status], o.targets, o.length, o.duration, o.stops, o.note)
        for o in outcomes
    ]
    widths = [max(map(len, column)) for column in list(zip(*rows))[:-1]]
    lines = []
    for bag, result, *figures, note in rows:
        cells = [f"{bag:{widths[0]}}", f"{result:{widths[1]}}"]
        cells += [f"{figure:>{width}}" for figure, width in zip(figures, widths[2:])]
        lines.append("  ".join([*cells, note]))
    return [*lines, _count(outcomes)]


def alone(function, *arguments):
    """What a function returns or raises in a process of its own.

    The processes come from a server that has no threads, which a fork would break.

    Raises:
        PlanningError: the process died.
    """
    server = multiprocessing.get_context("forkserver")
    server.set_forkserver_preload([__name__])
    try:
        with ProcessPoolExecutor(1, mp_context=server) as process:
            return process.submit(function, *arguments).result()
    except BrokenProcessPool:
        raise PlanningError("its process died, perhaps for want of memory") from None


def _outcome(job: Job) -> Outcome:
    """Plans a bag in a process of its own."""
    try:
        return alone(_planned, job)
    except YoubotError as error:
        note = str(error)
        note = note[len(job.bag) + 2 :] if note.startswith(job.bag + ": ") else note
        return Outcome(job.bag, status_of(error), printable(note))
    except Exception as error:  # a mistake of ours must not cost the other bags their plans
        return Outcome(job.bag, NO_PLAN, printable(f"{type(error).__name__}: {error}"))


def _planned(job: Job) -> Outcome:
    planned = plan_job(job)
    report = planned.report
    return Outcome(
        job.bag,
        PLANNED,
        planned.solver,
        str(len(planned.targets)),
        f"{planned.length:.3f}",
        f"{report.duration:.2f}",
        f"{report.reconfigurations + report.detours:.0f}",
    )


def _count(outcomes: list[Outcome]) -> str:
    statuses = [outcome.status for outcome in outcomes]
    parts = [f"{statuses.count(s)} {name}" for s, name in RESULTS.items() if s in statuses]
    return f"{len(outcomes)} bags: {', '.join(parts)}"
