"""What the package never does with what it is given: run it, or write over what is there."""

import ast
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
SOURCES = sorted((ROOT / "src").rglob("*.py")) + sorted((ROOT / "scripts").iterdir())

RUN_CODE = {"eval", "exec", "compile"}
UNPICKLE = {"pickle", "cPickle", "dill", "joblib", "marshal", "shelve"}
SHELL = {"system", "popen", "getoutput", "getstatusoutput"}
WRITE = {"write_text", "write_bytes", "savefig", "savetxt", "save", "savez", "tofile"}
UNSAFE_YAML = {"load", "load_all", "full_load", "unsafe_load", "unsafe_load_all"}


def calls(tree):
    """Called names and the calls: ``open`` of ``open(...)``, ``load`` of ``yaml.load(...)``."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Call):
            f = node.func
            yield getattr(f, "id", None) or getattr(f, "attr", ""), node


def problems(code):
    """What is dangerous in a piece of code, a word each."""
    tree = ast.parse(code)
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            yield from UNPICKLE & {alias.name.partition(".")[0] for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            yield from UNPICKLE & {(node.module or "").partition(".")[0]}
    for name, call in calls(tree):
        owner = getattr(getattr(call.func, "value", None), "id", "")
        plain = isinstance(call.func, ast.Name)
        given = {keyword.arg: keyword.value for keyword in call.keywords}
        if (name in RUN_CODE and plain) or (name in SHELL and owner in ("os", "subprocess")):
            yield name
        if "shell" in given:
            yield "shell"
        if owner == "yaml" and name in UNSAFE_YAML:
            yield f"yaml.{name}"
        if owner == "np" and name == "load":
            yield "np.load"  # which may unpickle
        if name == "mktemp":
            yield name


def overwrites(code):
    """Files that are written directly: not by the name that ``new_file`` gives."""
    for name, call in calls(ast.parse(code)):
        owner = getattr(getattr(call.func, "value", None), "id", "")
        modes = [a.value for a in call.args if isinstance(a, ast.Constant)]
        modes += [k.value.value for k in call.keywords if isinstance(k.value, ast.Constant)]
        opened = name == "open" and any(mode in ("w", "wb", "a", "ab", "x") for mode in modes)
        if not (opened or name in WRITE) or owner == "unfinished":
            continue
        if not any(getattr(a, "id", "") == "unfinished" for a in call.args):
            yield name


@pytest.mark.parametrize("path", SOURCES, ids=lambda path: path.name)
def test_nothing_runs_what_it_is_given_nor_writes_a_file_in_place(path):
    code = path.read_text()
    assert list(problems(code)) == []
    assert list(overwrites(code)) == []


@pytest.mark.parametrize(
    "code",
    [
        "eval(text)",
        "exec(text)",
        "import pickle",
        "from pickle import loads",
        "os.system(text)",
        "subprocess.run(text, shell=True)",
        "yaml.load(text)",
        "np.load(path, allow_pickle=True)",
        "tempfile.mktemp()",
    ],
)
def test_the_search_finds_what_is_dangerous(code):
    assert len(list(problems(code))) == 1


@pytest.mark.parametrize(
    "code", ["open(path, 'w')", "path.open(mode='wb')", "path.write_text(t)", "f.savefig(path)"]
)
def test_the_search_finds_files_that_are_written_in_place(code):
    assert len(list(overwrites(code))) == 1
