"""Axes from free motion with twist: the likelihood of angles as processes."""

import numpy as np
import pytest
from benchmarks.axes.generator import CONES, NOISES, RATE, make_calibration, make_free_motion
from benchmarks.axes.measures import axis_errors, line_angles
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation

from kinesphere.geometry.rotations import rotation_about, rotation_angle
from kinesphere.parameterization.angles import two_axis_angles
from kinesphere.parameterization.axes import find_axes, processes
from kinesphere.parameterization.axes.free_motion import (
    MOST_FRAMES,
    SPACING,
    AxesFit,
    FreeMotion,
)
from kinesphere.parameterization.axes.joint_kernels import angles_and_loads, constraint_residuals
from kinesphere.parameterization.axes.movements import Movements
from kinesphere.parameterization.axes.process_kernels import blank_tape
from kinesphere.parameterization.axes.process_slopes import surprise
from kinesphere.parameterization.axes.processes import (
    TRIAL_FRAMES,
    likeliest_axes,
    likeliest_with_rests,
)
from kinesphere.parameterization.samples import JointSamples, runs
from kinesphere.parameterization.settings import AngleSettings, AxesSettings

ROUNDING = 1e-9
VAGUE = 1.0  # rad², of a mean


def matern(apart, deviation, memory):
    r = np.sqrt(5) * apart / memory
    return deviation**2 * (1 + r + r**2 / 3) * np.exp(-r)


def dense(
    angles, loads, times, movement, deviations, memories, error, error_memory, posture, floor
):
    """Return the same from the covariance of everything with everything."""
    apart = np.abs(times[:, None] - times)
    together = movement[:, None] == movement
    shifts = 1.0 * np.minimum(movement[:, None], movement)  # of a mean that two frames share
    n = len(times)
    covariance = np.zeros((n, 3, n, 3))
    for k in range(3):
        own = together * matern(apart, deviations[movement, k], memories[k])
        covariance[:, k, :, k] = own + VAGUE + posture**2 * shifts
    shared = error**2 * np.exp(-apart / error_memory)
    covariance += np.einsum("aki,bli,ab->akbl", loads, loads, shared)
    whole = covariance.reshape(3 * n, 3 * n) + floor * np.eye(3 * n)
    x = angles.ravel()
    return 0.5 * (x @ np.linalg.solve(whole, x) + np.linalg.slogdet(whole)[1])


@pytest.fixture
def told(rng):
    """Return what a filter is told: gaps alike and unlike, three movements."""
    n = 23
    times = np.cumsum(rng.uniform(0.02, 0.4, n))
    times[5:9] = times[4] + 0.1 * np.arange(1, 5)
    times[9:] += 0.5
    return (
        rng.normal(size=(n, 3)),
        rng.normal(size=(n, 3, 3)),
        times,
        np.repeat([0, 1, 2], [7, 9, 7]),
        rng.uniform(0.1, 0.6, size=(3, 3)),
        np.array([0.4, 0.9, 0.2]),
        0.05,
        0.3,
        0.2,
        0.01,
    )


def filtered(told):
    gaps = np.diff(told[2])
    return surprise(*told[:2], gaps, *told[3:], blank_tape(len(told[0])))


def test_the_filter_is_the_likelihood_of_gaussian_processes(told):
    assert filtered(told)[0] == pytest.approx(dense(*told), rel=ROUNDING)
    one = (*told[:3], 0 * told[3], *told[4:])
    assert filtered(one)[0] == pytest.approx(dense(*one), rel=ROUNDING)


def test_slopes_are_differences_of_the_likelihood(told):
    _, *slopes, others = filtered(told)
    step = 1e-6

    def rise(at, where):
        ends = []
        for by in (step, -step):
            moved = list(told)
            moved[at] = np.array(moved[at], dtype=float)
            moved[at][where] += by
            ends.append(dense(*moved))
        return (ends[0] - ends[1]) / (2 * step)

    for at, slope in zip((0, 1, 4, 5), slopes, strict=True):
        expected = [rise(at, where) for where in np.ndindex(slope.shape)]
        assert_allclose(slope.ravel(), expected, rtol=1e-5, atol=1e-5)
    assert_allclose(others, [rise(at, ()) for at in (6, 7, 8)], rtol=1e-5, atol=1e-5)


def test_a_tape_can_be_used_again(told):
    tape = blank_tape(len(told[0]))
    once, again = (surprise(*told[:2], np.diff(told[2]), *told[3:], tape) for _ in range(2))
    for first, second in zip(once, again, strict=True):
        assert_allclose(first, second, rtol=0, atol=0)


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


@pytest.mark.parametrize("resting", [False, True])
def test_the_cost_is_the_posterior_of_poses(free, resting):
    """Densities of processes, the unit of poses, what is out of reach, and what is usual."""
    motion, axes = free
    n, count = len(motion.times), 10 if resting else 8
    movements = Movements.one(n)
    if resting:
        moving = np.array([[True, False, True], [False, True, False]])
        movements = Movements(np.repeat([0, 1], [n // 2, n - n // 2]), moving)
    unusual = np.linspace(-1, 1, count)
    logs = processes.USUAL[:count] + unusual * processes.FACTORS[:count]
    angles, loads, excess, unit = angles_and_loads(
        motion.rotations, axes[0], axes[1], motion.reference, motion.long_axis, 0.05
    )
    sizes = np.exp(logs)
    deviations, posture = sizes[None, :3], 0.0
    if resting:
        posture = sizes[9]
        deviations = np.array([[sizes[0], sizes[8], sizes[2]], [sizes[8], sizes[1], sizes[8]]])
    told = dense(
        angles,
        loads,
        motion.times,
        movements.of_frame,
        deviations,
        sizes[3:6],
        sizes[6],
        sizes[7],
        posture,
        0.002**2,
    )
    assert excess.max() > 0.02
    out = 0.5 * ((excess / 0.02) ** 2).sum()
    prior = 0.5 * (unusual**2).sum() + resting * 6 * np.log(2)
    cost, slopes = processes._cost_along(
        motion, movements, axes, blank_tape(n), np.concatenate([np.zeros(4), logs])
    )
    assert cost == pytest.approx(told + unit + out + prior, rel=1e-6)
    assert len(slopes) == 4 + count


def test_slopes_of_the_cost_are_its_differences(rng):
    joint = make_free_motion(rng, CONES["90°"], NOISES["OU 1°"], twist=10.0, seconds=4.0)
    times = np.arange(len(joint.rotations)) / RATE
    motion = FreeMotion(joint.rotations, times, joint.long_axis, joint.rest).thinned()
    n = len(motion.times)
    moving = np.array([[True, False, True], [False, True, True]])
    movements = Movements(np.repeat([0, 1], [n // 2, n - n // 2]), moving)
    v = np.concatenate([0.1 * rng.normal(size=4), processes.USUAL])

    def told(at):
        return processes._cost_along(motion, movements, joint.axes, blank_tape(n), at)

    step = 1e-5
    differences = [(told(v + by)[0] - told(v - by)[0]) / (2 * step) for by in step * np.eye(len(v))]
    assert_allclose(told(v)[1], differences, rtol=1e-3, atol=1e-2)


def test_movements_end_at_rests_and_tell_what_moves():
    times = np.concatenate([np.arange(20), 40 + np.arange(20), 80 + np.arange(20)]) * 0.1
    wave = np.sin(np.arange(20))
    angles = np.zeros((60, 3))
    angles[:20, 0] = angles[20:40, 1] = wave
    angles[40:, :2] = 0.8 * wave[:, None]
    angles[:, 2] = 0.01 * np.tile(wave, 3)
    movements = Movements.by_rests(times, angles)
    assert_allclose(movements.of_frame, np.repeat([0, 1, 2], 20))
    assert movements.moving.tolist() == [[True, False, True], [False, True, True], [True] * 3]
    assert movements.resting
    assert not Movements.by_rests(times[:20], angles[:20]).resting
    assert movements.surprise == pytest.approx(9 * np.log(2))
    assert Movements.one(5).surprise == 0.0


def test_where_no_angle_rests_nothing_is_tried(rng):
    joint = make_free_motion(rng, CONES["90°"], NOISES["OU 1°"], seconds=10.0)
    times = np.arange(len(joint.rotations)) / RATE
    motion = FreeMotion(joint.rotations, times, joint.long_axis, joint.rest).thinned()
    smooth = AxesFit(joint.axes, 0.0, processes.USUAL[:8])
    assert likeliest_with_rests(motion, smooth) is smooth


@pytest.mark.slow
@pytest.mark.parametrize("noise", ["iid 3°", "OU 1°"])
def test_one_axis_at_a_time_tells_axes_as_well_as_its_phases(rng, noise):
    """Who moves about one axis at a time is no process that goes on as it is used to."""
    errors = []
    for seed in rng.integers(2**31, size=3):
        joint = make_calibration(np.random.default_rng(seed), CONES["90°"], NOISES[noise])
        moving = runs(joint.moving)
        samples = samples_of(joint).with_phases(moving)
        found = (
            find_axes(samples, 2, AxesSettings(method=method))
            for method in ("universal-joint", "phase-log-pca")
        )
        errors.append([axis_errors(axes, joint.axes).mean() for axes in found])
    free, phases = np.mean(errors, axis=0)
    assert free < 1.3 * phases + 0.2  # deg
    assert free < 1.5


def test_starts_are_told_apart_by_few_frames(rng, monkeypatch):
    joint = make_free_motion(rng, CONES["90°"], NOISES["clean"], seconds=60.0)
    times = np.arange(len(joint.rotations)) / RATE
    motion = FreeMotion(joint.rotations, times, joint.long_axis, joint.rest)
    seen = []

    def descend(few, start, steps, logs=None):
        seen.append((len(few.times), steps))
        assert (logs is None) == (steps == 15)  # the last goes on from the best
        return AxesFit(start, float(len(seen)), processes.USUAL[:8])

    monkeypatch.setattr(processes, "_descend", descend)
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
