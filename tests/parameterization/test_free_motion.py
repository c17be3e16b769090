"""Axes from free motion with twist: the likelihood of angles as processes."""

import numpy as np
import pytest
from benchmarks.axes.generator import CONES, NOISES, RATE, make_free_motion
from benchmarks.axes.measures import line_angles
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation

from kinesphere.geometry.rotations import rotation_angle
from kinesphere.parameterization.axes import find_axes
from kinesphere.parameterization.axes.free_motion import (
    MOST_FRAMES,
    SPACING,
    FreeMotion,
    likeliest_axes,
)
from kinesphere.parameterization.axes.kernels import surprise
from kinesphere.parameterization.samples import JointSamples
from kinesphere.parameterization.settings import AxesSettings

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
    axes = likeliest_axes(plain, [start])
    assert_allclose(np.abs(line_angles(axes, joint.axes)).max(), 0, atol=15)
    again = likeliest_axes(turned, [start @ turn.T])
    # the descent's coordinates turn with nothing: it ends where the slope is small, not zero
    assert line_angles(axes @ turn.T, again).max() < 0.1


@pytest.mark.slow
def test_the_likelier_start_counts(rng):
    joint = make_free_motion(rng, CONES["90°"], NOISES["clean"], seconds=12.0)
    times = np.arange(len(joint.rotations)) / RATE
    motion = FreeMotion(joint.rotations, times, joint.long_axis, joint.rest)
    far = joint.axes[::-1]  # proximal for distal
    assert_allclose(
        likeliest_axes(motion, [far, joint.axes]), likeliest_axes(motion, [joint.axes]), atol=1e-12
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
