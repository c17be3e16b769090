"""What two halves of a movement say about the axes of the whole."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from kinesphere.parameterization.axes import find_axes
from kinesphere.parameterization.axes.fit import phase_swing
from kinesphere.parameterization.confidence import assess_axes
from kinesphere.parameterization.halves import contradiction, early_share
from kinesphere.parameterization.settings import AxesSettings


def search(samples):
    return samples, find_axes(samples, 2, AxesSettings())


def alternating(rng, calibration, **changes):
    """Return a joint that moves about both axes in each half, and its two halves."""
    samples = calibration(rng, repetitions=4, seconds=40.0, **changes).view().samples
    phases = samples.phases
    return samples, [samples.with_phases(phases[i::2]) for i in (0, 1)]


def test_halves_of_one_joint_agree(rng, calibration):
    samples, halves = alternating(rng, calibration)
    apart, arcs, _ = contradiction(halves, search(samples)[1], search)
    assert np.rad2deg(apart).max() < 1.0
    assert (np.rad2deg(arcs) > 50.0).all()  # of twice 40° to 45°, the extremes left out


def test_halves_of_two_joints_contradict_each_other(rng, calibration):
    samples, halves = alternating(rng, calibration)
    _, others = alternating(rng, calibration)
    apart, _, _ = contradiction([halves[0], others[1]], search(samples)[1], search)
    assert np.rad2deg(apart).max() > 20.0


def test_the_smaller_arc_is_told(rng, calibration):
    samples, halves = alternating(rng, calibration)
    _, small = alternating(rng, calibration, amplitudes=(10.0, 9.0))
    _, arcs, _ = contradiction([halves[0], small[1]], search(samples)[1], search)
    assert (np.rad2deg(arcs) < 21.0).all()


def test_a_half_without_movement_tells_nothing(rng, calibration):
    samples, halves = alternating(rng, calibration)
    still = halves[1].with_phases(())
    apart, arcs, _ = contradiction([halves[0], still], search(samples)[1], search)
    assert np.isnan(apart).all()
    assert_allclose(arcs, 0)


def test_a_half_that_lacks_one_movement_tells_of_the_other(rng, calibration):
    samples, halves = alternating(rng, calibration)
    axes = search(samples)[1]
    one = halves[1].with_phases(halves[1].phases[:2])  # about the first axis only
    apart, arcs, _ = contradiction([halves[0], one], axes, search)
    told = np.isfinite(apart)
    assert told.sum() == 1
    assert np.rad2deg(apart[told]) < 1.0
    assert_allclose(arcs[~told], 0)


@pytest.mark.parametrize("cut", [0, 55, 10_000])
def test_the_early_share_counts_frames(rng, calibration, cut):
    samples = calibration(rng).view().samples.with_phases(((0, 40), (50, 60), (60, 100)))
    labels = np.array([0, 1, 1])
    expected = {0: [0, 0], 55: [1, 0.1], 10_000: [1, 1]}[cut]
    assert_allclose(early_share(samples, labels, 2, cut, cut), expected)
    assert_allclose(early_share(samples, labels, 2, 20, 30), [2 / 3, 0])  # ten frames in neither


def test_halves_that_contradict_each_other_enough_end_the_comparing(rng, calibration):
    samples, _ = alternating(rng, calibration)
    axes = search(samples)[1]
    seen = []

    def find(half):
        seen.append(half.phases)
        return np.roll(axes, len(seen), axis=1)  # something else every time

    whole = assess_axes(samples, axes, find)
    asked, most = len(seen), whole.halves.max()
    assert asked > 2
    seen.clear()
    assert assess_axes(samples, axes, find, np.deg2rad(20.0)).halves.max() > np.deg2rad(20.0)
    assert len(seen) == 2
    seen.clear()
    assert assess_axes(samples, axes, find, 2.0).halves.max() == most
    assert len(seen) == asked


def test_conditioning_tells_how_many_times_larger_the_rotation_is(rng, calibration):
    samples, _ = alternating(rng, calibration)
    quality = assess_axes(samples, search(samples)[1], lambda s: search(s)[1])
    swings = [phase_swing(samples, phase).vectors for phase in samples.phases]
    for k, told in enumerate(quality.conditioning):
        mine = [v for v, at in zip(swings, quality.labels, strict=True) if at == k]
        sizes = np.linalg.svd(np.concatenate(mine), compute_uv=False)  # rad, not rad²
        assert told == pytest.approx(sizes[0] / sizes[1])


def test_a_half_that_does_all_at_once_is_not_pure(rng, calibration):
    samples, halves = alternating(rng, calibration)
    axes = search(samples)[1]
    *_, pure = contradiction(halves, axes, search)
    assert (pure > 0.95).all()
    mixed = halves[1].with_phases(((halves[1].phases[0][0], halves[1].phases[-1][1]),))
    *_, pure = contradiction([halves[0], mixed], axes, search)
    assert (pure < 0.9).all()
