"""Chains of points that slide into a missing marker's place, and labels that change places."""

from itertools import permutations

import numba
import numpy as np
import pytest
from numpy.testing import assert_array_equal

from kinesphere.geometry.signature import scale_of, signature
from kinesphere.labelling.blocks import twins
from kinesphere.labelling.exchanged import exchange_labels, followed
from kinesphere.labelling.labelled import Labelled, give
from kinesphere.labelling.problem import problem_of
from kinesphere.labelling.runs import Run
from kinesphere.labelling.search import nearest_labels
from kinesphere.labelling.slides import HIGHEST, SOURCES, slide
from kinesphere.labelling.template import template_of

compiled = pytest.mark.skipif(
    bool(numba.config.DISABLE_JIT), reason="a search in plain Python takes minutes"
)
EXACT = 1e-6


class TestSlide:
    """One marker is missing: against all chains of up to three points."""

    @pytest.fixture
    def case(self, legs):
        model, recording = legs
        template = template_of(model)
        kept = np.arange(1, recording.n_markers)
        found = signature(recording.markers[:, kept])
        problem = problem_of(found, scale_of(found.mean), template)
        return problem, kept, nearest_labels(template.mean), twins(model, template.labels)

    def test_every_chain_is_found_that_nowhere_rises_far(self, case):
        problem, labels, near, twin = case
        rises, _, _ = slide(problem, labels, near, twin)
        start = problem.energy(labels)
        least = np.full(len(labels), np.inf)
        for length in (1, 2, 3):
            for chain in permutations(range(len(labels)), length):
                changed, free, reachable = labels.copy(), 0, True
                for point in chain:
                    source = labels[point]
                    reachable &= source in near[free, 1:SOURCES] or source == twin[free]
                    changed[point], free = free, source
                    reachable &= problem.energy(changed) - start < HIGHEST
                    if not reachable:
                        break
                if reachable:
                    points = list(chain)
                    least[points] = np.minimum(least[points], problem.energy(changed) - start)
        assert np.isfinite(least).any()
        assert (rises <= least + EXACT).all()

    def test_a_chain_that_has_slid_is_brought_back(self, case):
        problem, right, near, twin = case
        slid, free = right.copy(), 0
        for source in near[0, 1:4]:
            slid[source - 1], free = free, source
        assert problem.energy(slid) > problem.energy(right)
        _, best, energy = slide(problem, slid, near, twin)
        assert energy == pytest.approx(problem.energy(best), abs=1e-3)
        assert energy <= problem.energy(right) + EXACT

    def test_where_no_label_is_free_nothing_slides(self, legs):
        model, recording = legs
        found = signature(recording.markers)
        template = template_of(model)
        problem = problem_of(found, scale_of(found.mean), template)
        labels = np.arange(recording.n_markers)
        near, twin = nearest_labels(template.mean), twins(model, template.labels)
        rises, best, energy = slide(problem, labels, near, twin)
        assert np.isinf(rises).all()
        assert_array_equal(best, labels)
        assert energy == problem.energy(labels)


@pytest.mark.parametrize(
    ("wanted", "sure", "moves"),
    [
        ([1, 0, 2], [1, 1, 0], {0: 1, 1: 0}),  # an exchange
        ([1, 2, 0], [1, 1, 1], {0: 1, 1: 2, 2: 0}),
        ([1, 2, 0], [1, 0, 1], {}),  # nobody makes room for another who stays
        ([1, 2, 7], [1, 1, 1], {0: 1, 1: 2, 2: 7}),  # into a free label
        ([1, 2, 7], [0, 1, 1], {1: 2, 2: 7}),
        ([1, 2, 7], [1, 1, 0], {}),
        ([0, 1, -1], [1, 1, 1], {}),
    ],
)
def test_labels_move_where_none_that_stays_is_in_the_way(wanted, sure, moves):
    held = np.arange(3)
    assert followed(held, np.array(wanted), np.array(sure, dtype=bool)) == moves


@compiled
class TestExchangeLabels:
    @pytest.fixture
    def swapped(self, legs):
        """Return work in which markers 3 and 4 bear each other's label in both their pieces."""
        markers = legs[1].markers
        n_frames, n = markers.shape[:2]
        runs = [Run(i, a, b) for i in range(n) for a, b in ((0, 100), (100, n_frames))]
        state = Labelled(
            np.full((n_frames, n, 3), np.nan),
            [(run,) for run in runs],
            [-1] * len(runs),
            [0.0] * len(runs),
        )
        for k, run in enumerate(runs):
            give(state, markers, k, {3: 4, 4: 3}.get(run.column, run.column), 1.0)
        return markers, state

    def test_what_is_exchanged_throughout_is_set_right(self, legs, swapped):
        markers, state = swapped
        assert exchange_labels(state, markers, legs[0], 0.1, set())
        assert_array_equal(state.points, markers)
        assert not exchange_labels(state, markers, legs[0], 0.1, set())

    def test_what_a_person_gave_stays_with_what_is_in_its_way(self, legs, swapped):
        markers, state = swapped
        before = list(state.labels)
        assert not exchange_labels(state, markers, legs[0], 0.1, {6})
        assert state.labels == before

    def test_what_is_less_sure_than_asked_stays(self, legs, swapped):
        markers, state = swapped
        assert not exchange_labels(state, markers, legs[0], 1.0, set())
