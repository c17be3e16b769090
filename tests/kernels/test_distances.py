"""Distances between markers and their ways, against a loop a pair."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from kinesphere.kernels.distances import BLOCK, distance_ways_kernel, pair_distances_kernel

EXACT = 1e-13
"""m, sums of hundreds of steps: rounding alone."""
MOST = 0.05


@pytest.fixture
def markers(rng):
    """Return five markers that wander, over more frames than are looked at at a time."""
    markers = rng.normal(scale=0.02, size=(2 * BLOCK + 37, 5, 3)).cumsum(axis=0)
    markers[rng.random(markers.shape[:2]) < 0.1] = np.nan
    return markers


def apart(markers, a, b):
    return np.linalg.norm(markers[:, a] - markers[:, b], axis=1)


def test_each_pair_has_its_distance(markers):
    pairs = np.array([[0, 1], [3, 2], [4, 0]])
    found = np.zeros((len(markers), 3, 2))
    pair_distances_kernel(markers, pairs, found[..., 0])
    for i, (a, b) in enumerate(pairs):
        assert_allclose(found[:, i, 0], apart(markers, a, b), atol=EXACT)
    assert not found[..., 1].any()


@pytest.mark.parametrize("n_frames", [1, 2, BLOCK, BLOCK + 1, BLOCK + 2, 2 * BLOCK + 37])
def test_ways_are_what_distances_change_by(markers, n_frames):
    markers = markers[:n_frames]
    ones, others = np.array([0, 3]), np.array([1, 2, 4])
    ways = np.full(n_frames, 0.25)
    distance_ways_kernel(markers, ones, others, MOST, ways)
    expected = np.full(n_frames, 0.25)
    for a in ones:
        for b in others:
            steps = np.abs(np.diff(apart(markers, a, b)))
            expected[1:] += np.minimum(np.nan_to_num(steps, nan=0.0), MOST)
    assert_allclose(ways, expected, atol=EXACT)
