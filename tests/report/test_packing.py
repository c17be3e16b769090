"""Packed arrays come back within half a step."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose, assert_array_equal

from kinesphere.report.packing import pack, unpack

ROUNDING = 1e-12  # float64 on numbers of size one


def walk(rng, n_frames=157, n_series=(4, 3)):
    """Something that moves smoothly, with gaps."""
    values = np.cumsum(rng.normal(scale=0.01, size=(n_frames, *n_series)), axis=0)
    values[rng.random(values.shape) < 0.1] = np.nan
    return values


def test_values_come_back_within_half_a_step(rng):
    values = walk(rng)
    packed = pack(values, 1e-4)
    back = unpack(packed)
    assert back.shape == values.shape
    assert packed["step"] == 1e-4
    assert_array_equal(np.isnan(back), np.isnan(values))
    assert np.nanmax(np.abs(back - values)) <= 0.5 * packed["step"] + ROUNDING


def test_a_wide_range_makes_the_step_coarser_not_wrong(rng):
    values = walk(rng) * 1e5
    packed = pack(values, 1e-4)
    assert packed["step"] > 1e-4
    off = np.nanmax(np.abs(unpack(packed) - values))
    assert off <= 0.5 * packed["step"] * (1 + 1e-6)


@given(
    low=st.floats(-1e6, 1e6),
    spread=st.floats(0, 1e6),
    step=st.floats(1e-6, 1e3),
    seed=st.integers(0, 2**32 - 1),
)
@settings(deadline=None, max_examples=60)
def test_any_range_and_step_keep_the_promise(low, spread, step, seed):
    values = low + spread * np.random.default_rng(seed).random((7, 2))
    values[3, 1] = np.nan
    packed = pack(values, step)
    back = unpack(packed)
    assert_array_equal(np.isnan(back), np.isnan(values))
    assert_allclose(back, values, rtol=1e-9, atol=0.5 * packed["step"] * (1 + 1e-6))


@pytest.mark.parametrize("shape", [(0, 4, 3), (5, 0, 3), (1, 2), (5, 0)])
def test_nothing_and_nearly_nothing(shape):
    assert unpack(pack(np.zeros(shape), 0.1)).shape == shape


def test_never_seen_comes_back_as_never_seen():
    assert np.isnan(unpack(pack(np.full((6, 2, 3), np.nan), 0.1))).all()


def test_smooth_motion_packs_small(rng):
    times = np.linspace(0, 60, 3600)[:, None]
    values = np.sin(times * rng.uniform(1, 6, 150) + rng.uniform(0, 6, 150))
    packed = pack(values, 1e-4)
    assert len(packed["data"]) < 0.25 * values.size * 8
