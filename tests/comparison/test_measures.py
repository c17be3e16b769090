"""Agreement of two series, against formulas written out and processes of known memory."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from kinesphere.comparison.measures import agreement, effective_samples


def process(rng, n, memory):
    """Return a first-order process: neighbours correlate by ``memory``."""
    x = np.empty(n)
    x[0] = rng.normal()
    for i in range(1, n):
        x[i] = memory * x[i - 1] + np.sqrt(1 - memory**2) * rng.normal()
    return x


@pytest.mark.parametrize("memory", [0.0, 0.5, 0.9])
def test_a_process_is_worth_what_theory_says(rng, memory):
    n = 20_000
    expected = n * (1 - memory) / (1 + memory)
    assert effective_samples(process(rng, n, memory)) == pytest.approx(expected, rel=0.2)


def test_gaps_make_less_of_it_and_a_constant_is_no_process(rng):
    x = process(rng, 4000, 0.8)
    whole = effective_samples(x)
    x[rng.random(4000) < 0.5] = np.nan
    assert 0.6 * whole < effective_samples(x) < 1.6 * whole
    assert effective_samples(np.full(50, 3.0)) == 50
    assert effective_samples(np.full(5, np.nan)) == 0
    assert effective_samples(np.array([1.0, np.nan])) == 1


@given(seed=st.integers(0, 2**32 - 1), bias=st.floats(-5, 5))
def test_the_figures_are_what_they_are_called(seed, bias):
    rng = np.random.default_rng(seed)
    x = 10 * rng.normal(size=40)
    y = x + bias + rng.normal(size=40)
    y[3] = np.nan
    found, d = agreement(x, y), np.delete(y - x, 3)
    assert found.n == 39
    assert found.bias == pytest.approx(d.mean())
    assert found.sd == pytest.approx(np.std(d, ddof=1))
    assert found.rmsd**2 == pytest.approx(found.bias**2 + found.sd**2 * 38 / 39)
    assert found.limits == pytest.approx((d.mean() - 1.96 * found.sd, d.mean() + 1.96 * found.sd))
    x, y = np.delete(x, 3), np.delete(y, 3)
    assert found.correlation == pytest.approx(np.corrcoef(x, y)[0, 1])
    assert found.slope == pytest.approx(np.polyfit((x + y) / 2, y - x, 1)[0])


def test_the_coefficient_of_multiple_correlation_is_as_published():
    """Ferrari et al. 2010, two protocols in one cycle, written out sample by sample."""
    x, y = np.array([1.0, 4.0, 2.0, 7.0]), np.array([2.0, 3.5, 2.5, 8.0])
    frames, protocols = 4, 2
    within = overall = 0.0
    mean = (x.sum() + y.sum()) / 8
    for a, b in zip(x, y, strict=True):
        middle = (a + b) / 2
        within += (a - middle) ** 2 + (b - middle) ** 2
        overall += (a - mean) ** 2 + (b - mean) ** 2
    expected = np.sqrt(
        1 - (within / (frames * (protocols - 1))) / (overall / (frames * protocols - 1))
    )
    assert agreement(x, y).cmc == pytest.approx(expected)
    assert agreement(x, x).cmc == 1
    assert np.isnan(agreement(x, -x).cmc)


def test_nothing_in_common_is_no_number():
    found = agreement(np.array([1.0, np.nan]), np.array([np.nan, 1.0]))
    assert found.n == 0
    assert np.isnan(found.rmsd)
    one = agreement(np.array([1.0]), np.array([3.0]))
    assert (one.n, one.bias) == (1, 2.0)
    assert np.isnan(one.sd)
    assert np.isnan(agreement(np.ones(9), np.ones(9)).correlation)


def test_the_uncertainty_of_the_bias_covers_the_truth(rng):
    """Of 200 processes with memory, about 95 % have their true mean, 0, inside."""
    inside = 0
    for _ in range(200):
        d = process(rng, 1500, 0.9)
        found = agreement(np.zeros(1500), d)
        inside += abs(found.bias) < found.bias_error
    assert 0.88 < inside / 200 < 0.99
