"""Axes from free motion with twist: the likelihood of angles as processes."""

import numpy as np
import pytest
from benchmarks.axes.generator import CONES, NOISES, RATE, make_free_motion
from benchmarks.axes.measures import line_angles
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation

from kinesphere.geometry.rotations import rotation_about, rotation_angle
from kinesphere.parameterization.angles import two_axis_angles
from kinesphere.parameterization.axes import find_axes, free_motion
from kinesphere.parameterization.axes.free_motion import (
    MOST_FRAMES,
    SPACING,
    TRIAL_FRAMES,
    FreeMotion,
    likeliest_axes,
)
from kinesphere.parameterization.axes.joint_kernels import angles_and_loads, constraint_residuals
from kinesphere.parameterization.axes.kernels import surprise
from kinesphere.parameterization.samples import JointSamples
from kinesphere.parameterization.settings import AngleSettings, AxesSettings

ROUNDING = 1e-9
VAGUE = 1.0  # rad², of a mean


def matern(apart, deviation, memory):
    r = np.sqrt(5) * apart / memory
    return deviation**2 * (1 + r + r**2 / 3) * np.exp(-r)


def dense(angles, loads, times, deviations, memories, error, error_memory, floor):
    """Return the same from the covariance of everything with everything."""
    apart = np.abs(times[:, None] - times)
    n = len(times)
    covariance = np.zeros((n, 3, n, 3))
    for k in range(3):
        covariance[:, k, :, k] = matern(apart, deviations[k], memories[k]) + VAGUE
    shared = error**2 * np.exp(-apart / error_memory)
    covariance += np.einsum("aki,bli,ab->akbl", loads, loads, shared)
    whole = covariance.reshape(3 * n, 3 * n) + floor * np.eye(3 * n)
    x = angles.ravel()
    return 0.5 * (x @ np.linalg.solve(whole, x) + np.linalg.slogdet(whole)[1])


def test_the_filter_is_the_likelihood_of_gaussian_processes(rng):
    n = 23
    times = np.cumsum(rng.uniform(0.02, 0.4, n))
    times[5:9] = times[4] + 0.1 * np.arange(1, 5)  # gaps alike and unlike
    times[9:] += 0.5
    told = (
        rng.normal(size=(n, 3)),
        rng.normal(size=(n, 3, 3)),
        np.array([0.3, 0.5, 0.1]),
        np.array([0.4, 0.9, 0.2]),
        0.05,
        0.3,
        0.01,
    )
    fast = surprise(*told[:2], np.diff(times), *told[2:])
    assert fast == pytest.approx(dense(*told[:2], times, *told[2:]), rel=ROUNDING)


def samples_of(joint):
    n = len(joint.rotations)
    return JointSamples(
        joint.rotations, joint.rotations @ joint.long_axis, ((0, n),), RATE, joint.long_axis
    )


@pytest.mark.slow
def test_twist_is_told_from_swing_by_its_course(rng):
    seeds = rng.integers(2**31, size=4)
    errors = {True: [], False: []}
    for seed in seeds:
        joint = make_free_motion(
            np.random.default_rng(seed), CONES["60–120°"], NOISES["OU 1°"], twist=20.0, seconds=60.0
        )
        for refine, found in errors.items():
            settings = AxesSettings(method="universal-joint", refine=refine)
            proximal = find_axes(samples_of(joint), 2, settings)[1]
            found.append(float(line_angles(proximal, joint.axes[1])))
    assert np.median(errors[True]) < 5.0  # deg
    assert np.median(errors[True]) < 0.5 * np.median(errors[False])


@pytest.mark.slow
def test_axes_turn_with_the_parent(rng):
    joint = make_free_motion(rng, CONES["90°"], NOISES["OU 1°"], twist=5.0, seconds=12.0)
    times = np.arange(len(joint.rotations)) / RATE
    start = joint.axes + 0.1 * rng.normal(size=(2, 3))
    start /= np.linalg.norm(start, axis=1)[:, None]
    turn = Rotation.random(rng=rng).as_matrix()
    plain = FreeMotion(joint.rotations, times, joint.long_axis, joint.rest)
    turned = FreeMotion(turn @ joint.rotations, times, joint.long_axis, turn @ joint.rest)
    axes = likeliest_axes(plain, [start]).axes
    assert_allclose(np.abs(line_angles(axes, joint.axes)).max(), 0, atol=15)
    again = likeliest_axes(turned, [start @ turn.T]).axes
    # the descent's coordinates turn with nothing: it ends where the slope is small, not zero
    assert line_angles(axes @ turn.T, again).max() < 0.1


@pytest.mark.slow
def test_the_likelier_start_counts(rng):
    joint = make_free_motion(rng, CONES["90°"], NOISES["clean"], seconds=12.0)
    times = np.arange(len(joint.rotations)) / RATE
    motion = FreeMotion(joint.rotations, times, joint.long_axis, joint.rest)
    far = joint.axes[::-1]  # proximal for distal
    assert_allclose(
        likeliest_axes(motion, [far, joint.axes]).axes,
        likeliest_axes(motion, [joint.axes, joint.axes]).axes,
        atol=1e-12,
    )


def test_long_motion_is_thinned(rng):
    times = np.sort(rng.uniform(0, 400, 9001))
    motion = FreeMotion(np.tile(np.eye(3), (9001, 1, 1)), times, np.eye(3)[0], np.eye(3))
    thinned = motion.thinned()
    assert MOST_FRAMES / 2 < len(thinned.times) <= MOST_FRAMES
    assert len(np.unique(np.floor(thinned.times / SPACING))) == len(thinned.times)
    assert_allclose(motion.first(7).times, times[:7])


def test_restless_errors_are_averaged_and_steady_motion_is_not(rng):
    joint = make_free_motion(rng, CONES["90°"], NOISES["iid 3°"], seconds=10.0)
    times = np.arange(len(joint.rotations)) / RATE
    restless = FreeMotion(joint.rotations, times, joint.long_axis, joint.rest)
    clean = FreeMotion(joint.clean.rotations, times, joint.long_axis, joint.rest)
    assert_allclose(clean.thinned().rotations, clean.rotations[::5])
    thinned = restless.thinned()
    middle = clean.rotations[2::5]  # of five frames at 50 Hz
    errors = rotation_angle(np.swapaxes(middle, -1, -2) @ thinned.rotations)
    alone = rotation_angle(np.swapaxes(middle, -1, -2) @ restless.rotations[2::5])
    assert np.sqrt((errors**2).mean()) < 0.6 * np.sqrt((alone**2).mean())  # 1/√5, and the motion
    assert_allclose(thinned.times, times[2::5])


@pytest.fixture
def free(rng):
    """Return a joint that goes far, and axes about which it is in gimbal lock or out of reach."""
    joint = make_free_motion(
        rng, CONES["60–120°"], NOISES["iid 3°"], amplitudes=(150.0, 60.0), twist=40.0, seconds=10.0
    )
    chosen = slice(None, None, 9)
    times = np.arange(len(joint.rotations))[chosen] / RATE
    wrong = np.array([joint.axes[0] + 0.6 * joint.axes[1], joint.axes[1]])
    wrong /= np.linalg.norm(wrong, axis=1)[:, None]
    return FreeMotion(joint.rotations[chosen], times, joint.long_axis, joint.rest), wrong


def loads_by_differences(motion, axes, step=1e-6):
    """Return how angles change with small turns of the pose about each axis of the parent."""

    def angles(rotations):
        known = np.ones(len(rotations), dtype=bool)
        settings = AngleSettings(branch="default-sign")
        solved = two_axis_angles(
            rotations, axes, motion.reference, motion.long_axis, known, settings
        )
        return np.column_stack([solved.angles[:, :2], solved.twists]), solved

    columns = []
    for axis in np.eye(3):
        ends = [
            angles(rotation_about(axis, np.array([by]))[0] @ motion.rotations)[0]
            for by in (step, -step)
        ]
        columns.append((ends[0] - ends[1] + np.pi) % (2 * np.pi) - np.pi)
    return np.stack(columns, axis=2) / (2 * step), angles(motion.rotations)


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_loads_are_what_small_errors_do_to_the_angles(free, side):
    motion, axes = free
    axes = axes * [[side], [1.0]]
    angles, loads, excess, unit = angles_and_loads(
        motion.rotations, axes[0], axes[1], motion.reference, motion.long_axis, 0.05
    )
    expected, (wrapped, solved) = loads_by_differences(motion, axes)
    assert_allclose((angles - wrapped + np.pi) % (2 * np.pi) - np.pi, 0, atol=ROUNDING)
    assert np.abs(np.diff(angles, axis=0)).max() <= np.pi
    assert_allclose(excess, solved.excess, atol=ROUNDING)
    determinant = solved.sines * np.linalg.norm(np.cross(*axes))
    regular = (determinant > 0.06) & (excess == 0)
    assert 0.5 < regular.mean() < 1
    assert_allclose(loads[regular], expected[regular], rtol=1e-4, atol=1e-4)
    assert unit == pytest.approx(np.log(np.maximum(determinant, 0.05)).sum(), rel=1e-6)


def test_the_cost_is_the_posterior_of_poses(free):
    """Densities of processes, the unit of poses, what is out of reach, and what is usual."""
    motion, axes = free
    gaps = np.round(np.diff(motion.times), 6)
    logs = free_motion.USUAL + np.linspace(-1, 1, 8) * free_motion.FACTORS
    angles, loads, excess, unit = angles_and_loads(
        motion.rotations, axes[0], axes[1], motion.reference, motion.long_axis, 0.05
    )
    sizes = np.exp(logs)
    told = dense(angles, loads, motion.times, sizes[:3], sizes[3:6], sizes[6], sizes[7], 0.002**2)
    assert excess.max() > 0.02
    out = 0.5 * ((excess / 0.02) ** 2).sum()
    prior = 0.5 * (np.linspace(-1, 1, 8) ** 2).sum()
    cost = free_motion._cost(motion, gaps, axes, logs)
    assert cost == pytest.approx(told + unit + out + prior, rel=1e-6)


def test_starts_are_told_apart_by_few_frames(rng, monkeypatch):
    joint = make_free_motion(rng, CONES["90°"], NOISES["clean"], seconds=60.0)
    times = np.arange(len(joint.rotations)) / RATE
    motion = FreeMotion(joint.rotations, times, joint.long_axis, joint.rest)
    seen = []

    def descend(few, start, steps):
        seen.append((len(few.times), steps))
        return free_motion.AxesFit(start, float(len(seen)))

    monkeypatch.setattr(free_motion, "_descend", descend)
    likeliest_axes(motion, [joint.axes, joint.axes[::-1]])
    assert seen == [(TRIAL_FRAMES, 15), (TRIAL_FRAMES, 15), (600, 80)]
    assert TRIAL_FRAMES <= 300


def test_residuals_of_a_universal_joint_and_their_derivatives(rng):
    q = Rotation.random(11, rng=rng).as_matrix()
    x, y, limb = Rotation.random(3, rng=rng).apply([1.0, 0, 0])
    dx, dy = rng.normal(size=(2, 2, 3))
    told = constraint_residuals(q, x, y, dx, dy, limb, 0.3, 0.9)
    cosine, twisting = q @ y @ x, q @ np.cross(limb, y) @ x
    variance = 0.1 * (1 - cosine**2) + 0.9 * twisting**2
    assert_allclose(told[:, 0], (cosine - 0.3) / np.sqrt(variance), rtol=ROUNDING)
    step = 1e-6
    for k in range(5):
        ends = []
        for by in (step, -step):
            a = x + by * dx[k] if k < 2 else x
            b = y + by * dy[k - 2] if 2 <= k < 4 else y
            c = 0.3 + by if k == 4 else 0.3
            ends.append(constraint_residuals(q, a, b, dx, dy, limb, c, 0.9)[:, 0])
        assert_allclose(told[:, 1 + k], (ends[0] - ends[1]) / (2 * step), rtol=1e-5, atol=1e-5)
