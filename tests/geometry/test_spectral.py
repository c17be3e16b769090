"""Spectral clustering, on clusters we made."""

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from kinesphere.geometry.spectral import (
    k_means,
    renumbered,
    self_tuning_affinity,
    spectrum,
)

SIZES = (3, 4, 6, 2)


def blocks(rng, inner=0.001, outer=0.05):
    """Distances within and between clusters of SIZES, and which cluster each point is of."""
    truth = np.repeat(np.arange(len(SIZES)), SIZES)
    same = truth[:, None] == truth[None, :]
    d = np.where(same, inner, outer) * rng.uniform(0.8, 1.2, size=same.shape)
    d = (d + d.T) / 2
    np.fill_diagonal(d, 0.0)
    return d, truth


def clusters(distances, rng, neighbour=1, least=0.0):
    affinity = self_tuning_affinity(distances, neighbour, least)
    assert np.isfinite(affinity).all()
    found = spectrum(affinity)
    k = found.eigengap(2, 10)
    return k_means(found.embedding(k), k, rng)


def test_clusters_of_unequal_size_and_scale_come_out_with_their_number(rng):
    d, truth = blocks(rng)
    d[:3, :3] *= 5  # a looser cluster: the affinity tunes itself
    assert_array_equal(clusters(d, rng), truth)


def test_numbering_points_anew_numbers_clusters_anew_and_no_more(rng):
    d, truth = blocks(rng)
    order = rng.permutation(len(truth))
    assert_array_equal(clusters(d[np.ix_(order, order)], rng), renumbered(truth[order]))


def test_a_unit_does_not_matter(rng):
    d, _ = blocks(rng)
    assert_allclose(self_tuning_affinity(1000 * d), self_tuning_affinity(d), atol=1e-12)


def test_affinity_is_what_the_formula_says(rng):
    d, _ = blocks(rng)
    second = np.sort(d, axis=1)[:, 2]  # the diagonal comes first
    expected = np.exp(-(d[3, 5] ** 2) / (2 * second[3] * second[5]))
    assert 0.2 < expected < 0.8
    assert self_tuning_affinity(d, 2)[3, 5] == pytest.approx(expected)


def test_unknown_pairs_coincident_points_and_loners_are_survived(rng):
    d, truth = blocks(rng)
    d[0, 1] = d[1, 0] = 0.0  # copies of one marker
    d[3, 4] = d[4, 3] = np.nan  # never seen together, yet held by the others
    d = np.pad(d, (0, 1), constant_values=np.nan)  # a point never seen with any other
    found = clusters(d, rng, least=0.0005)
    assert_array_equal(found, [*truth, len(SIZES)])


def test_values_count_the_parts_that_nothing_connects():
    affinity = np.kron(np.eye(3), 1 - np.eye(4))
    found = spectrum(affinity)
    assert_allclose(found.values[:3], 1.0)
    assert found.values[3] < 0.5
    assert found.eigengap(2, 25) == 3


def test_k_means_is_the_same_for_the_same_generator(rng):
    points = rng.normal(size=(40, 3))
    first = k_means(points, 7, np.random.default_rng(5))
    assert_array_equal(first, k_means(points, 7, np.random.default_rng(5)))
    assert len(set(first.tolist())) == 7


def test_k_means_refuses_more_clusters_than_points(rng):
    with pytest.raises(ValueError, match="3 points cannot make 4"):
        k_means(rng.normal(size=(3, 2)), 4, rng)
