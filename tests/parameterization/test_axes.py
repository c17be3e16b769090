"""One behaviour suite for every axis method, and what each alone promises."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation

from kinesphere.parameterization.axes import AXES, find_axes
from kinesphere.parameterization.axes.stratify import one_per_cell, windowed
from kinesphere.parameterization.axes_settings import AXES_METHODS, AxesSettings
from kinesphere.parameterization.samples import JointSamples

ANY_CONE = ["phase-log-pca", "sara", "small-circle"]
RIGHT_ANGLE = ["direction-joining", "em-restarts"]  # right only where limb and axis are at 90°
WITHOUT_NOISE = 1.0  # deg; 0.3 deg of sway about the other axes leaves a few tenths


def settings(method, **more):
    return AxesSettings(method=method, **more)


def found(joint, method, n_axes=2, **more):
    return find_axes(joint.view().samples, n_axes, settings(method, **more))


def test_every_name_has_a_method():
    assert set(AXES) == set(AXES_METHODS)


@pytest.mark.parametrize("method", ANY_CONE + RIGHT_ANGLE)
@pytest.mark.parametrize("between", [70.0, 110.0])
def test_axes_are_found_again(rng, calibration, method, between):
    joint = calibration(rng, between=between)
    assert joint.axis_errors(found(joint, method)).max() < WITHOUT_NOISE


@pytest.mark.parametrize("method", ANY_CONE)
@pytest.mark.parametrize("cone", [65.0, 75.0, 105.0])
def test_a_limb_need_not_be_perpendicular_to_its_axes(rng, calibration, method, cone):
    joint = calibration(rng, cone=cone)
    assert joint.axis_errors(found(joint, method)).max() < WITHOUT_NOISE


@pytest.mark.parametrize("method", RIGHT_ANGLE)
def test_great_circles_are_biased_by_the_cone(rng, calibration, method):
    joint = calibration(rng, cone=75.0)
    assert_allclose(joint.axis_errors(found(joint, method)), 16.5, atol=2.0)


def test_principal_components_are_not_movement_axes(rng, calibration):
    joint = calibration(rng)
    assert joint.axis_errors(found(joint, "pca")).max() > 15.0


def test_em_does_better_than_its_start(rng, calibration):
    joint = calibration(rng)
    refined = joint.axis_errors(found(joint, "em")).mean()
    assert refined < joint.axis_errors(found(joint, "pca")).mean()


@pytest.mark.parametrize("method", ["phase-log-pca", "sara"])
def test_twist_does_not_tilt_the_axes(rng, calibration, method):
    joint = calibration(rng, twist=10.0)
    assert joint.axis_errors(found(joint, method)).max() < WITHOUT_NOISE
    assert joint.axis_errors(found(joint, method, refine=False)).max() > WITHOUT_NOISE


@pytest.mark.parametrize("method", ANY_CONE)
def test_one_movement_may_be_done_in_several_postures(rng, method):
    axis, other, long_axis = np.eye(3)
    swings = 0.7 * np.sin(np.linspace(0, 2 * np.pi, 60))
    parts = [
        Rotation.from_rotvec(swings[:, None] * axis) * Rotation.from_rotvec(posture * other)
        for posture in (-0.5, 0.0, 0.8)
    ]
    rotations = np.concatenate([part.as_matrix() for part in parts])
    phases = ((0, 60), (60, 120), (120, 180))
    samples = JointSamples(rotations, rotations @ long_axis, phases, 50.0, long_axis)
    axes = find_axes(samples, 1, settings(method))
    assert abs(axes[0] @ axis) > np.cos(np.deg2rad(0.01))


def test_less_noise_finds_better_axes(calibration):
    medians = []
    for correlated in (2.0, 1.0, 0.5):
        errors = [
            calibrated.axis_errors(found(calibrated, "phase-log-pca")).mean()
            for calibrated in (
                calibration(np.random.default_rng(seed), correlated=correlated) for seed in range(7)
            )
        ]
        medians.append(np.median(errors))
    assert medians[0] > medians[1] > medians[2]
    assert medians[1] < 1.5  # deg, at 1 deg of correlated noise


@pytest.mark.parametrize("method", sorted(set(AXES) - {"universal-joint"}))
def test_axes_turn_with_the_parent(rng, calibration, method):
    samples = calibration(rng, cone=80.0).view().samples
    turn = Rotation.random(rng=rng).as_matrix()
    turned = JointSamples(
        turn @ samples.rotations,
        samples.positions @ turn.T,
        samples.phases,
        samples.rate,
        samples.long_axis,
    )
    axes = find_axes(samples, 2, settings(method, restarts=100)) @ turn.T
    again = find_axes(turned, 2, settings(method, restarts=100))
    apart = np.abs(np.abs(np.einsum("ki,li->kl", axes, again)).max(axis=1) - 1)
    # cells lie on the sphere, not on the limb: positions sorted into cells move a little
    assert apart.max() < (5e-3 if method in ("pca", "em", "em-restarts") else 1e-6)


@pytest.mark.parametrize("method", ["phase-log-pca", "sara", "small-circle"])
def test_time_may_run_backwards(rng, calibration, method):
    samples = calibration(rng).view().samples
    n = len(samples.rotations)
    reversed_ = JointSamples(
        samples.rotations[::-1],
        samples.positions[::-1],
        tuple((n - stop, n - start) for start, stop in samples.phases[::-1]),
        samples.rate,
        samples.long_axis,
    )
    forward = find_axes(samples, 2, settings(method, refine=False))
    backward = find_axes(reversed_, 2, settings(method, refine=False))
    cosines = np.abs(forward @ backward.T).max(axis=1)
    assert_allclose(cosines, 1.0, atol=1e-9)


@pytest.mark.parametrize("method", sorted(AXES))
@pytest.mark.parametrize("n_axes", [1, 2])
def test_no_movement_finds_no_axes(rng, calibration, method, n_axes):
    samples = calibration(rng).view().samples.with_phases(())
    assert find_axes(samples, n_axes, settings(method)).shape == (0, 3)


@pytest.mark.parametrize("method", ["phase-log-pca", "sara", "small-circle", "direction-joining"])
def test_one_movement_is_one_axis(rng, calibration, method):
    joint = calibration(rng, sway=0.0)
    samples = joint.view().samples
    samples = samples.with_phases(samples.phases[:3])
    axes = find_axes(samples, 2, settings(method))
    assert axes.shape == (1, 3)
    assert abs(axes[0] @ joint.axes[0]) > np.cos(np.deg2rad(0.1))


@pytest.mark.parametrize("n_axes", [1, 3])
def test_as_many_axes_as_there_are_movements(rng, calibration, n_axes):
    joint = calibration(rng)
    axes = found(joint, "phase-log-pca", n_axes)
    assert len(axes) == min(n_axes, 2)
    assert np.abs(joint.axes @ axes.T).max(axis=1).max() > 0.999


@pytest.mark.slow
def test_free_motion_needs_the_universal_joint(rng, calibration):
    joint = calibration(rng)
    t = np.arange(1200) / 50
    swing = np.deg2rad([40.0, 35.0])[:, None] * np.sin(
        2 * np.pi * np.outer([0.31, 0.47], t) + rng.uniform(0, 6, (2, 1))
    )
    pose = Rotation.from_matrix(joint.rest)
    for axis, angle in zip(joint.axes, swing, strict=True):
        pose = Rotation.from_rotvec(angle[:, None] * axis) * pose
    rotations = pose.as_matrix() @ joint.rest.T  # the reference is the identity
    long_axis = joint.rest @ joint.long_axis
    samples = JointSamples(rotations, rotations @ long_axis, ((0, 1200),), 50.0, long_axis)
    axes = find_axes(samples, 2, settings("universal-joint"))
    # proximal exactly; distal up to the pose that serves as reference
    assert abs(axes[1] @ joint.axes[1]) > np.cos(np.deg2rad(0.2))
    assert_allclose(abs(axes[0] @ axes[1]), abs(joint.axes[0] @ joint.axes[1]), atol=0.01)


def test_one_representative_a_cell(rng):
    points = rng.normal(size=(4000, 3))
    points /= np.linalg.norm(points, axis=1, keepdims=True)
    cell = np.deg2rad(20)
    chosen = one_per_cell(points, cell)
    assert len(chosen) == pytest.approx(4 * np.pi / cell**2, rel=0.15)
    assert {tuple(p) for p in chosen} <= {tuple(p) for p in points}


def test_windows_keep_the_order_and_let_a_cell_return():
    there = np.deg2rad(np.arange(0, 31, 0.5))
    angles = np.concatenate([there, there[::-1]])
    points = np.stack([np.cos(angles), np.sin(angles), 0 * angles], axis=1)
    chosen = np.rad2deg(np.arctan2(*windowed(points, np.deg2rad(4.9)).T[[1, 0]]))
    assert_allclose(chosen, [0, 5, 10, 15, 20, 25, 30, 25, 20, 15, 10, 5, 0], atol=0.6)


def test_two_frames_of_a_circle_tell_no_axis(rng, calibration):
    """Any line across them is as good, and rounding would choose: axes would flip with 1e-15."""
    samples = calibration(rng).view().samples
    brief = tuple((a + 5, a + 7) for a, _ in samples.phases)
    settings = AxesSettings(method="small-circle")
    assert len(find_axes(samples.with_phases(brief), 2, settings)) == 0
    mixed = samples.with_phases((*samples.phases, *brief))
    assert_allclose(find_axes(mixed, 2, settings), find_axes(samples, 2, settings), atol=1e-12)
