"""Where a search starts from, what it mends, and what its other ends say of confidence."""

from itertools import combinations

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from kinesphere.geometry.signature import scale_of, signature
from kinesphere.labelling.doubting import shaken
from kinesphere.labelling.layout import Solved, layout_of
from kinesphere.labelling.problem import problem_of
from kinesphere.labelling.search import COLD, WARM, _misfit
from kinesphere.labelling.shapes import alike, shape_of
from kinesphere.labelling.template import usual_deviations
from kinesphere.labelling.verdict import ALONE, MARGIN, confidence_of


def distances(points):
    return np.linalg.norm(points[:, None] - points[None], axis=2)


class TestShapes:
    def test_points_in_space_are_found_by_their_distances(self, rng):
        points = rng.normal(size=(12, 3)) * (1.0, 0.4, 0.2)
        assert_allclose(distances(shape_of(distances(points))), distances(points), atol=1e-6)

    def test_distances_never_seen_are_filled_in(self, rng):
        points = rng.normal(size=(12, 3)) * (1.0, 0.4, 0.2)
        mean = distances(points)
        mean[0, 5] = mean[5, 0] = np.nan
        assert_allclose(distances(shape_of(mean)), distances(points), atol=0.02)

    def test_a_body_lying_anywhere_has_its_labels_among_the_starts(self, rng):
        places = rng.normal(size=(12, 3)) * (1.0, 0.4, 0.2)
        order = rng.permutation(12)
        found = alike(distances(places[order]), distances(places), np.arange(12))
        assert any((labels == order).all() for labels in found)

    def test_more_points_than_labels_leave_some_without(self, rng):
        places = rng.normal(size=(12, 3))
        for labels in alike(distances(places), distances(places[:9]), np.arange(9)):
            assert (np.sort(labels) == np.concatenate([[-1] * 3, np.arange(9)])).all()


@pytest.fixture
def solved(legs):
    model, recording = legs
    layout = layout_of(model)
    found = signature(recording.markers)
    problem = problem_of(found, scale_of(found.mean), layout.template)
    labels = np.arange(problem.n_points)
    return layout, Solved(problem, labels, problem.energy(labels), np.full(len(labels), 1e3), [])


class TestSearch:
    def test_many_points_that_are_no_markers_do_not_end_the_search(self, solved, rng):
        # once every label is borne, no label is left for any number of unlabelled points
        problem = solved[1].problem
        nobody = np.full(problem.n_points, -1)
        empty = np.array([], dtype=np.int64)
        changed = problem.anneal(nobody, rng.random((50, 3)), WARM, COLD, targets=empty)
        assert_array_equal(changed, nobody)
        assert_array_equal(
            problem.anneal(nobody, rng.random((50, 3)), WARM, COLD, points=empty), nobody
        )

    def test_points_without_label_are_not_the_worst_by_themselves(self, solved):
        problem, labels = solved[1].problem, solved[1].labels.copy()
        labels[:4] = -1
        worst = np.argsort(-_misfit(problem, labels))[:4]
        assert (labels[worst] >= 0).any()

    def test_energies_of_points_add_up(self, solved):
        problem, labels = solved[1].problem, solved[1].labels
        pairs = _pair_energy(problem, labels)
        handed = problem.energy(labels) - pairs
        assert problem.energies(labels).sum() == pytest.approx(2 * pairs + 4 * handed, abs=1e-2)

    def test_annealing_some_leaves_the_others(self, solved, rng):
        problem, labels = solved[1].problem, solved[1].labels
        some = np.array([0, 2, 5])
        changed = problem.anneal(
            labels, rng.random((400, 3)), 1e4, 1e3, points=some, targets=labels[some]
        )
        assert_array_equal(np.delete(changed, some), np.delete(labels, some))
        assert_array_equal(np.sort(changed), np.sort(labels))

    def test_annealing_ends_no_higher_than_chance(self, solved, rng):
        problem = solved[1].problem
        start = rng.permutation(problem.n_points)
        end = problem.anneal(start, rng.random((5000, 3)), WARM, COLD)
        assert problem.energy(end) < problem.energy(start)

    def test_what_is_shaken_ends_no_lower_than_the_best(self, solved):
        layout, one = solved
        _, energy, margins = shaken(one.problem, one.labels, one.energy, one.margins, layout.near)
        assert energy <= one.energy
        assert (margins >= 0).all()


class TestConfidence:
    def test_another_end_costs_the_labels_it_denies(self, solved):
        layout, one = solved
        other = one.labels.copy()
        other[[0, 1]] = other[[1, 0]]
        plain = confidence_of(one, layout)
        told = confidence_of(one._replace(rivals=[(one.energy + 2.0, other)]), layout)
        assert told[[0, 1]] == pytest.approx(1 - np.exp(-2.0 / MARGIN))
        assert_allclose(told[2:], plain[2:])

    def test_a_nat_is_shared_among_many_labels(self, solved):
        layout, one = solved
        n = len(one.labels)
        other = np.roll(one.labels, 1)
        told = confidence_of(one._replace(rivals=[(one.energy + 2.0, other)]), layout)
        assert told.max() <= 1 - np.exp(-2.0 * ALONE / n / MARGIN) + 1e-9

    def test_what_one_start_alone_found_is_not_given(self, solved):
        layout, one = solved
        other = np.roll(one.labels, 1)
        alone = one._replace(rivals=[(one.energy + 50.0, other)], converged=0.0)
        assert confidence_of(alone, layout).max() == 0


def test_deviations_of_other_people_are_in_the_order_of_the_model(legs):
    model, recording = legs
    usual = usual_deviations(model)
    assert usual.shape == (len(model.labels),) * 2
    assert_allclose(usual, usual.T)
    assert np.isnan(np.diag(usual)).all() or (np.diag(usual) >= 0).all()
    own = signature(recording.markers).std
    off = np.isfinite(usual) & ~np.eye(len(usual), dtype=bool)
    order = np.argsort(usual[off])
    steady, loose = order[: len(order) // 4], order[-len(order) // 4 :]
    columns = recording.columns(model.labels)
    own = own[np.ix_(columns, columns)][off]
    assert own[steady].mean() < own[loose].mean()


def _pair_energy(problem, labels):
    pairs = combinations(range(len(labels)), 2)
    return sum(problem.costs[a, labels[a], b, labels[b]] for a, b in pairs)
