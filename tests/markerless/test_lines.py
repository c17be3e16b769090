"""Correspondence lines: where the edge is, and when nothing can be told."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from kinesphere.markerless.kernels.lines import (
    REACH,
    SAMPLES,
    SEARCH,
    mask_samples_kernel,
    offsets_kernel,
    open_line_kernel,
)

OFFSETS = np.arange(-SEARCH, SEARCH + 1)


def offsets(probabilities, steepness=1.0, trust=0.43):
    n = len(probabilities)
    out = np.empty(n), np.empty(n), np.empty(n)
    offsets_kernel(np.ascontiguousarray(probabilities), steepness, trust, *out)
    return out


def naive(probabilities, steepness, trust):
    means, variances = [], []
    at = np.arange(SAMPLES) - REACH
    for f in probabilities:
        logs = []
        for d in OFFSETS:
            h = 0.5 - trust * np.tanh((at - d) / steepness)
            logs.append(np.log(h * f + (1 - h) * (1 - f)).sum())
        p = np.exp(np.array(logs) - max(logs))
        p /= p.sum()
        means.append(p @ OFFSETS)
        variances.append(p @ (OFFSETS - means[-1]) ** 2)
    return np.array(means), np.array(variances)


def test_the_posterior_is_that_of_its_naive_twin(rng):
    probabilities = rng.uniform(0.02, 0.98, (9, SAMPLES))
    means, variances, _ = offsets(probabilities, 1.3, 0.4)
    assert_allclose(means, naive(probabilities, 1.3, 0.4)[0], atol=1e-10)
    assert_allclose(variances, naive(probabilities, 1.3, 0.4)[1], atol=1e-10)


@pytest.mark.parametrize("edge", [-4, -1, 0, 3])
def test_a_clean_edge_is_found(edge):
    at = np.arange(SAMPLES) - REACH
    f = np.where(at < edge, 0.98, np.where(at > edge, 0.02, 0.5))[None]
    means, variances, agreement = offsets(f)
    assert means[0] == pytest.approx(edge, abs=0.15)  # less near the end of what is searched
    assert variances[0] < 0.15 * (OFFSETS**2).mean()  # of a line that says nothing
    # where the edge lies inward of the rim, what should be the person's is not, and the reverse
    assert (agreement[0] > 0.95) == (abs(edge) <= 1)


def test_a_line_that_says_nothing_moves_nothing():
    means, variances, agreement = offsets(np.full((1, SAMPLES), 0.5))
    assert means[0] == pytest.approx(0, abs=1e-12)
    assert variances[0] == pytest.approx((OFFSETS**2).mean())
    assert np.isnan(agreement[0])


def test_inside_and_outside_exchanged_mirror_the_offset(rng):
    f = rng.uniform(0.1, 0.9, (5, SAMPLES))
    there = offsets(f)[0]
    back = offsets(1 - f[:, ::-1])[0]
    assert_allclose(back, -there, atol=1e-10)


def line_uses(parts, own, beyond, pixel, normal, near=None):
    near = np.eye(3, dtype=bool) if near is None else near
    use = np.empty((1, SAMPLES), dtype=np.int8)
    open_line_kernel(
        np.array([pixel], float),
        np.array([normal], float),
        np.array([[own, beyond]], dtype=np.int32),
        parts,
        near,
        1.0,
        use,
    )
    return use[0].astype(bool)


def test_a_line_ends_where_another_limb_begins():
    parts = np.full((5, 40), -1, dtype=np.int32)
    parts[:, 10:20] = 0  # the limb; its rim is at column 19.3
    parts[:, 24:30] = 1  # another beside it
    use = line_uses(parts, 0, -1, (19.3, 2), (1, 0))
    at = np.arange(SAMPLES) - REACH
    assert use[at <= 4].all()
    assert not use[at > 4].any()
    # seen as what lies beyond, the other limb is the background, and the background is not
    assert not line_uses(parts, 0, 1, (19.3, 2), (1, 0))[at >= 2].any()


def test_a_line_through_the_limb_ends_on_its_other_side_and_goes_on_into_a_joined_one():
    parts = np.full((5, 40), -1, dtype=np.int32)
    parts[:, 17:20] = 0
    at = np.arange(SAMPLES) - REACH
    assert not line_uses(parts, 0, -1, (19.3, 2), (1, 0))[at <= -4].any()
    parts[:, 10:17] = 2
    near = np.eye(3, dtype=bool)
    assert not line_uses(parts, 0, -1, (19.3, 2), (1, 0), near)[at <= -4].any()
    near[0, 2] = True
    assert line_uses(parts, 0, -1, (19.3, 2), (1, 0), near)[at <= 0].all()


def test_a_line_out_of_the_image_says_nothing_there():
    parts = np.zeros((5, 22), dtype=np.int32)
    use = line_uses(parts, 0, -1, (19.3, 2), (1, 0))
    assert not use[np.arange(SAMPLES) - REACH > 2].any()


def test_mask_samples_follow_the_mask_between_pixels():
    level = np.zeros((6, 50), dtype=np.uint8)
    level[:, :20] = 255
    out = np.empty((1, SAMPLES))
    use = np.ones((1, SAMPLES), dtype=np.int8)
    use[0, 0] = 0
    pixel, normal = np.array([[19.5, 3.0]]), np.array([[1.0, 0.0]])
    mask_samples_kernel(pixel, normal, use, level, 1.0, 1.0, out)
    assert out[0, 0] == 0.5
    assert_allclose(out[0, 1:REACH], 0.98)
    assert out[0, REACH] == pytest.approx(0.5)
    assert_allclose(out[0, REACH + 1 :], 0.02)
