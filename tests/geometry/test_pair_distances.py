"""Distances over time, against a naive twin and against motions that cannot change them."""

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from scipy.spatial.transform import Rotation

from kinesphere.geometry.pair_distances import (
    pair_distances,
    pair_distances_by_columns,
    pair_distances_kernel,
)

FRAMES, POINTS = 60, 7
EXACT = 1e-12  # rounding on coordinates of about a metre


def walk(rng, gaps=0.0):
    points = rng.normal(size=(FRAMES, POINTS, 3))
    points[rng.random((FRAMES, POINTS)) < gaps] = np.nan
    return points


def naive(points, i, j, trim):
    d = np.linalg.norm(points[:, i] - points[:, j], axis=1)
    d = np.sort(d[np.isfinite(d)])
    kept = d[int(trim * len(d)) : len(d) - int(trim * len(d))]
    return d.mean(), d.std(), kept.std(), len(d)


@pytest.mark.parametrize("trim", [0.0, 0.05, 0.2])
def test_every_pair_is_what_a_loop_makes_of_the_frames_that_show_both(rng, trim):
    points = walk(rng, gaps=0.2)
    found = pair_distances(points, trim=trim)
    for i in range(POINTS):
        for j in range(POINTS):
            mean, std, trimmed, count = naive(points, i, j, trim)
            assert found.mean[i, j] == pytest.approx(mean, abs=EXACT)
            assert found.std[i, j] == pytest.approx(std, abs=EXACT)
            assert found.trimmed_std[i, j] == pytest.approx(trimmed, abs=EXACT)
            assert found.frames[i, j] == count


@pytest.mark.parametrize("measure", [pair_distances_kernel, pair_distances_by_columns])
def test_either_way_of_measuring_gives_the_same(rng, measure):
    points = walk(rng, gaps=0.3)
    points[:, 5] = np.nan
    found = np.full((3, POINTS, POINTS), np.nan)
    count = np.zeros((POINTS, POINTS), dtype=np.int64)
    by_point = np.ascontiguousarray(np.moveaxis(points, 1, 0))
    measure(by_point, 0.05, *found, count)
    for a, b in zip((*found, count), pair_distances(points), strict=True):
        assert_allclose(a, b, atol=EXACT)


def test_moving_the_scene_turning_time_and_naming_anew_change_nothing_else(rng):
    points = walk(rng, gaps=0.1)
    plain = pair_distances(points)
    turns = Rotation.random(FRAMES, rng=rng).as_matrix()
    moved = np.einsum("fij,fmj->fmi", turns, points) + rng.normal(size=(FRAMES, 1, 3))
    for other in (pair_distances(moved), pair_distances(points[::-1])):
        for a, b in zip(plain, other, strict=True):
            assert_allclose(a, b, atol=1e-11)
    order = rng.permutation(POINTS)
    for a, b in zip(plain, pair_distances(points[:, order]), strict=True):
        assert_array_equal(a[np.ix_(order, order)], b)
    grown = pair_distances(3.0 * points)
    assert_allclose(grown.trimmed_std, 3.0 * plain.trimmed_std, atol=EXACT)


def test_a_rigid_pair_is_steady_through_a_short_swap_only_when_trimmed(rng):
    points = np.cumsum(rng.normal(scale=0.01, size=(FRAMES, POINTS, 3)), axis=0)
    points[:, 1] = points[:, 0] + [0.1, 0.0, 0.0]
    points[7:9, 1] += 0.5
    found = pair_distances(points)
    assert found.std[0, 1] > 0.05
    assert found.trimmed_std[0, 1] < EXACT


def test_points_never_seen_together_are_unknown_to_each_other_alone(rng):
    points = walk(rng)
    points[:30, 2] = np.nan
    points[30:, 4] = np.nan
    points[:, 5] = np.nan
    found = pair_distances(points)
    unknown = np.zeros((POINTS, POINTS), dtype=bool)
    unknown[2, 4] = unknown[4, 2] = unknown[5] = unknown[:, 5] = True
    assert_array_equal(np.isnan(found.mean), unknown)
    assert_array_equal(np.isnan(found.trimmed_std), unknown)
    assert_array_equal(found.frames == 0, unknown)


def test_no_frames_and_no_points_are_no_accident():
    assert np.isnan(pair_distances(np.empty((0, 4, 3))).mean).all()
    assert pair_distances(np.empty((9, 0, 3))).frames.shape == (0, 0)


def test_misplaced_axes_and_trims_are_named(rng):
    with pytest.raises(ValueError, match=r"got \(3, 60, 7\)"):
        pair_distances(np.moveaxis(walk(rng), 2, 0))
    with pytest.raises(ValueError, match=r"trim is 0\.5"):
        pair_distances(walk(rng), trim=0.5)
