"""How uncertain centres are, against draws of what was weighed."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation

from kinesphere.geometry.centre_covariance import (
    Told,
    covariance_of,
    data_covariance_of,
    scatter_of,
)

SPREAD = 0.05


def test_with_the_right_weights_it_is_the_inverse_of_the_information():
    known, prior = np.diag([4.0, 9.0, 1.0]), np.eye(3) / SPREAD**2
    found = covariance_of(Told(known, known), prior, 1.0, SPREAD)
    assert_allclose(found, np.linalg.inv(known + prior), rtol=1e-12)


def test_it_survives_motion_that_knows_one_direction_only():
    """What is known 10²⁰ times better than the rest makes a plain inverse singular."""
    prior = np.eye(3) / SPREAD**2
    known = np.diag([1e23, 0.0, 0.0])
    found = covariance_of(Told(known, known), prior, 1.0, SPREAD)
    assert_allclose(found, np.diag([1e-23, SPREAD**2, SPREAD**2]), rtol=1e-9)
    axis = np.array([1.0, 2.0, -2.0]) / 3
    known = 1e23 * np.outer(axis, axis)
    found = covariance_of(Told(known, known), prior, 1.0, SPREAD)
    assert abs(axis @ found @ axis) < 1e-14
    assert np.linalg.eigvalsh(found)[0] > -1e-14


def test_what_scatters_where_nothing_pulls_is_rounding():
    """A hinge without noise: scores of 1e9 leave squares of 100 across all of them, of any sign."""
    turn = Rotation.from_rotvec([0.4, -0.9, 0.2]).as_matrix()
    pull = turn @ np.diag([1e18, 1e16, 0.0]) @ turn.T
    for left in (-100.0, 100.0):
        told = Told(pull, pull + left * np.outer(turn[:, 2], turn[:, 2]))
        variances = np.linalg.eigvalsh(data_covariance_of(told, 0.025))
        assert variances[-1] == pytest.approx(25.0**2)
        assert (np.abs(variances[:2]) < 1e-12).all()


def test_where_motion_is_silent_it_says_a_thousand_spreads():
    known = np.diag([1e6, 1e6, 0.0])
    found = data_covariance_of(Told(known, known), SPREAD)
    assert_allclose(np.sqrt(np.diag(found)), [1e-3, 1e-3, 1e3 * SPREAD], rtol=1e-3)


def test_a_centre_strays_as_told_however_wrong_the_weights(rng):
    """Looks that count too little, an expectation held too tightly and off by more or less."""
    root, looks = rng.normal(size=(3, 3)), 30.0
    scatter = root @ root.T * looks**2
    pull = np.diag([50.0, 400.0, 3000.0])
    prior = np.diag([1.0, 1.0, 100.0]) / SPREAD**2
    off = 0.6
    n = 40_000
    forces = rng.normal(size=(n, 3)) @ root.T * looks
    forces += rng.normal(size=(n, 3)) * off * SPREAD @ prior
    centres = forces @ np.linalg.inv(prior + pull)
    told = covariance_of(Told(pull, scatter), prior, off, SPREAD)
    assert_allclose(centres.T @ centres / n, told, rtol=0.05, atol=0.03 * told.max())


@pytest.mark.parametrize("share", [0.0, 0.5, 1.0])
def test_frames_of_one_pose_err_together_as_far_as_errors_last(rng, share):
    held, poses, draws = 5, 40, 4000
    sides = np.repeat(rng.normal(size=(poses, 3)), held, axis=0)
    lasting = np.repeat(rng.normal(size=(draws, poses)), held, axis=1) * np.sqrt(1 - share)
    noise = rng.normal(size=(draws, poses * held)) * np.sqrt(share)
    sums = (lasting + noise) @ sides
    told = [
        scatter_of(sides * e[:, None], share, np.full(poses * held, float(held)))
        for e in (lasting + noise)[:200]
    ]
    assert_allclose(np.mean(told, axis=0), sums.T @ sums / draws, rtol=0.1, atol=15)
