"""The parts labellers are made of, against naive twins and known answers."""

from dataclasses import replace
from itertools import combinations

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from scipy.spatial.transform import Rotation

from kinesphere.errors import BadModel, BadRecording
from kinesphere.geometry.handedness import (
    FULL,
    handedness_of,
    handedness_table,
    quadruples_of,
    rank_of,
)
from kinesphere.geometry.signature import evenly_spread, scale_of, signature
from kinesphere.labelling import built_in_model, kernels
from kinesphere.labelling.blocks import block_moves, twins
from kinesphere.labelling.live import LiveLabels
from kinesphere.labelling.local_tree import (
    aligned,
    match_leaves,
    orientation_vector,
    shape_from_distances,
)
from kinesphere.labelling.own_distances import costs_of, own_distances
from kinesphere.labelling.problem import problem_of
from kinesphere.labelling.runs import Run, points_of, runs_of, tracks_of
from kinesphere.labelling.template import template_of

EXACT = 1e-9
SINGLE = 1e-3  # costs are kept in single precision


class TestHandedness:
    def test_the_table_is_in_the_order_of_ranks(self):
        quads = quadruples_of(7)
        assert [rank_of(*q) for q in quads.tolist()] == list(range(len(quads)))
        assert {tuple(q) for q in quads.tolist()} == set(combinations(range(7), 4))

    def test_volumes_by_determinant(self, rng):
        points = rng.normal(size=(1, 5, 3))
        table = handedness_table(points)
        for q in rng.permutation(5)[:4][None].repeat(6, 0):
            q = rng.permutation(q)
            a, b, c, d = points[0, q]
            sign = np.sign(np.linalg.det([b - a, c - a, d - a]))
            assert handedness_of(table, *(int(x) for x in q)) == FULL * sign

    def test_unseen_points_have_none(self, rng):
        points = rng.normal(size=(9, 5, 3))
        points[:, 2] = np.nan
        table = handedness_table(points)
        assert_array_equal(table != 0, (quadruples_of(5) != 2).all(axis=1))


def test_frames_are_spread_the_same_backwards():
    for n, count in ((1000, 300), (301, 300), (77, 10)):
        frames = evenly_spread(n, count)
        assert len(frames) <= count
        assert_array_equal(np.sort(n - 1 - frames), frames)


def test_the_scale_is_the_shortest_tree(rng):
    line = np.zeros((1, 4, 3))
    line[0, :, 0] = [0.0, 3.0, 1.0, 7.0]
    assert scale_of(signature(line).mean) == pytest.approx(7.0)


class TestTemplate:
    def test_the_other_side_twice_is_the_same(self):
        model = built_in_model("cmu41")
        template = template_of(model)
        twin = twins(model, template.labels)
        label = template.labels.index("RBAC")
        other = template.with_other_side(label, twin)
        assert (other.handedness != template.handedness).any()
        there = template.with_other_side(label, twin).with_other_side(label, twin)
        assert_array_equal(there.mean, template.mean)
        assert_array_equal(there.handedness, template.handedness)

    def test_few_markers_are_refused(self, legs):
        model, _ = legs
        with pytest.raises(BadModel, match="statistics of 3 markers; 4 at least"):
            template_of(model, model.labels[:3])

    def test_spreads_shrink_with_what_agrees(self, legs):
        model, _ = legs
        one = template_of(replace(model, statistics=model.statistics[:1]))
        five = template_of(replace(model, statistics=model.statistics[:1] * 5))
        off = ~np.eye(one.n, dtype=bool)
        assert (five.variance[off] < one.variance[off]).all()


class TestExchanges:
    """Changes of energy, against the energy itself."""

    @pytest.fixture
    def problem(self, legs):
        model, recording = legs
        found = signature(recording.markers)
        return problem_of(found, scale_of(found.mean), template_of(model))

    def test_every_exchange_changes_the_energy_by_its_gain(self, problem, rng):
        n = problem.n_points
        labels = rng.permutation(n).astype(np.int64)
        labels[:3] = -1
        for _ in range(40):
            a, j = int(rng.integers(n)), int(rng.integers(-1, n))
            if labels[a] == j:
                continue
            holder = problem.holders(labels)
            terms = kernels.linear_terms(labels, problem.costs)
            room = np.zeros(n)
            gain = kernels.exchange_gain(
                labels, holder, terms, problem.costs, *problem.handed, problem.of_label,
                problem.n_of_label, room, a, j, np.inf,
            )  # fmt: skip
            before = problem.energy(labels)
            kernels.exchange(labels, holder, terms, problem.costs, a, j)
            assert problem.energy(labels) - before == pytest.approx(gain, abs=SINGLE)
            assert_allclose(terms, kernels.linear_terms(labels, problem.costs), atol=SINGLE)
            assert_array_equal(holder, problem.holders(labels))

    @pytest.mark.parametrize("stiller", [0.25, 1.0])
    def test_a_pair_that_rests_costs_a_share_of_one_that_moves_as_much_more(self, stiller):
        one, at = np.ones((2, 2)), np.full((2, 2), -3.0)
        found = []
        for change in (-0.4, 0.0, 0.4):
            costs = np.zeros((2, 2, 2, 2), dtype=np.float32)
            kernels.pair_costs(
                one, at + change, 0.01 * one, one, one, one, at, one, stiller, 3.0, -1, costs
            )
            found.append(costs[0, 0, 1, 1])
            assert_array_equal(costs[0, 0, 0], 0)
            assert_allclose(costs[0, 0, 1, 1], costs[1, 1, 0, 0])
        still, usual, moving = found
        y = 0.4**2 / 2
        soft = [y * share / (1 + y * share / 6) for share in (stiller, 1.0)]
        assert_allclose([still - usual, moving - usual], soft, atol=SINGLE)

    def test_what_one_recording_rested_in_counts_in_full(self, legs):
        model, recording = legs
        found = signature(recording.markers)
        scale = scale_of(found.mean)
        alone = template_of(replace(model, statistics=model.statistics[:1]))
        costs = [
            problem_of(found, scale, replace(alone, n_recordings=n)).costs for n in (1, 2, 4, 9)
        ]
        assert (costs[0] > costs[1] + SINGLE).any()
        assert (costs[1] > costs[2] + SINGLE).any()
        assert_array_equal(costs[2], costs[3])

    def test_a_descent_never_climbs(self, problem, rng):
        labels = rng.permutation(problem.n_points).astype(np.int64)
        better = problem.descend(labels, nullable=False)
        assert problem.energy(better) < problem.energy(labels)
        assert sorted(better) == sorted(labels)
        least, _ = problem.least_changes(better)
        assert least.min() >= -SINGLE

    def test_the_right_labels_agree_in_handedness(self, problem):
        right = np.arange(problem.n_points)
        assert problem.agreement(right) > 0.6


def test_block_moves_are_permutations_that_mirror_first(legs):
    model, _ = legs
    template = template_of(model)
    moves = block_moves(model, template.labels, template.mean).every
    assert_array_equal(moves[0], twins(model, template.labels))
    for move in moves:
        assert sorted(move) == list(range(template.n))


class TestLocalTree:
    def test_a_shape_is_found_at_any_size_after_a_turn_about_its_vector(self, rng):
        shape = rng.normal(size=(6, 3))
        shape -= shape.mean(axis=0)
        order = rng.permutation(6)
        found = match_leaves(shape, (1.7 * shape)[order])
        assert_array_equal(order[found], np.arange(6))

    def test_alignment_brings_vector_onto_vector(self, rng):
        shape, other = rng.normal(size=(5, 3)), rng.normal(size=(5, 3))
        moved = other @ Rotation.random(rng=rng).as_matrix().T + 5
        own, wanted = orientation_vector(aligned(moved, shape)), orientation_vector(shape)
        assert own @ wanted == pytest.approx(np.linalg.norm(own) * np.linalg.norm(wanted))

    def test_about_one_axis_heights_stay(self, rng):
        shape, other = rng.normal(size=(5, 3)), rng.normal(size=(5, 3))
        up = np.array([0.0, 1.0, 0.0])
        assert_allclose(
            aligned(other, shape, up)[:, 1], other[:, 1] - other[:, 1].mean(), atol=EXACT
        )

    def test_distances_give_the_shape_back_and_its_side(self, rng):
        shape = rng.normal(size=(6, 3))
        distance = np.linalg.norm(shape[:, None] - shape, axis=2)
        quads = quadruples_of(6)
        signs = np.sign(np.linalg.det(shape[quads[:, 1:]] - shape[quads[:, :1]]))
        for side in (1, -1):
            found = shape_from_distances(distance, np.column_stack([quads, side * signs]))
            assert_allclose(np.linalg.norm(found[:, None] - found, axis=2), distance, atol=EXACT)
            back = np.sign(np.linalg.det(found[quads[:, 1:]] - found[quads[:, :1]]))
            assert_array_equal(back, side * signs)


class TestRuns:
    def test_runs_are_stretches_of_true(self):
        seen = np.array([[1, 0], [1, 1], [0, 1], [1, 1]], dtype=bool)
        assert runs_of(seen) == [Run(0, 0, 2), Run(1, 1, 4), Run(0, 3, 4)]

    def test_pieces_of_smooth_ways_are_joined_again(self, legs, rng):
        _, recording = legs
        whole = recording.markers[:200, :6]
        pieces, truth = [], []
        for i in range(6):
            cut = int(rng.integers(50, 150))
            for a, b in ((0, cut), (cut, 200)):
                piece = np.full((200, 3), np.nan)
                piece[a:b] = whole[a:b, i]
                pieces.append(piece)
                truth.append(i)
        order = rng.permutation(12)
        markers = np.stack(pieces, axis=1)[:, order]
        tracks = tracks_of(markers, recording.rate, keep_columns=False)
        for track in tracks:
            assert len({truth[order[run.column]] for run in track}) == 1
        assert len(tracks) <= 8
        assert_array_equal(
            np.isfinite(points_of(markers, tracks)).sum(), np.isfinite(markers).sum()
        )

    def test_a_column_may_be_one_marker_throughout(self):
        markers = np.zeros((9, 2, 3))
        markers[4:6, 0] = np.nan
        tracks = tracks_of(markers, 100.0, keep_columns=True)
        assert tracks == [(Run(0, 0, 4), Run(0, 6, 9)), (Run(1, 0, 9),)]


def test_own_distances_know_their_marker(legs):
    _, recording = legs
    own = own_distances(recording.markers)
    frames = np.arange(100, 160)
    for i in range(recording.n_markers):
        without = recording.markers.copy()
        without[:, i] = np.nan
        cost, width = costs_of(recording.markers[frames, i], frames, without, own)
        assert np.nanargmin(cost + width) == i


class TestLive:
    def test_a_crowd_gets_its_labels(self, legs, rng):
        _, recording = legs
        live = LiveLabels(recording.markers[:1000], recording.labels, recording.rate)
        hidden = slice(1020, 1035)
        for t in range(1000, 1100):
            frame = recording.markers[t].copy()
            if hidden.start <= t < hidden.stop:
                frame[5] = np.nan
            crowd = np.concatenate([frame, rng.uniform(3, 9, size=(4, 3))])
            order = rng.permutation(len(crowd))
            labels = live.label(crowd[order])
            truth = np.where((order < len(frame)) & np.isfinite(crowd[order, 0]), order, -1)
            assert_array_equal(labels, truth)

    def test_labels_exchanged_in_passing_are_soon_back(self, rng):
        still, passing = rng.uniform(-0.15, 0.15, size=(2, 6, 3))
        passing += still[0] - passing[0]  # its first marker meets the other's
        way = np.arange(-300, 60)[:, None, None] * np.array([0.005, 0.0, 0.0])
        markers = np.concatenate([still + 0 * way, passing + way], axis=1)
        markers += rng.normal(scale=0.0005, size=markers.shape)
        live = LiveLabels(markers[:302], tuple("abcdefghijkl"), 100.0)
        for state in (live._here, live._step):
            state[[0, 6]] = state[[6, 0]]
        found = [live.label(frame) for frame in markers[302:]]
        assert found[0][0] == 6
        for labels in found[10:]:
            assert_array_equal(labels, np.arange(12))

    def test_a_label_on_what_is_no_marker_is_taken_away(self, legs):
        _, recording = legs
        live = LiveLabels(recording.markers[:1000], recording.labels, recording.rate)
        i = recording.labels.index("LTOE")
        for t in range(1000, 1050):
            frame = recording.markers[t].copy()
            frame[i] = recording.markers[999, i] + 0.02 * (t - 999)  # it drifts off
            labels = live.label(frame)
        assert labels[i] == -1
        assert_array_equal(np.delete(labels, i), np.delete(np.arange(len(labels)), i))

    def test_too_little_to_lock_on_to_is_refused(self):
        with pytest.raises(BadRecording, match="0 markers are seen"):
            LiveLabels(np.full((5, 6, 3), np.nan), tuple("abcdef"), 100.0)
