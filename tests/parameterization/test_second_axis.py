"""A second axis across a hinge: where it lies, and when it is called for."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation

from kinesphere.parameterization.second_axis import cone_spread, second_axis

EXACT = 1e-12  # rounding alone is left


def cone(rng, axis, colatitudes):
    """Return unit vectors at these angles from the axis, at random azimuths."""
    start = np.cross(axis, rng.normal(size=3))
    start /= np.linalg.norm(start)
    tilted = [Rotation.from_rotvec(start * c).apply(axis) for c in colatitudes]
    turns = Rotation.from_rotvec(np.outer(rng.uniform(-2, 2, len(tilted)), axis))
    return turns.apply(tilted)


def test_a_limb_on_its_cone_does_not_leave_it(rng):
    axis = Rotation.random(rng=rng).apply([0.0, 0.0, 1.0])
    assert cone_spread(cone(rng, axis, np.full(17, 1.2)), axis) < 1e-7  # arctan2 near the median


def test_the_spread_is_the_angle_off_the_median_cone(rng):
    axis = Rotation.random(rng=rng).apply([1.0, 0.0, 0.0])
    off = np.array([-0.3, 0.3] * 8 + [0.0])
    assert cone_spread(cone(rng, axis, 1.4 + off), axis) == pytest.approx(
        np.sqrt((off**2).mean()), abs=EXACT
    )
    assert cone_spread(np.empty((0, 3)), axis) == 0.0


def test_the_second_axis_is_across_both_and_on_the_side_asked_for(rng):
    for _ in range(20):
        hinge, limb, side = Rotation.random(3, rng=rng).apply([0.0, 1.0, 0.0])
        axis = second_axis(hinge, limb, side)
        assert_allclose([axis @ hinge, axis @ limb, np.linalg.norm(axis)], [0, 0, 1], atol=EXACT)
        assert axis @ side >= 0
        assert_allclose(second_axis(hinge, limb, -side), -axis, atol=EXACT)
