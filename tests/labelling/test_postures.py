"""Postures a layout might be in: what they leave as it is, and what they change."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from kinesphere.labelling import built_in_model
from kinesphere.labelling.pooling import pooled
from kinesphere.labelling.postures import postures_of, spread_of_distances, steadiness
from kinesphere.labelling.shapes import shape_of
from kinesphere.labelling.template import (
    DISTANCE_FLOOR,
    DISTANCE_SHARE,
    of_one_segment,
    template_of,
    usual_deviations,
)

EXACT = 1e-9


@pytest.fixture(scope="module")
def body():
    """Return (model, labels, mean distances, postures) of a whole layout."""
    model = built_in_model("cmu41")
    mean = pooled(model.statistics, model.labels).mean
    return model, model.labels, mean, postures_of(model, model.labels, mean)


def test_the_first_posture_is_the_mean_shape(body):
    _, _, mean, postures = body
    assert_allclose(postures[0], shape_of(mean), atol=EXACT)


def test_segments_are_rigid_and_the_root_rests(body):
    model, labels, _, postures = body
    spread = spread_of_distances(postures)
    at = {label: i for i, label in enumerate(labels)}
    for segment in model.segments:
        own = [at[label] for label in segment.markers]
        assert_allclose(spread[np.ix_(own, own)], 0.0, atol=EXACT)
    root = [at[label] for label in model.segments[0].markers]
    assert model.segments[0].name == model.root
    assert_allclose(postures[:, root], postures[:1, root].repeat(len(postures), axis=0), atol=EXACT)


def test_the_more_joints_are_between_the_more_is_changed(body):
    _, labels, _, postures = body
    spread = spread_of_distances(postures)
    at = {label: i for i, label in enumerate(labels)}
    chain = [spread[at["RFIN"], at[x]] for x in ("RFRM", "RUPA", "CLAV", "RTHI")]
    assert (np.diff(chain) > 0).all()
    assert chain[0] > 0


def test_postures_are_in_the_unit_of_the_distances(body):
    model, labels, mean, postures = body
    larger = postures_of(model, labels, 1000 * mean)
    assert_allclose(
        spread_of_distances(larger), 1000 * spread_of_distances(postures), rtol=1e-6, atol=1e-6
    )


def test_quadruples_of_one_segment_are_steady_those_across_the_body_less(body):
    _, labels, _, postures = body
    at = {label: i for i, label in enumerate(labels)}
    head = [at[x] for x in ("LFHD", "RFHD", "LBHD", "C7")]
    far = [at[x] for x in ("RFIN", "LFIN", "RTOE", "LTHI")]
    trunk = [at[x] for x in ("C7", "CLAV", "LSHO", "T10")]
    found = steadiness(postures, np.array([trunk, head, far]))
    assert found[0] == 1.0
    assert found[1] > 0.9 > found[2]


def test_without_joints_nothing_bends(body):
    model, labels, mean, _ = body
    segments = tuple(replace(s, markers=labels, shared=()) for s in model.segments[:1])
    stiff = replace(model, segments=segments, joints=(), mirror=(), required=())
    assert_allclose(spread_of_distances(postures_of(stiff, labels, mean)), 0.0, atol=EXACT)


class TestTemplate:
    def test_one_recording_is_no_law_across_joints(self):
        model = built_in_model("cmu41")
        one = template_of(replace(model, statistics=model.statistics[:1]))
        build = np.sqrt((DISTANCE_SHARE * one.mean) ** 2 + DISTANCE_FLOOR**2)
        ratio = np.sqrt(one.variance) / build
        at = {label: i for i, label in enumerate(one.labels)}
        within = of_one_segment(model, one.labels) & ~np.eye(one.n, dtype=bool)
        assert np.median(ratio[within]) < 1.1
        assert ratio[at["RFIN"], at["RTHI"]] > 2.0

    def test_usual_deviations_are_only_what_was_seen(self, legs):
        model, _ = legs
        one = replace(model, statistics=model.statistics[:1])
        seen = one.statistics[0].deviation
        usual = usual_deviations(one)
        assert_allclose(usual, seen, atol=1e-6)
