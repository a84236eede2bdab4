"""One bag to plan, and the files that are made of its plan: what ``plan_bag`` does for each bag."""

from __future__ import annotations

import os
import sys
import tempfile
from pathlib import Path
from typing import Callable, NamedTuple

from . import arm, export, page, plot
from .exceptions import InputError
from .files import require_writable
from .parameters import Parameters
from .planner import Plan, plan
from .targets import load_targets

#: A file of this name is standard output.
STANDARD_OUTPUT = "-"


class Kind(NamedTuple):
    """A kind of file: what the summary calls it, which names it may have, how it is made."""

    label: str
    require: Callable  # (path): raises InputError for a name that cannot be
    write: Callable  # (path, plan, force)


def _plot(path, plan, force) -> None:
    plot.plot_plan(plan, path, force=force)


#: The options that name files.
KINDS = {
    "output": Kind("written", export.writer, export.write_plan),
    "plot": Kind("picture", plot.require_plottable, _plot),
    "report": Kind("page", page.require_page, page.write_page),
}


class File(NamedTuple):
    """A file to make of a plan."""

    kind: str  # one of KINDS
    name: str

    @property
    def is_standard_output(self) -> bool:
        """Whether it is ``-``, or that with a suffix for the format."""
        return self.kind == "output" and os.path.splitext(self.name)[0] == STANDARD_OUTPUT

    @property
    def path(self) -> Path:
        """Where it is, or for standard output a name of the same suffix."""
        return Path("plan" + (self.name[1:] or ".json") if self.is_standard_output else self.name)


class Job(NamedTuple):
    """A bag to plan, and what to make of its plan."""

    bag: str
    parameters: Parameters
    files: tuple[File, ...] = ()
    force: bool = False


def jobs(bags, parameters: Parameters, names: dict, force: bool = False) -> list[Job]:
    """A job for each bag; what cannot be written is said before any work is done.

    Args:
        bags: paths.
        parameters: how to plan.
        names: for some of ``KINDS``, names of files, with ``{bag}`` for the name of the bag and
            ``{folder}`` for its folder's.
        force: whether files may be replaced.

    Raises:
        InputError: a file cannot be written, or two would have the same name.
    """
    every = [
        Job(bag, parameters, tuple(_files(Path(bag).absolute(), names)), force) for bag in bags
    ]
    taken: dict[Path, Job] = {}
    for job in every:
        for file in job.files:
            _require(file, force)
            where = Path(STANDARD_OUTPUT) if file.is_standard_output else file.path.resolve()
            _take(where, file, job, taken)
    return every


def plan_job(job: Job) -> Plan:
    """Plans a bag and writes its files.

    Raises:
        InputError: the bag, the parameters or a file cannot be used.
        PlanningError: there is no plan.
    """
    p = job.parameters
    start = p.start if p.start is not None else (0.0,) * arm.DOF
    planned = plan(load_targets(job.bag, p.topic, p.limits), start, p)
    for file in job.files:
        write = KINDS[file.kind].write
        if file.is_standard_output:
            _write_standard_output(write, file, planned)
        else:
            write(file.path, planned, job.force)
    return planned


def _files(bag: Path, names: dict):
    for kind, templates in names.items():
        for template in templates:
            name = template.replace("{bag}", bag.stem).replace("{folder}", bag.parent.name)
            yield File(kind, name)


def _require(file: File, force: bool) -> None:
    KINDS[file.kind].require(file.path)
    if not file.is_standard_output:
        require_writable(file.path, force)


def _take(where: Path, file: File, job: Job, taken: dict) -> None:
    """Notes that a job writes there; refuses a place that is taken."""
    if where in taken:
        other = taken[where]
        both = "twice" if other is job else f"for {other.bag} and for {job.bag}"
        raise InputError(
            f"{file.name} would be written {both}; {{bag}} and {{folder}} in a name become the"
            " bag's name and its folder's"
        )
    taken[where] = job


def _write_standard_output(write, file: File, planned: Plan) -> None:
    """Formats need a file that they can seek in: a passing one is copied."""
    with tempfile.TemporaryDirectory() as folder:
        passing = Path(folder) / file.path
        write(passing, planned, False)
        content = passing.read_bytes()
    try:
        sys.stdout.buffer.write(content)
        sys.stdout.buffer.flush()
    except BrokenPipeError:  # the reader has seen enough; nor must Python flush what it left
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
