"""Axes from free motion by the spectra of the angles."""

from dataclasses import replace

import numpy as np
import pytest
from benchmarks.axes.doubts import one_rhythm
from benchmarks.axes.generator import CONES, NOISES, RATE, make_free_motion, poses, spoil
from benchmarks.axes.measures import line_angles
from numpy.testing import assert_allclose
from scipy.signal import lfilter
from scipy.spatial.transform import Rotation

from kinesphere.geometry.rotations import rotation_about, rotation_angle, tangent_basis
from kinesphere.parameterization.axes import spectra
from kinesphere.parameterization.axes.free_motion import FreeMotion
from kinesphere.parameterization.axes.processes import likeliest_axes
from kinesphere.parameterization.axes.spectra import sparsest_axes, spread_of_axes
from kinesphere.parameterization.axes.stretches import stretches_of
from kinesphere.parameterization.axes.waves import (
    Stretch,
    both_of,
    linearized,
    posterior,
    products_of,
)

ROUNDING = 1e-9
SMALL = 1e-5  # rad


def free_motion(joint):
    times = np.arange(len(joint.rotations)) / RATE
    return FreeMotion(joint.rotations, times, joint.long_axis, joint.rest)


def near(rng, axes, size=0.1):
    moved = axes + size * rng.normal(size=(2, 3))
    return moved / np.linalg.norm(moved, axis=1)[:, None]


@pytest.fixture
def twisting(rng):
    return make_free_motion(rng, CONES["60–120°"], NOISES["OU 1°"], twist=20.0, seconds=20.0)


@pytest.fixture
def stretch(rng, twisting):
    motion = free_motion(twisting).thinned()
    (stretch,), _ = stretches_of(motion, twisting.axes)
    return motion, stretch


@pytest.mark.slow
def test_rhythms_tell_twist_from_swing_in_twenty_seconds(rng):
    errors = []
    for _ in range(7):
        joint = make_free_motion(rng, CONES["60–120°"], NOISES["OU 1°"], twist=20.0)
        motion = free_motion(joint).thinned()
        smooth = likeliest_axes(motion, [near(rng, joint.axes)])
        rhythmic = sparsest_axes(motion, smooth.axes)
        assert rhythmic.cost < smooth.cost - 50  # these are rhythms
        errors.append([line_angles(f.axes, joint.axes).mean() for f in (smooth, rhythmic)])
    smooth, rhythmic = np.median(errors, axis=0)
    assert rhythmic < 2.0  # deg, as asked of free motion
    assert rhythmic < 0.5 * smooth


@pytest.mark.slow
def test_what_goes_from_place_to_place_is_no_rhythm(rng):
    """Smooth moves between random places, with spectra that fall, far from gimbal lock."""
    joint = make_free_motion(rng, CONES["90°"], NOISES["OU 1°"], twist=20.0, seconds=40.0)
    kicks = rng.normal(size=(3, 3 * len(joint.rotations)))
    keep = np.exp(-2 * np.pi * 0.35 / RATE)  # 0.35 Hz
    for _ in range(3):
        kicks = lfilter([1 - keep], [1, -keep], kicks)
    angles = kicks[:, len(joint.rotations) :][:, : len(joint.rotations)].T
    angles *= np.deg2rad([45.0, 40.0, 20.0]) / np.abs(angles).max(axis=0)
    rotations = poses(joint.axes, joint.rest, joint.long_axis, angles)
    spoiled = spoil(rng, rotations, angles, NOISES["OU 1°"])
    motion = free_motion(replace(joint, rotations=spoiled)).thinned()
    rhythmic = sparsest_axes(motion, joint.axes)
    assert likeliest_axes(motion, [rhythmic.axes]).cost < rhythmic.cost


def test_without_errors_the_axes_are_the_true_ones(rng):
    joint = make_free_motion(rng, CONES["90°"], NOISES["clean"], twist=20.0, seconds=20.0)
    found = sparsest_axes(free_motion(joint).thinned(), near(rng, joint.axes))
    assert line_angles(found.axes, joint.axes).max() < 0.5  # deg; sway of 0.1° is reckoned with


def test_axes_turn_with_the_parent(rng, twisting):
    motion = free_motion(twisting).thinned()
    start = near(rng, twisting.axes)
    turn = Rotation.random(rng=rng).as_matrix()
    turned = FreeMotion(
        turn @ motion.rotations, motion.times, motion.long_axis, turn @ motion.reference
    )
    plain, again = sparsest_axes(motion, start), sparsest_axes(turned, start @ turn.T)
    # Matrices are the same up to rounding, and every round is a solution of equations
    assert_allclose(again.axes, plain.axes @ turn.T, atol=1e-6)
    assert again.cost == pytest.approx(plain.cost, rel=1e-6)


def test_long_rests_count_as_short_ones_and_empty_stretches_do_not(twisting):
    motion = free_motion(twisting).thinned()
    late = motion.times + np.where(np.arange(len(motion.times)) < 100, 0.0, 500.0)
    stretches, _ = stretches_of(
        FreeMotion(motion.rotations, late, motion.long_axis, motion.reference), twisting.axes
    )
    assert sum(len(part.angles) for part in stretches) == len(motion.times)
    assert len(stretches) == 1


def test_poses_turn_with_angles_and_axes_as_they_are_said_to(rng, stretch):
    """What the linear model leaves shrinks with the square of the change."""
    motion, part = stretch
    axes = near(rng, np.stack([rng.normal(size=3), rng.normal(size=3)]), 0.0)
    bases = [tangent_basis(axis) for axis in axes]
    angles = rng.uniform(-1, 1, size=part.angles.shape)
    limb = motion.reference @ motion.long_axis

    def posed(v, turned):
        moved = axes + np.stack([v[:2] @ bases[0], v[2:] @ bases[1]])
        moved /= np.linalg.norm(moved, axis=1)[:, None]
        return (
            rotation_about(moved[1], turned[:, 1])
            @ rotation_about(moved[0], turned[:, 0])
            @ rotation_about(limb, turned[:, 2])
            @ motion.reference
        )

    v, more = SMALL * rng.normal(size=4), SMALL * rng.normal(size=angles.shape)
    seen = Stretch(posed(v, angles + more), part.waves, angles, part.sizes)
    by_angle, others, out = linearized(motion, seen, axes, bases)
    left = out - np.einsum("nik,nk->ni", by_angle, angles + more) - others[:, :, 3:] @ v
    assert np.abs(left).max() < 100 * SMALL**2
    assert_allclose(others[:, :, :3], by_angle)
    assert rotation_angle(np.swapaxes(posed(0 * v, angles), 1, 2) @ seen.rotations).max() > SMALL


def test_products_and_posterior_are_those_of_the_whole_matrix(rng, stretch):
    motion, part = stretch
    bases = [tangent_basis(axis) for axis in np.eye(3)[:2]]
    linear = linearized(motion, part, np.eye(3)[:2], bases)
    by_angle, others, out = linear
    columns = [by_angle[:, :, k, None] * part.waves[:, None] for k in range(3)]
    whole = np.concatenate([*columns, others, out[:, :, None]], axis=2)
    whole = whole.reshape(-1, whole.shape[2])
    products = products_of(linear, part.waves)
    assert_allclose(products, whole.T @ whole, rtol=1e-9, atol=1e-9)
    variances, share, narrowed = posterior(products, part.sizes)
    m = len(variances)
    inverse = products[:m, :m] + np.diag(1 / both_of(part.sizes).ravel())
    assert_allclose(variances, np.diag(np.linalg.inv(inverse)), rtol=1e-6)
    assert_allclose(inverse @ share, products[:m, m:], rtol=1e-6, atol=1e-6)
    assert narrowed == pytest.approx(0.5 * np.linalg.slogdet(inverse)[1])


def test_evidence_of_fixed_variances_is_that_of_the_poses(rng):
    """With waves of known variance the cost is a Gaussian's, but for the waves' own surprise."""
    sizes = np.exp(rng.normal(size=(2, 3, 5)))
    usual = np.exp(rng.normal(size=(3, 5)))
    told = spectra._surprise(sizes, usual)
    # of a wave with x² + y² = s and 1/σ² gamma distributed of shape 1, scale s₀: s₀ / (s₀ + s/2)²
    assert told == pytest.approx(-np.log(usual / (usual + sizes / 2) ** 2).sum())


def test_a_rhythm_that_angles_share_leaves_axes_uncertain_and_is_told(rng, twisting):
    """Nothing but the spread tells: halves of such a motion are as alike as can be."""
    motion = free_motion(twisting).thinned()
    own = np.rad2deg(spread_of_axes(motion, twisting.axes))
    assert own.shape == (2,)
    assert own.max() < 3.0
    shared = one_rhythm(rng, (30.0, 8.0, 8.0))
    assert np.rad2deg(spread_of_axes(free_motion(shared).thinned(), shared.axes)).max() > 6.0


def test_the_spread_is_the_size_of_errors(rng):
    """Where each angle has rhythms of its own: waves' sizes and independence are not known."""
    ratios = []
    for _ in range(4):
        joint = make_free_motion(rng, CONES["60–120°"], NOISES["OU 1°"], twist=10.0, seconds=20.0)
        motion = free_motion(joint).thinned()
        found = sparsest_axes(motion, near(rng, joint.axes)).axes
        ratios.append(np.deg2rad(line_angles(found, joint.axes)) / spread_of_axes(motion, found))
    assert 0.5 < np.sqrt(np.mean(np.square(ratios))) < 3.0
