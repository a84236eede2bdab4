"""From joint paths to a trajectory: how fast along each path, and samples for the controller.

Each path runs from rest to rest. ``cubic``: as ``s(t) = 3 (t/T)^2 - 2 (t/T)^3`` (Lynch and Park,
"Modern Robotics" (2017), section 9.2.2), T the shortest time that keeps the velocity and
acceleration limits on the whole of it. ``optimal``: as fast as the limits let it at each point.

Both rates ds/dt have corners, where the acceleration jumps, and a jump between two samples makes
the controller's quintic overshoot. So the rate is only taken at the samples, and the acceleration
of s runs linearly from one to the next: the quintic follows such a motion to the letter. What
little is left beyond the limits is measured on the controller's own interpolation, and the time
stretched.
"""

from __future__ import annotations

import numpy as np

from .optimal import optimal_rate
from .progress import with_progress
from .trajectory import JointPath, Segment, Trajectory, interpolate

#: How finely the controller's interpolation is looked at, s.
DENSE = 0.001
# Points of a path at which its cubic scaling is held against the limits, at least.
_GRID = 400


def time_paths(paths, velocity, acceleration, dt: float, timing: str = "optimal") -> Trajectory:
    """Times joint paths one after the other, at rest between them.

    Args:
        paths: ``JointPath`` each, the end of one being the beginning of the next.
        velocity, acceleration: limits of each joint, (5,), rad/s and rad/s^2.
        dt: time between two points of the trajectory, s.
        timing: ``optimal`` or ``cubic``.

    Returns:
        The trajectory, with a segment for each path; every path takes a whole number of dt, so
        that its end is a point at rest.

    Raises:
        PlanningError: toppra finds no parametrization.
    """
    first = paths[0].joints[0]
    points, segments, steps = [np.vstack([first, np.zeros((2, 5))])[:, None]], [], 0
    for path in with_progress(paths, "timing the lines", len(paths)):
        samples = time_path(path, velocity, acceleration, dt, RATES[timing])
        points.append(samples[:, 1:])
        end = steps + samples.shape[1] - 1
        begin_time, end_time = round(steps * dt, 9), round(end * dt, 9)
        segments.append(
            Segment(
                path.kind,
                begin_time,
                end_time,
                path.from_checkpoint,
                path.to_checkpoint,
                path.reason,
            )
        )
        steps = end
    positions, velocities, accelerations = np.concatenate(points, axis=1)
    times = np.arange(steps + 1) * dt
    return Trajectory(times, positions, velocities, accelerations, tuple(segments))


def cubic_rate(path: JointPath, velocity, acceleration):
    """The rate of the shortest cubic time scaling of a path.

    Args:
        velocity, acceleration: limits (5,), rad/s and rad/s^2.

    Returns:
        ``(times, rates)``, each (n,): s, and ds/dt in 1/s.
    """
    t = np.linspace(0.0, 1.0, max(_GRID, 4 * len(path.s)) + 1)
    s, ds, dds = t**2 * (3 - 2 * t), 6 * t * (1 - t), 6 - 12 * t
    spline = path.spline()
    slope, curvature = spline(s, 1), spline(s, 2)
    joint_velocity = np.abs(slope * ds[:, None]) / velocity
    joint_acceleration = np.abs(curvature * ds[:, None] ** 2 + slope * dds[:, None]) / acceleration
    duration = max(joint_velocity.max(), np.sqrt(joint_acceleration.max()))
    return t * duration, ds / duration


#: How fast along a path, by the names that the parameter ``timing`` gives them.
RATES = {"optimal": optimal_rate, "cubic": cubic_rate}


def time_path(path: JointPath, velocity, acceleration, dt: float, rate=optimal_rate) -> np.ndarray:
    """Samples (3, n, 5) of the motion along a path, from rest to rest, every dt.

    Args:
        path: what to time.
        velocity, acceleration: limits (5,), rad/s and rad/s^2, which the controller's motion keeps.
        dt: s.
        rate: how fast; one of ``RATES``.
    """
    if np.ptp(path.joints, axis=0).max() == 0:
        return np.stack([path.joints[:1], np.zeros((1, 5)), np.zeros((1, 5))])
    spline = path.spline()
    times, rates = rate(path, velocity, acceleration)
    steps = int(np.ceil(times[-1] / dt - 1e-9)) + 1
    while True:  # each turn is longer, and a motion that is slow enough keeps all limits
        stretch = (steps - 1) * dt / times[-1]
        at = np.arange(steps + 1) * dt
        samples = sample_path(
            spline, np.interp(at, times * stretch, rates / stretch, right=0.0), dt
        )
        load = peak_load(samples, velocity, acceleration, dt)
        if load <= 1.0:
            samples[0, [0, -1]] = path.joints[[0, -1]]  # to the last bit
            samples[1:, [0, -1]] = 0.0
            return samples
        steps = max(steps + 1, int(np.ceil((steps - 1) * load)) + 1)


def sample_path(spline, rates, dt: float) -> np.ndarray:
    """Samples (3, n + 1, 5) of positions, velocities and accelerations along a path, every dt.

    Args:
        spline: joints (rad) as a function of s in 0..1.
        rates: ds/dt wanted at each dt, (n + 1,), from and to rest; the samples have the mean of two
            neighbours, so that ds/dt changes in straight lines between them.
    """
    before = np.append(0.0, rates[:-1])
    ds, dds = (rates + before) / 2, (rates - before) / dt
    steps = dt * ds[:-1] + dt**2 * (2 * dds[:-1] + dds[1:]) / 6
    s = np.append(0.0, np.cumsum(steps))
    ds, dds, s = (x / s[-1] for x in (ds, dds, s))
    ds, dds = ds[:, None], dds[:, None]
    slope = spline(s, 1)
    return np.stack([spline(s), slope * ds, spline(s, 2) * ds**2 + slope * dds])


def peak_load(samples, velocity, acceleration, dt: float) -> float:
    """By what factor the time must be stretched for the controller's motion to keep the limits."""
    times = np.arange(samples.shape[1]) * dt
    dense = np.arange(0.0, times[-1] + DENSE / 2, DENSE)
    _, v, a = interpolate(Trajectory(times, *samples), dense)
    return float(max((np.abs(v) / velocity).max(), np.sqrt((np.abs(a) / acceleration).max())))
