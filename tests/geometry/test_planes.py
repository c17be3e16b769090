"""Planes and rectangles, against ones we placed ourselves."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation

from kinesphere.geometry.planes import fit_planes, smallest_rectangles

EXACT = 1e-9
FRAMES, POINTS = 5, 8


def slabs(rng, thickness=0.0):
    """Return points near known planes, (FRAMES, POINTS, 3), and the planes' frames."""
    frames = Rotation.random(FRAMES, rng=rng).as_matrix()
    flat = rng.normal(size=(FRAMES, POINTS, 3)) * [3.0, 1.0, thickness]
    return np.einsum("fij,fpj->fpi", frames, flat) + rng.normal(size=(FRAMES, 1, 3)), frames


def test_flat_points_give_their_plane(rng):
    points, frames = slabs(rng)
    centres, axes, variances = fit_planes(points)
    assert_allclose(centres, points.mean(axis=1), atol=EXACT)
    assert_allclose(np.abs((axes[:, :, 2] * frames[:, :, 2]).sum(axis=1)), 1.0, atol=EXACT)
    assert_allclose(variances[:, 2], 0.0, atol=EXACT)
    assert (np.diff(variances, axis=1) <= 0).all()


def test_the_last_variance_is_the_mean_squared_distance(rng):
    points, _ = slabs(rng, thickness=0.3)
    centres, axes, variances = fit_planes(points)
    distance = np.einsum("fpi,fi->fp", points - centres[:, None], axes[:, :, 2])
    assert_allclose((distance**2).mean(axis=1), variances[:, 2], atol=EXACT)


def test_points_unseen_are_left_out(rng):
    points, _ = slabs(rng, thickness=0.3)
    fewer = points.copy()
    fewer[:, 2] = np.nan
    for found, wanted in zip(
        fit_planes(fewer), fit_planes(np.delete(points, 2, axis=1)), strict=True
    ):
        assert_allclose(np.abs(found), np.abs(wanted), atol=EXACT)
    fewer[1, 2:] = np.nan
    centres, axes, variances = fit_planes(fewer)
    assert np.isnan(centres[1]).all()
    assert np.isnan(axes[1]).all()
    assert np.isnan(variances[1]).all()
    assert np.isfinite(axes[[0, 2, 3, 4]]).all()


@given(seed=st.integers(0, 2**32 - 1))
@settings(deadline=None, max_examples=30)
def test_no_turn_makes_the_rectangle_smaller(seed):
    rng = np.random.default_rng(seed)
    points = rng.normal(size=(1, POINTS, 2)) * [rng.uniform(0.2, 3), 1.0]
    short, long, direction = smallest_rectangles(points)
    angles = np.linspace(0, np.pi, 721)
    ways = np.stack([np.cos(angles), np.sin(angles)], axis=1)
    across = np.stack([-np.sin(angles), np.cos(angles)], axis=1)
    areas = np.ptp(points[0] @ ways.T, axis=0) * np.ptp(points[0] @ across.T, axis=0)
    assert short[0] * long[0] <= areas.min() + EXACT
    assert short[0] <= long[0]
    assert np.ptp(points[0] @ direction[0]) == pytest.approx(long[0])


def test_a_known_rectangle_is_found(rng):
    corners = np.array([[0, 0], [2, 0], [2, 5], [0, 5], [1, 1]], float)
    turn = Rotation.from_rotvec([0, 0, 0.7]).as_matrix()[:2, :2]
    points = np.stack([corners @ turn.T, corners + 3, corners])
    points[2, 2] = np.nan
    short, long, direction = smallest_rectangles(points)
    assert_allclose(short[:2], 2.0, atol=EXACT)
    assert_allclose(long[:2], 5.0, atol=EXACT)
    assert_allclose(np.abs(direction[0] @ turn), [0.0, 1.0], atol=EXACT)
    assert np.isfinite(short[2])


def test_fewer_than_two_points_have_no_rectangle():
    points = np.full((2, 3, 2), np.nan)
    points[0, 1] = 1.0
    short, long, direction = smallest_rectangles(points)
    assert np.isnan(short).all()
    assert np.isnan(long).all()
    assert np.isnan(direction).all()
