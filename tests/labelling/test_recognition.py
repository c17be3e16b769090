"""The body in windows, windows that agree, and several bodies in one volume."""

import numba
import numpy as np
import pytest
from numpy.testing import assert_array_equal

from kinesphere.labelling.bodies import bodies_of
from kinesphere.labelling.labelled import Labelled
from kinesphere.labelling.matching import Match, nothing
from kinesphere.labelling.pair_statistics import match_pair_statistics
from kinesphere.labelling.recognition import _agreed, _Seen, recognised, windows_of
from kinesphere.labelling.runs import Run

N_LABELS = 6

compiled = pytest.mark.skipif(
    bool(numba.config.DISABLE_JIT), reason="a search in plain Python takes minutes"
)


def seen(columns, labels, confidence, worth=1.0):
    match = Match(np.array(labels), np.array(confidence, dtype=float), 2.0)
    return _Seen(worth, match, columns, (worth, worth + 4))


def agreed(*windows):
    """Return (track → (label, confidence) of those that have one, the windows used)."""
    tracks = [(Run(k, 0, 10),) for k in range(9)]
    state = Labelled(np.full((10, N_LABELS, 3), np.nan), tracks, [-1] * 9, [0.0] * 9)
    match, columns = _agreed(list(windows), state, N_LABELS)
    given = zip(columns, match.labels.tolist(), match.confidence.tolist(), strict=True)
    return {k: (label, c) for k, label, c in given if label >= 0}, len(state.windows_s)


def test_where_every_window_is_refused_the_reason_is_said(legs):
    model, recording = legs
    half = recording.n_frames // 2
    tracks = [
        (Run(k, a, b),)
        for k in range(recording.n_markers)
        for a, b in ((0, half), (half, recording.n_frames))
    ]
    n = len(tracks)
    state = Labelled(np.full((recording.n_frames, n, 3), np.nan), tracks, [-1] * n, [0.0] * n)

    def refused(points, _):
        return nothing(points.shape[1], "for a reason")

    match, columns = recognised(recording.markers, recording.rate, state, model, refused, 0.1)
    assert match.note == "for a reason"
    assert columns == []


class TestAgreement:
    def test_one_window_is_believed_as_it_is(self):
        found, used = agreed(seen([0, 2, 3], [4, 1, -1], [0.5, 0.2, 0.0]))
        assert used == 1
        assert found == {0: (4, pytest.approx(0.5)), 2: (1, pytest.approx(0.2))}

    def test_doubts_of_windows_that_agree_multiply(self):
        found, used = agreed(
            seen([0, 1, 2], [0, 1, 2], [0.5, 0.5, 0.5], 2.0),
            seen([0, 1, 2], [0, 1, 2], [0.5, 0.8, 0.0]),
        )
        assert used == 2
        assert [c for _, c in found.values()] == pytest.approx([0.75, 0.9, 0.5])

    def test_the_order_in_which_windows_come_changes_nothing(self):
        windows = [
            seen([0, 1, 2], [0, 1, 2], [0.5, 0.6, 0.7], 2.0),
            seen([0, 1, 3], [0, 1, 3], [0.5, 0.8, 0.9]),
        ]
        assert agreed(*windows) == agreed(*windows[::-1])

    def test_a_window_that_says_otherwise_is_not_heard(self):
        found, used = agreed(
            seen([0, 1, 2], [0, 1, 2], [0.5, 0.5, 0.5], 2.0),
            seen([0, 1, 3], [1, 0, 3], [0.9, 0.9, 0.9]),
        )
        assert used == 1
        assert [(k, label) for k, (label, _) in found.items()] == [(0, 0), (1, 1), (2, 2)]

    def test_a_window_that_shares_nothing_is_not_heard(self):
        _, used = agreed(seen([0, 1], [0, 1], [0.5, 0.5], 2.0), seen([2, 3], [2, 3], [0.9, 0.9]))
        assert used == 1

    @pytest.mark.parametrize(("sure", "given"), [(0.45, False), (0.55, True)])
    def test_what_the_best_window_does_not_show_needs_more(self, sure, given):
        found, used = agreed(
            seen([0, 1, 2], [0, 1, 2], [0.3, 0.3, 0.3], 2.0),
            seen([0, 1, 2, 3], [0, 1, 2, 3], [0.3, 0.3, 0.3, sure]),
        )
        assert used == 2
        assert (3 in found) == given


def test_windows_show_long_tracks_and_overlap_by_half_at_most():
    rate, n = 10.0, 400
    tracks = [(Run(k, 0, n),) for k in range(5)]
    tracks += [(Run(9, 30, 33),)]
    windows = windows_of(tracks, n, rate, 5)
    assert windows
    for start, end, columns in windows:
        assert columns == [0, 1, 2, 3, 4]
        for a, b, _ in windows:
            assert (a, b) == (start, end) or min(end, b) - max(start, a) <= (end - start) // 2 + 1


class TestBodies:
    @pytest.fixture
    def pair(self, legs):
        """Return two people side by side who walk apart, 18 points each."""
        markers = legs[1].markers[:400]
        away = np.linspace(1, 3, 200)[:, None, None] * np.array([1.0, 0.2, 0.0])
        return np.concatenate([markers[:200], markers[200:400] + away], axis=1)

    def test_two_people_are_two(self, pair):
        one, other = bodies_of(pair, 18)
        assert_array_equal(one, np.arange(18))
        assert_array_equal(other, np.arange(18, 36))

    def test_the_order_of_points_changes_nothing(self, pair, rng):
        order = rng.permutation(36)
        found = {frozenset(order[body].tolist()) for body in bodies_of(pair[:, order], 18)}
        assert found == {frozenset(range(18)), frozenset(range(18, 36))}

    def test_one_person_and_ghosts_are_not_several(self, legs, rng):
        body = legs[1].markers[:200]
        assert bodies_of(body, 18) == []
        ghosts = np.cumsum(rng.normal(scale=0.05, size=(200, 25, 3)), axis=0)
        assert bodies_of(np.concatenate([body, ghosts], axis=1), 18) == []

    def test_a_body_is_not_two_legs(self, legs):
        assert bodies_of(legs[1].markers[:800], 10) == []

    @compiled
    def test_labels_go_to_one_of_two(self, legs, rng):
        model, recording = legs
        half = recording.n_frames // 2
        other = recording.markers[half : 2 * half] * 1.1
        other = other + np.linspace(1, 4, half)[:, None, None] * np.array([1.0, 0.2, 0.0])
        points = np.concatenate([recording.markers[:half], other], axis=1)
        order = rng.permutation(36)
        match = match_pair_statistics(points[:, order], model)
        assert match.bodies == 2
        given = match.labels >= 0
        assert len(set((order[given] // 18).tolist())) == 1
        assert given.sum() >= 16
        assert_array_equal(match.labels[given], order[given] % 18)
