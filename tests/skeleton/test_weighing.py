"""Two opinions on a centre, each as sure as it is."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from kinesphere.geometry.centres import CentreFit
from kinesphere.skeleton.weighing import weighed

EXPECTED = np.array([0.02, -0.08, 0.09])


def fit(deviations, centre=(0.0, -0.07, 0.10), turn=None):
    turn = np.eye(3) if turn is None else turn
    data = turn @ np.diag(np.square(deviations)) @ turn.T
    return CentreFit(np.array(centre), 1e-3, data, np.eye(3) / 0.05**2, data, 20)


def test_it_is_the_mean_weighted_by_inverse_covariances():
    turn = np.linalg.qr(np.random.default_rng(3).normal(size=(3, 3)))[0]
    alone = fit((0.003, 0.009, 0.030), turn=turn)
    both = weighed(alone, EXPECTED, 0.009)
    a, b = np.linalg.inv(alone.data_covariance), np.eye(3) / 0.009**2
    assert_allclose(both.covariance, np.linalg.inv(a + b), rtol=1e-9, atol=1e-15)
    assert_allclose(both.centre, both.covariance @ (a @ alone.centre + b @ EXPECTED), atol=1e-12)
    # what the motion alone knows is no more than it was
    assert both.data_covariance is alone.data_covariance
    assert both.prior is alone.prior


def test_a_motion_that_is_sure_wins_and_one_that_is_silent_does_not():
    sure = weighed(fit((1e-5,) * 3), EXPECTED, 0.009)
    assert_allclose(sure.centre, fit((1e-5,) * 3).centre, atol=1e-7)
    silent = weighed(fit((54.0,) * 3), EXPECTED, 0.009)
    assert_allclose(silent.centre, EXPECTED, atol=1e-8)
    assert_allclose(silent.covariance, 0.009**2 * np.eye(3), rtol=1e-6, atol=1e-12)
    mixed = weighed(fit((1e-5, 1e-5, 54.0)), EXPECTED, 0.009)
    assert_allclose(mixed.centre, [0.0, -0.07, 0.09], atol=1e-7)
    exact = weighed(fit((0.0,) * 3), EXPECTED, 0.009)
    assert_allclose(exact.centre, fit((0.0,) * 3).centre, atol=1e-15)
    assert_allclose(exact.covariance, 0, atol=1e-18)


@pytest.mark.parametrize("spread", [0.003, 0.009, 0.1])
def test_two_opinions_are_surer_than_either(spread):
    alone = fit((0.004, 0.012, 0.2))
    both = weighed(alone, EXPECTED, spread).covariance
    for one in (alone.data_covariance, spread**2 * np.eye(3)):
        assert np.linalg.eigvalsh(one - both).min() > 0
    assert np.linalg.eigvalsh(both).min() > 0


def test_errors_are_what_is_told_of_them():
    """Draws of both opinions about a known centre: their mean square is the covariance."""
    rng = np.random.default_rng(8)
    deviations, spread = np.array([0.003, 0.009, 0.030]), 0.009
    off = []
    for _ in range(4000):
        alone = fit(deviations, centre=rng.normal(size=3) * deviations)
        off.append(weighed(alone, rng.normal(size=3) * spread, spread).centre)
    told = np.diag(weighed(alone, np.zeros(3), spread).covariance)
    assert_allclose(np.mean(np.square(off), axis=0), told, rtol=0.1)
