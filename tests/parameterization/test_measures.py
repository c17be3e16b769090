"""The paper's measures, against angles we put in."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from kinesphere.parameterization.measures import (
    lever,
    mid_point_residuals,
    number,
    paper_measures,
)

SMALL = 1e-3  # rad; the sum of three angles is linear in a small one


@pytest.mark.parametrize("direction", [0.0, 0.4, 1.3])
def test_a_swing_counts_more_than_twice_in_the_summed_deviation(rng, direction):
    long_axis = np.array([0.0, -1.0, 0.0])
    about = np.array([np.cos(direction), 0, np.sin(direction)])
    measured = Rotation.random(5, rng=rng)
    rebuilt = measured * Rotation.from_rotvec(SMALL * about)
    told = paper_measures(
        measured.as_matrix(), rebuilt.as_matrix(), long_axis, np.array([0.0, -0.2, 0.0])
    )
    factor = 1 + abs(np.cos(direction)) + abs(np.sin(direction))
    summed = np.rad2deg(SMALL) * factor
    assert told["twist_deviation_sum_mean_deg"] == pytest.approx(summed, rel=1e-4)
    assert told["twist_deviation_per_axis_mean_deg"] == pytest.approx(summed / 3, rel=1e-4)
    assert told["geodesic_mean_deg"] == pytest.approx(np.rad2deg(SMALL), rel=1e-6)
    assert told["position_deviation_mean_mm"] == pytest.approx(200 * SMALL, rel=1e-6)


def test_half_turns_are_measured_too(rng):
    measured = Rotation.random(4, rng=rng)
    rebuilt = measured * Rotation.from_rotvec([0, 0, np.pi])
    told = paper_measures(measured.as_matrix(), rebuilt.as_matrix(), np.eye(3)[1], np.eye(3)[1])
    assert told["twist_deviation_sum_mean_deg"] == pytest.approx(360.0, abs=1e-5)


def test_nothing_known_is_none():
    unseen = np.full((3, 3, 3), np.nan)
    told = paper_measures(unseen, unseen, np.eye(3)[1], np.eye(3)[1])
    assert set(told.values()) == {None}
    assert number(np.array([np.nan, 2.0, 4.0]), np.mean) == 3.0


def test_the_mid_point_is_where_the_limbs_frame_has_its_origin():
    centre, along = np.array([0.01, 0.2, -0.03]), np.array([0.0, -1.0, 0.0])
    assert (lever(centre, 0.4, along) == -centre).all()
    assert lever(np.zeros(3), 0.4, along) == pytest.approx(0.2 * along)
    assert np.isnan(lever(np.zeros(3), np.nan, along)).any()


def test_residuals_are_distances_of_the_mid_point(rng):
    turns = Rotation.random(4, rng=rng).as_matrix()
    off = np.diag([1.0, -1.0, -1.0])  # a half turn about x
    arm = np.array([0.3, 0.0, 0.1])
    assert mid_point_residuals(turns, turns @ off, arm) == pytest.approx(np.full(4, 0.2))
