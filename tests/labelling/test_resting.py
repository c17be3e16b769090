"""What rests in the room while others move: props, and feet that stand."""

import numba
import numpy as np
import pytest
from numpy.testing import assert_array_equal

from kinesphere.labelling.layout import layout_of
from kinesphere.labelling.pair_statistics import match_pair_statistics
from kinesphere.labelling.resting import accompanied, resting

compiled = pytest.mark.skipif(
    bool(numba.config.DISABLE_JIT), reason="a search in plain Python takes minutes"
)
JITTER = 0.0003
"""m, of a point at rest."""


def with_props(points, places, rng):
    """Return points with some that rest at these places appended."""
    rest = places[None] + JITTER * rng.normal(size=(len(points), *places.shape))
    return np.concatenate([points, rest], axis=1)


class TestResting:
    def test_props_rest_and_legs_do_not(self, legs, rng):
        points = legs[1].markers[-400:]
        rests = resting(with_props(points, rng.normal(size=(6, 3)), rng))
        assert_array_equal(np.flatnonzero(rests), points.shape[1] + np.arange(6))

    def test_where_nothing_moves_nothing_rests_beside_others(self, legs, rng):
        still = np.repeat(legs[1].markers[:1], 100, axis=0)
        assert not resting(still).any()
        assert not resting(still + JITTER * rng.normal(size=still.shape)).any()

    def test_what_is_seen_once_or_never_does_not_rest(self, legs):
        points = legs[1].markers[:100].copy()
        points[:, 0] = np.nan
        points[1:, 1] = np.nan
        assert not resting(points).any()


@compiled
class TestProps:
    @pytest.mark.parametrize("reach", [0.4, 3.0])
    def test_props_near_and_far_change_no_label(self, legs, rng, reach):
        model, recording = legs
        points = recording.markers
        places = points.mean(axis=(0, 1)) + reach * rng.normal(size=(7, 3))
        alone = match_pair_statistics(points, model)
        beside = match_pair_statistics(with_props(points, places, rng), model)
        n = points.shape[1]
        assert_array_equal(beside.labels[:n], alone.labels)
        assert_array_equal(beside.labels[n:], -1)
        assert (alone.labels == np.arange(n)).sum() > n / 2

    def test_feet_set_aside_come_in_where_the_body_lacks_them(self, legs, monkeypatch):
        model, recording = legs
        points = recording.markers
        of_feet = [model.labels.index(s + x) for s in "LR" for x in ("ANK", "HEE", "TOE", "MT5")]
        feet = points[0, of_feet, 0]
        monkeypatch.setattr(
            "kinesphere.labelling.resting.resting", lambda some: np.isin(some[0, :, 0], feet)
        )
        match = match_pair_statistics(points, model)
        given = match.labels >= 0
        assert_array_equal(match.labels[given], np.flatnonzero(given))
        assert given[of_feet].sum() >= 6

    def test_a_prop_does_not_take_a_missing_markers_place(self, legs, rng):
        model, recording = legs
        toe = model.labels.index("LTOE")
        points = recording.markers.copy()
        place = points[:, toe].mean(axis=0)
        points[:, toe] = np.nan
        match = match_pair_statistics(with_props(points, place[None], rng), model)
        assert match.labels[-1] == -1


def test_a_point_that_rests_bears_a_label_only_beside_others_that_do(legs, rng):
    model, recording = legs
    near = layout_of(model).near
    n = recording.n_markers
    points = recording.markers[-300:].copy()
    label = 5
    points[:, label] = points[0, label] + JITTER * rng.normal(size=(300, 3))
    labels = np.arange(n)
    assert_array_equal(np.flatnonzero(~accompanied(points, labels, near)), [label])
    company = near[label, 1:3]
    points[:, company] = points[:1, company] + JITTER * rng.normal(size=(300, 2, 3))
    assert accompanied(points, labels, near)[label]
    labels[label] = -1
    assert accompanied(points, labels, near)[label]
