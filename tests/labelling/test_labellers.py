"""What every labeller must do, and what the default one must do besides."""

from dataclasses import replace

import numba
import numpy as np
import pytest
from numpy.testing import assert_array_equal
from scipy.spatial.transform import Rotation

from kinesphere.errors import BadModel
from kinesphere.geometry.rigid import fit_rigid, out_of_frame
from kinesphere.geometry.signature import signature
from kinesphere.labelling.huang_xia import match_huang_xia
from kinesphere.labelling.pair_statistics import match_pair_statistics
from kinesphere.labelling.plausible import is_still
from kinesphere.labelling.stage import LABELLERS

pytestmark = pytest.mark.skipif(
    bool(numba.config.DISABLE_JIT), reason="a search in plain Python takes minutes"
)

SURE = 0.1  # as the stage asks for by default


@pytest.fixture(params=LABELLERS, ids=str)
def labeller(request):
    return LABELLERS[request.param]


def given(match, least=SURE):
    return np.where(match.confidence >= least, match.labels, -1)


class TestEveryLabeller:
    """Laws that hold for good labellers and bad ones."""

    def test_a_label_is_given_once(self, labeller, legs):
        model, recording = legs
        labels = labeller(recording.markers, model).labels
        some = labels[labels >= 0]
        assert len(some) == len(set(some.tolist())) > 0

    def test_the_order_of_points_changes_nothing_but_the_order(self, labeller, legs, rng):
        model, recording = legs
        if labeller is match_huang_xia:
            pytest.xfail("k-means starts from the order of points; so do the groups it finds")
        order = rng.permutation(recording.n_markers)
        straight = labeller(recording.markers, model).labels
        shuffled = labeller(recording.markers[:, order], model).labels
        assert_array_equal(straight[order], shuffled)

    def test_size_and_place_change_nothing(self, labeller, legs, rng):
        model, recording = legs
        if labeller is match_huang_xia:
            pytest.xfail("the turn about a segment's orientation vector is left as it comes")
        # about the vertical: the similarity tree assumes that people stand
        turn = Rotation.from_rotvec([0, rng.uniform(0.1, 3), 0]).as_matrix()
        moved = 1000 * (recording.markers @ turn.T + rng.normal(size=3))
        assert_array_equal(labeller(recording.markers, model).labels, labeller(moved, model).labels)

    def test_too_few_points_are_refused_with_the_reason(self, labeller, legs):
        model, recording = legs
        match = labeller(recording.markers[:, :3], model)
        assert (match.labels == -1).all()
        assert "3" in match.note

    def test_a_model_without_statistics_is_refused(self, labeller, legs):
        model, recording = legs
        with pytest.raises(BadModel, match="has no statistics"):
            labeller(recording.markers, replace(model, statistics=()))


class TestPairStatistics:
    """The default labels another person, left and right told apart."""

    def test_another_person_is_labelled(self, legs):
        model, recording = legs
        assert_array_equal(
            given(match_pair_statistics(recording.markers, model)), np.arange(recording.n_markers)
        )

    @pytest.mark.parametrize("change", ["turned", "reversed", "thinned"])
    def test_any_axes_any_order_and_half_the_frames_do(self, legs, rng, change):
        model, recording = legs
        points = {
            "turned": recording.markers @ Rotation.random(rng=rng).as_matrix().T,
            "reversed": recording.markers[::-1],
            "thinned": recording.markers[::2],
        }[change]
        assert_array_equal(
            given(match_pair_statistics(points, model)), np.arange(recording.n_markers)
        )

    def test_a_mirror_swaps_left_and_right(self, legs):
        model, recording = legs
        mirrored = recording.markers * np.array([-1.0, 1.0, 1.0])
        names = [model.labels[i] for i in match_pair_statistics(mirrored, model).labels]
        twin = {a: b for pair in model.mirror for a, b in (pair, pair[::-1])}
        assert names == [twin[label] for label in recording.labels]

    def test_what_is_missing_leaves_no_wrong_label(self, legs, rng):
        model, recording = legs
        kept = rng.permutation(recording.n_markers)[1:]
        labels = given(match_pair_statistics(recording.markers[:, kept], model))
        assert (labels == kept).sum() >= len(kept) - 3
        assert ((labels == kept) | (labels < 0)).all()

    def test_ghosts_stay_without_label(self, legs, rng):
        model, recording = legs
        ghosts = np.cumsum(rng.normal(scale=0.02, size=(recording.n_frames, 3, 3)), axis=0)
        points = np.concatenate([ghosts, recording.markers], axis=1)
        labels = given(match_pair_statistics(points, model))
        assert_array_equal(labels[:3], -1)
        assert_array_equal(labels[3:], np.arange(recording.n_markers))

    @pytest.mark.parametrize("n", [5, 9])
    def test_points_that_stay_in_the_room_stay_without_label(self, legs, rng, n):
        model, recording = legs
        props = np.repeat(rng.uniform(-1, 1, (1, n, 3)), recording.n_frames, axis=0)
        found = match_pair_statistics(np.concatenate([recording.markers, props], axis=1), model)
        labels = given(found)
        assert (labels[recording.n_markers :] < 0).all()
        own = labels[: recording.n_markers]
        right = np.array([model.labels.index(name) for name in recording.labels])
        assert ((own == right) | (own < 0)).all()

    @pytest.mark.parametrize("moving", [False, True])
    def test_points_in_one_place_are_refused(self, legs, moving):
        model, recording = legs
        points = np.repeat(recording.markers[:, :1], recording.n_markers, axis=1)
        found = match_pair_statistics(points if moving else np.zeros_like(points), model)
        assert (found.labels < 0).all()
        assert "in one place" in found.note

    def test_one_frame_is_refused(self, legs):
        model, recording = legs
        match = match_pair_statistics(recording.markers[:1], model)
        assert (match.labels == -1).all()
        assert match.note == "one frame alone shows no motion to recognise markers by"

    def test_who_stands_still_is_refused(self, legs):
        model, recording = legs
        still = np.repeat(recording.markers[:1], 50, axis=0)
        match = match_pair_statistics(still, model)
        assert (match.labels == -1).all()
        assert match.note.startswith("nothing moves")

    def test_who_swings_one_leg_alone_moves(self, legs):
        model, recording = legs
        points = np.repeat(recording.markers[:1], 200, axis=0)
        leg = [s for s in model.segments if s.name in ("left_shank", "left_foot")]
        moved = [c for s in leg for c in recording.columns(s.markers)]
        turn = Rotation.from_rotvec(np.outer(0.5 * np.sin(np.arange(200) / 20), [1.0, 0.2, 0.0]))
        knee = points[0, moved].max(axis=0)
        points[:, moved] = knee + np.einsum(
            "tij,kj->tki", turn.as_matrix(), points[0, moved] - knee
        )
        assert not is_still(signature(points))
        assert not match_pair_statistics(points, model).note.startswith("nothing moves")

    def test_points_that_move_like_nobody_are_refused(self, legs, rng):
        model, recording = legs
        walks = np.cumsum(rng.normal(scale=0.02, size=recording.markers.shape), axis=0)
        match = match_pair_statistics(walks, model)
        assert (match.labels == -1).all()
        assert "do not move like those of legs" in match.note or "3" in match.note

    def test_gaps_do_not_matter(self, legs, rng):
        model, recording = legs
        points = recording.markers.copy()
        points[rng.random(points.shape[:2]) < 0.2] = np.nan
        assert_array_equal(
            given(match_pair_statistics(points, model)), np.arange(recording.n_markers)
        )

    def test_a_limb_that_rests_is_still_that_limb(self, legs):
        # steady with everything, as no limb of those who moved was
        model, recording = legs
        markers = recording.markers.copy()
        at = {s.name: list(recording.columns(s.markers)) for s in model.segments}
        rested = [c for x in ("left_thigh", "left_shank", "left_foot") for c in at[x]]
        pelvis = markers[:, at["pelvis"]]
        pose = fit_rigid(pelvis[0], pelvis)
        markers[:, rested] = out_of_frame(pose.rotations, pose.shifts, markers[0, rested])
        labels = given(match_pair_statistics(markers, model))
        wrong = (labels >= 0) & (labels != np.arange(recording.n_markers))
        assert not wrong.any()
        assert (labels >= 0).sum() >= 15
