"""Labels by the person's own distances: wrong ones found, what is left recognised together."""

import numba
import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from kinesphere.labelling.labelled import Labelled, give
from kinesphere.labelling.own_distances import measured_anew, own_distances
from kinesphere.labelling.personal import personal_template, recognise_rest
from kinesphere.labelling.propagation import propagate
from kinesphere.labelling.recheck import recheck
from kinesphere.labelling.runs import Run
from kinesphere.labelling.template import of_one_segment, template_of

compiled = pytest.mark.skipif(
    bool(numba.config.DISABLE_JIT), reason="a search in plain Python takes minutes"
)
N, CUT = 300, 150


def labelled(markers, tracks, labels):
    """Return work in progress in which these tracks bear these labels."""
    n = max(labels) + 1
    state = Labelled(
        np.full((len(markers), n, 3), np.nan), list(tracks), [-1] * len(tracks), [0.0] * len(tracks)
    )
    for k, label in enumerate(labels):
        if label >= 0:
            give(state, markers, k, label, 1.0)
    return state


@pytest.fixture
def markers(legs):
    return legs[1].markers[:N].copy()


class TestRecheck:
    @pytest.fixture
    def confused(self, markers):
        """Return work in which the later half of marker 7 bears label 8, whose own is unseen."""
        n = markers.shape[1]
        markers[CUT:, 8] = np.nan
        tracks = [(Run(i, 0, N),) for i in range(n) if i not in (7, 8)]
        right = [i for i in range(n) if i not in (7, 8)]
        tracks += [(Run(7, 0, CUT),), (Run(7, CUT, N),), (Run(8, 0, CUT),)]
        return markers, tracks, [*right, 7, 8, 8], len(right) + 1

    def test_a_label_that_only_its_bearer_believes_in_is_changed(self, confused):
        markers, tracks, labels, wrong = confused
        state = labelled(markers, tracks, labels)
        assert recheck(state, markers, set()) == 1
        assert state.labels == [7 if k == wrong else label for k, label in enumerate(labels)]
        assert_array_equal(state.points[:, 7], markers[:, 7])
        assert_array_equal(state.points[:, 8], markers[:, 8])

    def test_what_a_person_gave_stays(self, confused):
        markers, tracks, labels, wrong = confused
        state = labelled(markers, tracks, labels)
        assert recheck(state, markers, {wrong}) == 0
        assert state.labels == labels

    def test_right_labels_stay(self, markers):
        n = markers.shape[1]
        tracks = [(Run(i, a, b),) for i in range(n) for a, b in ((0, CUT), (CUT, N))]
        labels = [i for i in range(n) for _ in range(2)]
        state = labelled(markers, tracks, labels)
        assert recheck(state, markers, set()) == 0
        assert_array_equal(state.points, markers)


def test_a_label_measured_anew_is_as_if_all_were(markers):
    own = own_distances(markers)
    without = markers.copy()
    without[CUT:, 5] = np.nan
    anew, all_anew = measured_anew(own, without, 5), own_distances(without)
    assert_allclose(anew.mean, all_anew.mean)
    assert_allclose(anew.deviation, all_anew.deviation)


@pytest.mark.parametrize("known", [True, False])
def test_loose_fits_wait_while_a_label_of_the_segment_is_unknown(legs, known):
    model, recording = legs
    markers = recording.markers[:N].copy()
    toe, side = model.labels.index("LTOE"), model.labels.index("LMT5")
    # skin that slips by a centimetre: no stranger, but no close fit either
    markers[CUT:, side] += 0.01 * np.array([0.0, 1.0, 0.0])
    markers[CUT:, toe] = np.nan
    if not known:
        markers[:, toe] = np.nan
    tracks = [(Run(i, 0, N),) for i in range(18) if i not in (toe, side)]
    tracks += [(Run(side, 0, CUT),), (Run(toe, 0, CUT),), (Run(side, CUT, N),)]
    right = [track[0].column for track in tracks]
    right[-2] = toe if known else -1
    state = labelled(markers, tracks, [*right[:-1], -1])
    kin = of_one_segment(model, model.labels)
    propagate(state, markers, recording.rate, set(), kin, late=True)
    assert state.labels[-1] == (side if known else -1)


class TestRest:
    def test_a_person_knows_their_own_distances_and_the_model_the_rest(self, legs, markers):
        template = template_of(legs[0])
        markers[:, 4] = np.nan
        personal, scale = personal_template(template, markers)
        known = np.ones((18, 18), dtype=bool)
        known[4] = known[:, 4] = False
        np.fill_diagonal(known, False)
        mean = own_distances(markers).mean
        assert_allclose(personal.mean[known] * scale, mean[known])
        assert (personal.variance[known] < template.variance[known]).mean() > 0.9
        assert_array_equal(personal.mean[4], template.mean[4])
        assert scale == pytest.approx(template.size, rel=0.3)

    def test_of_a_person_nothing_is_known_of_the_template_is_left(self, legs, markers):
        template = template_of(legs[0])
        assert personal_template(template, np.full_like(markers, np.nan)) == (
            template,
            template.size,
        )

    @compiled
    def test_a_shank_and_foot_that_come_into_view_together(self, legs, rng):
        model, recording = legs
        markers = recording.markers[:1350]
        limb = {
            x for s in model.segments if s.name in ("left_shank", "left_foot") for x in s.markers
        }
        loose = [i for i, x in enumerate(model.labels) if x in limb]
        cut, n = 1200, 1350
        tracks = [(Run(i, 0, cut if i in loose else n),) for i in range(18)]
        tracks += [(Run(i, cut, n),) for i in rng.permutation(loose)]
        state = labelled(markers, tracks, list(range(18)))
        assert recognise_rest(state, markers, recording.rate, model, 0.1)
        later = [(track[0].column, of) for track, of in zip(tracks, state.labels, strict=True)][18:]
        assert all(of in (-1, column) for column, of in later)
        assert sum(of >= 0 for _, of in later) >= len(loose) - 1

    @compiled
    def test_beside_labels_that_contradict_nothing_is_given(self, legs):
        model, recording = legs
        at = model.labels.index
        one, other, loose, cut, n = at("LTOE"), at("RTOE"), at("LTHI"), 1200, 1350
        early = [(Run(i, 0, cut if i in (one, other, loose) else n),) for i in range(18)]
        later = [(Run(i, cut, n),) for i in (one, other, loose)]
        for labels, given in (([one, other], True), ([other, one], False)):
            state = labelled(recording.markers[:n], [*early, *later], [*range(18), *labels, -1])
            found = recognise_rest(state, recording.markers[:n], recording.rate, model, 0.1)
            assert found == given
            assert state.labels[-1] == (loose if given else -1)

    @compiled
    def test_a_point_that_hangs_from_the_body_is_no_marker(self, legs):
        model, recording = legs
        markers = recording.markers[:1350]
        thigh, hip, cut = model.labels.index("LTHI"), model.labels.index("LFWT"), 1200
        # a wallet where the thigh's marker might be
        point = markers[:, hip] + (markers[0, thigh] - markers[0, hip]) * 0.8
        markers = np.concatenate([markers, point[:, None]], axis=1)
        tracks = [(Run(i, 0, cut if i == thigh else 1350),) for i in range(18)]
        state = labelled(markers[:, :], [*tracks, (Run(18, cut, 1350),)], [*range(18), -1])
        assert not recognise_rest(state, markers, recording.rate, model, 0.1)

    @compiled
    def test_what_is_left_of_no_marker_stays_so(self, legs, rng):
        model, recording = legs
        ghost = np.cumsum(rng.normal(scale=0.05, size=(500, 1, 3)), axis=0)
        markers = np.concatenate([recording.markers[:500], ghost], axis=1)
        tracks = [(Run(i, 0, 250 if i == 3 else 500),) for i in range(19)]
        state = labelled(markers, tracks, [*range(18), -1])
        assert not recognise_rest(state, markers, recording.rate, model, 0.1)
        assert state.labels == [*range(18), -1]


def test_labels_of_one_segment_are_kin(legs):
    model = legs[0]
    kin = of_one_segment(model, model.labels)
    at = model.labels.index
    assert_array_equal(kin, kin.T)
    assert kin.diagonal().all()
    assert kin[at("LANK"), at("LTOE")]
    assert kin[at("LKNE"), at("LANK")]
    assert not kin[at("LKNE"), at("LTOE")]
    assert not kin[at("LANK"), at("RANK")]
