"""Bodies that wear far fewer markers than a model has labels."""

from dataclasses import replace

import numba
import numpy as np
import pytest
from numpy.testing import assert_array_equal
from tests.labelling.conftest import actor, lower_body

from kinesphere import read
from kinesphere.geometry.signature import scale_of, signature
from kinesphere.labelling import built_in_model, label, match_labels
from kinesphere.labelling.layout import layout_of
from kinesphere.labelling.pair_statistics import match_pair_statistics
from kinesphere.labelling.solving import best_scale, scale_by_labels
from kinesphere.labelling.worn import is_worn, numbered, smaller_layout
from kinesphere.skeleton.statistics import marker_statistics

pytestmark = pytest.mark.skipif(
    bool(numba.config.DISABLE_JIT), reason="a search in plain Python takes minutes"
)


def with_additions(points, segments, labels):
    """Return points with one more between every two neighbours of a segment, and all labels."""
    at = {label: i for i, label in enumerate(labels)}
    places, names = [points], list(labels)
    for segment in segments:
        for a, b in zip(segment.markers, segment.markers[1:], strict=False):
            places.append(0.6 * points[:, [at[a]]] + 0.4 * points[:, [at[b]]])
            names.append(f"{a}+{b}")
    return np.concatenate(places, axis=1), tuple(names)


@pytest.fixture(scope="module")
def dense():
    """Return the model of legs learnt from one person without additions and one with them."""
    plain = lower_body(built_in_model("cmu41"))
    learnt = []
    for seed in (11, 12):
        one = actor(seed, plain.labels)
        if seed == 12:
            points, names = with_additions(one.markers, plain.segments, plain.labels)
            one = replace(one, markers=points, labels=names)
        learnt.append(marker_statistics(one, one.labels, f"actor {seed}"))
    segments = tuple(
        replace(s, markers=tuple(x for x in names if x.split("+")[0] in s.markers))
        for s in plain.segments
    )
    return replace(plain, segments=segments, statistics=tuple(learnt))


def test_points_all_over_the_body_tell_its_scale(legs, dense):
    recording = legs[1]
    layout = layout_of(dense)
    assert recording.n_markers < 0.7 * layout.template.n
    truth = np.array([layout.template.labels.index(x) for x in recording.labels])
    found = signature(recording.markers)
    true = scale_by_labels(found, truth, layout.template)
    share = (layout.template.n - 1) / (found.n - 1)
    whole = scale_of(found.mean) * share
    assert whole > 1.3 * true
    assert best_scale(found, layout, whole, share)[0] == pytest.approx(true, rel=0.05)


def test_additions_nobody_wears_take_no_labels(legs, dense):
    recording = legs[1]
    match = match_pair_statistics(recording.markers, dense)
    sure = match.confidence >= 0.1
    given = np.array(dense.labels)[match.labels[sure]]
    assert_array_equal(given, np.array(recording.labels)[sure])
    assert sure.sum() >= recording.n_markers - 2


def test_a_layout_with_additions_is_not_taken_for_the_one_without(legs, dense):
    plain, recording = legs
    points, names = with_additions(recording.markers, plain.segments, recording.labels)
    layout, n = layout_of(dense), recording.n_markers
    smaller = smaller_layout(dense, layout, n)
    assert set(smaller.template.labels) == set(recording.labels)
    assert smaller_layout(dense, layout, len(names)) is None
    at = {x: i for i, x in enumerate(layout.template.labels)}
    worn = list(range(len(names)))[-n:]  # all additions, and few of the others
    truth = np.array([at[names[i]] for i in worn])
    common = numbered(np.arange(n), np.arange(n), smaller, layout, n)
    assert not is_worn(signature(points[:, worn]), common, truth, layout)


@pytest.mark.real
@pytest.mark.parametrize(
    ("file", "n"), [("pycgm_movement.c3d", 39), ("PiG_Motion-FlatFoot-Full.c3d", 35)]
)
def test_plug_in_gait_by_the_model_of_all_its_additions(recordings, file, n):
    model = built_in_model("plugin-gait")
    walk = match_labels(read(recordings / "plugin-gait" / file), model)
    layout = layout_of(model).template.labels
    worn = [c for c, x in enumerate(walk.labels) if x in layout and walk.seen[:, c].any()]
    worn = worn[::-1]
    match = match_pair_statistics(walk.markers[:, worn], model)
    truth = [model.labels.index(walk.labels[c]) for c in worn]
    assert len(worn) == n
    assert_array_equal(match.labels, truth)
    assert (match.confidence >= 0.1).all()


@pytest.mark.real
def test_a_whole_capture_of_plug_in_gait_keeps_its_labels_to_the_end(recordings):
    walk = read(recordings / "plugin-gait" / "PiG_Motion-FlatFoot-Full.c3d")
    names = [f"*{i}" for i in range(walk.n_markers)]
    found = label(replace(walk, labels=tuple(names)), built_in_model("plugin-gait"))
    for column, name in enumerate(walk.labels):
        if walk.seen[:, column].any():
            given = found.markers[:, found.labels.index(name)]
            assert_array_equal(given, walk.markers[:, column])
