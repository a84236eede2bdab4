"""Where the arm can stand at the waypoints of a tour, and the steps of the search between them."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from youbot_kinematics import YoubotKinematics, arm, formulas
from youbot_kinematics.resolve.lines import straight_line
from youbot_kinematics.resolve.route import arm_joints, pitch_grid, route_along, standings

LIMITS = arm.LIMITS["urdf"]
KINEMATICS = YoubotKinematics("urdf")
N_CELLS = 32


def route(n=25):
    line = straight_line(np.array([0.3, -0.2, 0.3]), np.array([-0.25, 0.3, 0.1]))
    route = route_along([line], [np.linspace(0, 1, n)])
    return route._replace(margin=np.zeros(n)), line.point(route.u)


def test_the_arm_can_stand_where_the_inverse_kinematics_has_a_solution():
    way, points = route()
    cells, pitch = standings(way, LIMITS, N_CELLS)
    joints = cells * LIMITS.velocity[:4]
    for track in (0, 1):
        own = slice(2 * track, 2 * track + 2)
        T = np.tile(np.eye(4), (len(points), N_CELLS, 1, 1))
        turned = Rotation.from_euler("z", way.azimuth + np.pi * track).as_matrix()
        pitched = Rotation.from_euler("y", pitch_grid(N_CELLS)).as_matrix()
        T[..., :3, :3] = turned[:, None] @ pitched
        T[..., :3, 3] = points[:, None]
        found = KINEMATICS.inverse_branches(T)
        valid = np.swapaxes(found.valid[..., own], 1, 2)
        expected = np.swapaxes(found.joints[..., own, :4], 1, 2)
        assert 0.05 < valid.mean() < 0.95
        np.testing.assert_array_equal(np.isfinite(cells[:, own, :, 0]), valid)
        np.testing.assert_allclose(joints[:, own][valid], expected[valid], atol=1e-5)
    np.testing.assert_allclose(pitch, np.broadcast_to(pitch_grid(N_CELLS), pitch.shape), rtol=1e-6)


def test_of_several_pitches_in_a_cell_the_valid_one_next_to_its_middle_is_taken():
    way, _ = route()
    cells, pitch = standings(way, LIMITS, N_CELLS, 5)
    every = np.isfinite(standings(way, LIMITS, N_CELLS * 5)[0][..., 0])
    every = every.reshape(len(way.u), 4, N_CELLS, 5)
    np.testing.assert_array_equal(np.isfinite(cells[..., 0]), every.any(axis=-1))
    off_middle = np.where(every, np.abs(np.arange(5) - 2), 9).min(axis=-1)
    steps = np.abs(pitch - pitch_grid(N_CELLS)) / (2 * np.pi / (N_CELLS * 5))
    valid = every.any(axis=-1)
    np.testing.assert_allclose(steps[valid], off_middle[valid], atol=1e-4)
    assert set(off_middle[valid]) == {0, 1, 2}


def test_a_margin_counts_as_passing_the_limits_by_it():
    way, _ = route()
    branch, pitch = np.zeros(len(way.u), dtype=np.intp), np.full(len(way.u), 2.0)
    joints, excess = arm_joints(way, branch, pitch, LIMITS)
    _, more = arm_joints(way._replace(margin=way.margin + 10.0), branch, pitch, LIMITS)
    beyond = np.maximum(LIMITS.lower[:4] - joints, joints - LIMITS.upper[:4])
    reached = np.isfinite(excess)
    np.testing.assert_allclose(more[reached], beyond[reached] + 10.0)
    np.testing.assert_allclose(excess[reached], np.maximum(beyond, 0)[reached], atol=1e-9)


@pytest.mark.parametrize("wrong", range(3))
def test_what_are_no_cells_is_refused(wrong):
    arrays = [np.zeros((16, 4), np.float32), np.zeros((16, 4), np.float32), np.zeros(16)]
    formulas.smooth_step(*arrays, 3, 0.3)
    for other in (arrays[wrong][1:], arrays[wrong].astype(int), arrays[wrong][::-1]):
        with pytest.raises(TypeError):
            formulas.smooth_step(*arrays[:wrong], other, *arrays[wrong + 1 :], 3, 0.3)
