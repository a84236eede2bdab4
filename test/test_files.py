"""Files appear whole or not at all, and never in the place of another unless asked to."""

import pytest

from youbot_kinematics.exceptions import InputError
from youbot_kinematics.files import new_file


def test_a_file_takes_its_name_once_it_is_whole(tmp_path):
    path = tmp_path / "plan.json"
    with new_file(path) as unfinished:
        unfinished.write_text("whole")
        assert not path.exists()
    assert path.read_text() == "whole" and list(tmp_path.iterdir()) == [path]


@pytest.mark.parametrize("error", [RuntimeError, KeyboardInterrupt, MemoryError])
def test_what_is_interrupted_leaves_the_old_file_and_nothing_else(tmp_path, error):
    path = tmp_path / "plan.json"
    path.write_text("old")
    with pytest.raises(error), new_file(path, force=True) as unfinished:
        unfinished.write_text("ha")
        raise error
    assert path.read_text() == "old" and list(tmp_path.iterdir()) == [path]


def test_a_full_disk_is_a_sentence(tmp_path):
    with pytest.raises(InputError, match="No space left"), new_file(tmp_path / "plan.json"):
        raise OSError(28, "No space left on device")
    assert not list(tmp_path.iterdir())


def test_no_file_is_replaced_unless_forced(tmp_path):
    path = tmp_path / "plan.json"
    path.write_text("mine")
    with pytest.raises(InputError, match="--force"), new_file(path):
        pytest.fail("it was begun")
    assert path.read_text() == "mine"
