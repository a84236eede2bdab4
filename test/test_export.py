"""Files of plans: what is in them, and that they appear whole or not at all."""

import csv
import json

import numpy as np
import pytest
from rosbags.highlevel import AnyReader

from youbot_kinematics import arm
from youbot_kinematics.exceptions import InputError
from youbot_kinematics.export import COMMAND_TOPIC, csv_header, write_plan
from youbot_kinematics.planner import plan
from youbot_kinematics.targets import Targets

START = [0.5, 0.5, -2.0, 1.2, 0.6]
TARGETS = [[1.4, 0.4, -1.9, 1.0, 1.5], [0.9, 0.25, -1.8, 0.9, 1.0]]


@pytest.fixture(scope="module")
def planned():
    return plan(Targets.from_joints(TARGETS, source="a test"), START)


def test_json_holds_the_whole_plan(planned, tmp_path):
    write_plan(tmp_path / "plan.json", planned)
    read = json.loads((tmp_path / "plan.json").read_text(), parse_constant=pytest.fail)
    assert read["joint_names"] == list(arm.JOINT_NAMES)
    assert read["order"] == [1, 0]
    assert read["length"] == pytest.approx(planned.length)
    assert read["report"]["passed"] is True and read["frame"] == "base_link"
    assert read["report"]["solver"] == planned.solver and read["report"]["solver_reason"]
    assert read["parameters"]["num_points"] == 10 and read["targets"]["source"] == "a test"
    assert [(s["kind"], s["from"], s["to"]) for s in read["segments"]] == [
        ("line", 0, 1),
        ("line", 1, 2),
    ]
    times = [point["time_from_start"] for point in read["points"]]
    np.testing.assert_allclose(times, planned.trajectory.times, atol=1e-9)
    for key in ("positions", "velocities", "accelerations"):
        values = [point[key] for point in read["points"]]
        np.testing.assert_array_equal(values, getattr(planned.trajectory, key))


def test_json_has_null_where_a_number_is_not_finite(planned, tmp_path):
    odd = planned.trajectory._replace(
        velocities=np.full((len(planned.trajectory.times), 5), np.nan)
    )
    write_plan(tmp_path / "plan.json", _with_trajectory(planned, odd))
    read = json.loads((tmp_path / "plan.json").read_text(), parse_constant=pytest.fail)
    assert read["points"][0]["velocities"] == [None] * 5


def test_csv_has_one_column_for_each_quantity_of_each_joint(planned, tmp_path):
    write_plan(tmp_path / "plan.csv", planned)
    with open(tmp_path / "plan.csv", newline="") as file:
        names, *rows = csv.reader(file)
    assert names == csv_header() and len(names) == 16
    assert all(name.isidentifier() for name in names)
    t = planned.trajectory
    expected = np.column_stack([t.times, t.positions, t.velocities, t.accelerations])
    np.testing.assert_allclose(np.array(rows, dtype=float), expected, atol=1e-9)


def test_a_bag_holds_the_command_that_the_controller_takes(planned, tmp_path):
    write_plan(tmp_path / "plan.bag", planned)
    with AnyReader([tmp_path / "plan.bag"]) as reader:
        (message,) = [(c, reader.deserialize(raw, c.msgtype)) for c, _, raw in reader.messages()]
    connection, command = message
    assert connection.topic == COMMAND_TOPIC
    assert connection.msgtype == "trajectory_msgs/msg/JointTrajectory"
    assert command.joint_names == list(arm.JOINT_NAMES)
    assert (command.header.stamp.sec, command.header.stamp.nanosec) == (0, 0)
    times = [p.time_from_start.sec * 10**9 + p.time_from_start.nanosec for p in command.points]
    assert times == [20_000_000 * i for i in range(len(planned.trajectory.times))]
    assert all(0 <= p.time_from_start.nanosec < 10**9 for p in command.points)
    for key in ("positions", "velocities", "accelerations"):
        values = [getattr(point, key) for point in command.points]
        np.testing.assert_array_equal(values, getattr(planned.trajectory, key))


def test_the_real_rosbag_reads_the_command(planned, tmp_path):
    rosbag = pytest.importorskip("rosbag")
    write_plan(tmp_path / "plan.bag", planned)
    with rosbag.Bag(str(tmp_path / "plan.bag")) as file:
        (read,) = file.read_messages()
    assert read.topic == COMMAND_TOPIC
    assert read.message._type == "trajectory_msgs/JointTrajectory"
    assert len(read.message.points) == len(planned.trajectory.times)


@pytest.mark.parametrize("suffix", ["json", "csv", "bag"])
def test_the_same_plan_makes_the_same_file_and_replaces_none(planned, tmp_path, suffix):
    a, b = tmp_path / f"a.{suffix}", tmp_path / f"b.{suffix}"
    write_plan(a, planned)
    b.write_text("mine")
    with pytest.raises(InputError, match="--force"):
        write_plan(b, planned)
    assert b.read_text() == "mine"
    write_plan(b, planned, force=True)
    assert a.read_bytes() == b.read_bytes()
    assert sorted(tmp_path.iterdir()) == [a, b]


@pytest.mark.parametrize("name", ["plan.txt", "plan", "missing/plan.json"])
def test_files_that_cannot_be_written_are_refused(planned, tmp_path, name):
    with pytest.raises(InputError):
        write_plan(tmp_path / name, planned)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("suffix", ["json", "csv", "bag"])
def test_a_plan_that_fails_to_be_written_leaves_nothing_behind(planned, tmp_path, suffix):
    broken = _with_trajectory(planned, planned.trajectory._replace(times=np.array(["x"])))
    with pytest.raises((TypeError, ValueError)):
        write_plan(tmp_path / f"plan.{suffix}", broken)
    assert list(tmp_path.iterdir()) == []


def _with_trajectory(planned, trajectory):
    return type(planned)(**{**vars(planned), "trajectory": trajectory})


def test_pandas_reads_csv_and_json(planned, tmp_path):
    pandas = pytest.importorskip("pandas")
    write_plan(tmp_path / "plan.csv", planned)
    write_plan(tmp_path / "plan.json", planned)
    table = pandas.read_csv(tmp_path / "plan.csv")
    assert list(table.columns) == csv_header() and all(kind == "float64" for kind in table.dtypes)
    np.testing.assert_allclose(table["time_s"], planned.trajectory.times, atol=1e-9)
    points = pandas.DataFrame(json.loads((tmp_path / "plan.json").read_text())["points"])
    np.testing.assert_array_equal(np.stack(points["positions"]), planned.trajectory.positions)


def test_names_in_csv_and_json_are_ones_that_matlab_takes(planned, tmp_path):
    """MATLAB's names: a letter, then letters, digits and underscores, 63 at most."""
    write_plan(tmp_path / "plan.json", planned)
    names = csv_header()
    json.loads((tmp_path / "plan.json").read_text(), object_hook=names.extend)
    for name in names:
        assert name.isascii() and name.isidentifier() and name[0] != "_" and len(name) <= 63
