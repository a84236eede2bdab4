"""README and the documents hold: every block of code in them is run, in the order of its page.

A page's shell blocks run in a folder that looks like a clone, one after the other, and its Python
blocks share one namespace there. A ``text`` block right behind a shell block is what that printed,
line by line, with ``…`` for what may differ; a line of ``…`` alone stands for any number of lines.
XML must be well-formed, and a launch file must be one that roslaunch can load. A block that cannot
be run has the reason in a comment before it: ``<!-- not run: reason -->``.

README is held to this once it has the tables of parameters and channels between their comments.
"""

from __future__ import annotations

import os
import re
import shutil
import signal
import subprocess
import sys
from pathlib import Path
from typing import NamedTuple
from xml.etree import ElementTree

import pytest

from youbot_kinematics import interface

ROOT = Path(__file__).resolve().parents[1]
README = ROOT / "README.md"
README_IS_MARKED = "<!-- parameters -->" in README.read_text(encoding="utf-8")
PAGES = [README] * README_IS_MARKED + sorted((ROOT / "docs").rglob("*.md"))
TIME_LIMIT = 120  # s, for a block
SHELL, PYTHON, OUTPUT, XML = ("sh", "bash"), ("python",), ("text",), ("xml",)
BLOCK = re.compile(
    r"(?:<!-- (?P<mark>.*?) -->\n)?^(?P<indent> *)```(?P<language>[^\n]*)\n(?P<code>.*?)^ *```$",
    re.DOTALL | re.MULTILINE,
)
NEEDS_ROS = re.compile(r"\./run|rosrun|roslaunch")


class Block(NamedTuple):
    language: str
    code: str
    line: int  # in its page, of the fence
    not_run: str  # the reason, or nothing
    follows: bool  # nothing but white space is between it and the block before


def blocks_of(page: Path) -> list[Block]:
    text, blocks, end = page.read_text(encoding="utf-8"), [], 0
    for match in BLOCK.finditer(text):
        mark = match["mark"] or ""
        reason = mark[len("not run: ") :] if mark.startswith("not run: ") else ""
        line = text.count("\n", 0, match.start("language")) + 1
        follows = bool(blocks) and not text[end : match.start()].strip()
        blocks.append(Block(match["language"].strip(), match["code"], line, reason, follows))
        end = match.end()
    return blocks


@pytest.fixture
def clone(tmp_path, monkeypatch):
    """A folder with all that is in the root: what a page writes is written here."""
    for entry in ROOT.iterdir():
        if entry.name != "build":
            (tmp_path / entry.name).symlink_to(entry)
    monkeypatch.chdir(tmp_path)
    return tmp_path


def run_shell(block: Block) -> str:
    if NEEDS_ROS.search(block.code) and shutil.which("rosrun") is None:
        pytest.skip("needs a ROS environment")
    with subprocess.Popen(
        ["bash", "-euo", "pipefail", "-c", block.code],
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    ) as process:
        try:
            printed, said = process.communicate(timeout=TIME_LIMIT)
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGINT)  # what it started ends with it
            pytest.fail(f"line {block.line}: still running after {TIME_LIMIT} s")
    assert process.returncode == 0, f"line {block.line}: {printed}{said}"
    return printed


def run_python(block: Block, namespace: dict) -> None:
    before = "\n" * block.line  # so that a traceback has the page's lines
    exec(compile(before + block.code, "<page>", "exec"), namespace)


def load_xml(block: Block, folder: Path) -> None:
    root = ElementTree.fromstring(block.code)
    if root.tag != "launch":
        return
    roslaunch = pytest.importorskip("roslaunch")
    (folder / "page.launch").write_text(block.code)
    loaded = roslaunch.config.load_config_default([(str(folder / "page.launch"), [])], None)
    assert loaded.config_errors == []


def matches(expected: str, printed: str) -> bool:
    """Whether a text with … in it is what was printed."""
    pattern = ""
    for line in expected.splitlines():
        if line.strip() == "…":
            pattern += r"(?:.*\n)*?"
        else:
            pattern += ".*".join(map(re.escape, line.rstrip().split("…"))) + r" *\n"
    return re.match(pattern, printed) is not None


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_every_block_of_a_page_runs(page, clone, monkeypatch):
    monkeypatch.setenv("MPLBACKEND", "agg")
    monkeypatch.setattr(sys, "path", [*sys.path])
    namespace: dict = {"__name__": "page"}
    printed = None
    for block in blocks_of(page):
        if block.language in OUTPUT and block.follows and printed is not None:
            assert matches(block.code, printed), f"line {block.line}: what was printed:\n{printed}"
        printed = None
        if block.not_run:
            continue
        if block.language in SHELL:
            printed = run_shell(block)
        elif block.language in PYTHON:
            run_python(block, namespace)
        elif block.language in XML:
            load_xml(block, clone)


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_every_block_has_a_language_that_is_run_or_is_none(page):
    known = (*SHELL, *PYTHON, *OUTPUT, *XML)
    for block in blocks_of(page):
        directive = block.language.startswith("{")
        assert directive or block.language in known or block.not_run, f"line {block.line}"


def test_an_output_is_compared_line_by_line():
    printed = "one 1\ntwo\nthree\nfour\n"
    assert matches("one 1\ntwo\n", printed)
    assert matches("one …\n…\nfour\n", printed)
    assert not matches("one 2\n", printed)
    assert not matches("two\n", printed)
    assert not matches("one 1\n…\nfive\n", printed)


@pytest.mark.parametrize("name", ["parameters", "channels"])
def test_the_tables_in_readme_are_those_of_the_definitions(name):
    readme = README.read_text(encoding="utf-8")
    begin, end = f"<!-- {name} -->", f"<!-- end of {name} -->"
    if begin not in readme:
        pytest.skip(f"README has no {begin}")
    table = {"parameters": interface.parameter_table, "channels": interface.channel_table}[name]()
    written = readme.partition(begin)[2].partition(end)[0].strip()
    assert written == table, "python3 -m youbot_kinematics.interface prints what should be there"


def test_the_nodes_take_the_names_of_their_channels_from_the_definition():
    nodes = ROOT / "src/youbot_kinematics/nodes"
    for path in nodes.glob("*.py"):
        literal = re.search(r"rospy\.(Publisher|Subscriber|Service)\(\s*[\"']", path.read_text())
        assert not literal, f"{path.name}: {literal}"


def test_the_figures_are_drawn_by_their_script(tmp_path):
    script = ROOT / "docs/figures/draw.py"
    subprocess.run([sys.executable, str(script), str(tmp_path)], check=True, timeout=300)
    drawn = {path.name for path in tmp_path.iterdir()}
    assert drawn == {path.name for path in script.parent.glob("*.svg")}


def test_every_picture_that_a_page_shows_is_there():
    for page in PAGES:
        for target in re.findall(r"!\[[^\]]*\]\(([^)]+)\)", page.read_text(encoding="utf-8")):
            assert (page.parent / target).is_file() or os.path.isabs(target), f"{page}: {target}"
