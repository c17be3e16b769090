"""What two halves of a movement say about the axes of the whole."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from kinesphere.parameterization.axes import find_axes
from kinesphere.parameterization.confidence import contradiction, early_share
from kinesphere.parameterization.settings import AxesSettings


def find(samples):
    return find_axes(samples, 2, AxesSettings())


def alternating(rng, calibration, **changes):
    """Return a joint that moves about both axes in each half, and its two halves."""
    samples = calibration(rng, repetitions=4, seconds=40.0, **changes).view().samples
    phases = samples.phases
    return samples, [samples.with_phases(phases[i::2]) for i in (0, 1)]


def test_halves_of_one_joint_agree(rng, calibration):
    samples, halves = alternating(rng, calibration)
    apart = contradiction(halves, find(samples), np.array([0.5, 0.5]), find)
    assert np.rad2deg(apart).max() < 1.0


def test_halves_of_two_joints_contradict_each_other(rng, calibration):
    samples, halves = alternating(rng, calibration)
    _, others = alternating(rng, calibration)
    apart = contradiction([halves[0], others[1]], find(samples), np.array([0.5, 0.5]), find)
    assert np.rad2deg(apart).max() > 20.0


def test_an_axis_of_one_half_alone_is_contradicted_by_nothing(rng, calibration):
    samples, halves = alternating(rng, calibration)
    apart = contradiction(halves, find(samples), np.array([0.5, 0.9]), find)
    assert np.isfinite(apart[0])
    assert np.isnan(apart[1])


def test_a_half_without_movement_tells_nothing(rng, calibration):
    samples, halves = alternating(rng, calibration)
    still = halves[1].with_phases(())
    assert np.isnan(contradiction([halves[0], still], find(samples), np.ones(2) / 2, find)).all()


@pytest.mark.parametrize("cut", [0, 55, 10_000])
def test_the_early_share_counts_frames(rng, calibration, cut):
    samples = calibration(rng).view().samples.with_phases(((0, 40), (50, 60), (60, 100)))
    labels = np.array([0, 1, 1])
    expected = {0: [0, 0], 55: [1, 0.1], 10_000: [1, 1]}[cut]
    assert_allclose(early_share(samples, labels, 2, cut), expected)
