"""One marker that is there under two numbers."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_array_equal

from kinesphere.skeleton import discover
from kinesphere.skeleton.discovery.copies import BESIDE, find_copies, with_pieces_joined


def tripled(recording, column, *offsets):
    """Return the recording with copies of a marker, so far beside it, behind all others."""
    twins = [recording.markers[:, column : column + 1] + offset for offset in offsets]
    labels = [f"again {k}" for k in range(len(offsets))]
    markers = np.concatenate([recording.markers, *twins], axis=1)
    return replace(recording, markers=markers, labels=(*recording.labels, *labels))


def as_told(found):
    bodies = {segment.name: set(segment.markers) for segment in found.model.segments}
    return bodies, {(joint.name, joint.parent, joint.child) for joint in found.model.joints}


@pytest.mark.parametrize("offset", [0.0, 0.0005, [0.001, 0.0, 0.0]])
def test_a_marker_that_is_there_three_times_is_one(recorded, offset):
    found = discover(tripled(recorded, 7, offset, np.negative(offset)))
    assert as_told(found) == as_told(discover(recorded))
    assert found.step.findings["copies"] == {"again 0": "*7", "again 1": "*7"}
    (told,) = (doubt for doubt in found.step.warnings if "there twice" in doubt)
    assert "again 0 (as *7)" in told


def test_everything_twice_is_one_person(recorded, rng):
    order = rng.permutation(2 * recorded.n_markers)
    markers = np.concatenate([recorded.markers, recorded.markers], axis=1)[:, order]
    labels = [*recorded.labels, *(f"{label}b" for label in recorded.labels)]
    found = discover(
        replace(
            recorded, markers=np.array(markers, order="C"), labels=tuple(labels[i] for i in order)
        )
    )
    bodies = {frozenset(x.rstrip("b") for x in markers) for markers in as_told(found)[0].values()}
    alone = {frozenset(markers) for markers in as_told(discover(recorded))[0].values()}
    assert bodies == alone


def test_the_one_that_is_seen_most_is_kept(rng):
    markers = rng.normal(size=(400, 4, 3))
    markers[:, 3] = markers[:, 0] + 0.3 * BESIDE
    order = np.arange(4)
    assert find_copies(markers, order) == ({3: 0}, {})
    assert find_copies(markers, order[::-1]) == ({0: 3}, {})  # the first in the file
    markers[50:100, 0] = np.nan
    assert find_copies(markers, order) == ({0: 3}, {})


def test_two_that_touch_or_are_never_seen_together_are_no_copies(rng):
    markers = rng.normal(size=(400, 3, 3))
    markers[:, 2] = markers[:, 1] + [0.0, 0.0, 1.1 * BESIDE]
    assert find_copies(markers, np.arange(3)) == ({}, {})
    markers[:, 2] = markers[:, 1]
    markers[::2, 1], markers[1::2, 2] = np.nan, np.nan
    assert find_copies(markers, np.arange(3)) == ({}, {})


def test_two_that_meet_for_less_than_half_of_the_time_are_no_copies(rng):
    markers = rng.normal(size=(400, 3, 3))
    markers[:150, 2] = markers[:150, 1]
    assert find_copies(markers, np.arange(3)) == ({}, {})


@pytest.mark.parametrize(("alone", "copies"), [(10, {2: 1}), (11, {})])
def test_a_copy_is_seen_hardly_anywhere_but_where_the_other_is(rng, alone, copies):
    """Of its hundred frames so many show only it."""
    markers = rng.normal(size=(400, 3, 3))
    markers[:, 2] = markers[:, 1]
    markers[100:, 2], markers[:alone, 1] = np.nan, np.nan
    found, pieces = find_copies(markers, np.arange(3))
    assert found == copies
    assert pieces == ({} if copies else {2: 1})


def test_a_copy_of_a_piece_is_a_copy(rng):
    markers = rng.normal(size=(400, 4, 3))
    markers[:, [2, 3]] = markers[:, [1]]
    markers[250:, 1], markers[:200, 2], markers[:210, 3] = np.nan, np.nan, np.nan
    assert find_copies(markers, np.arange(4)) == ({3: 2}, {2: 1})
    joined = with_pieces_joined(markers, {2: 1})
    assert np.isfinite(joined[:, 1]).all()
    assert_array_equal(joined[:, 2:], markers[:, 2:])


def test_pieces_that_overlap_are_markers_of_one_body(recorded):
    n = recorded.n_frames
    early, late = np.array(recorded.markers), recorded.markers[:, [7]].copy()
    early[n // 2 + 20 :, 7], late[: n // 2 - 20] = np.nan, np.nan
    found = discover(
        replace(
            recorded,
            markers=np.concatenate([early, late], axis=1),
            labels=(*recorded.labels, "piece"),
        )
    )
    bodies, joints = as_told(discover(recorded))
    (limb,) = (limb for limb, markers in bodies.items() if "*7" in markers)
    assert as_told(found) == (bodies | {limb: bodies[limb] | {"piece"}}, joints)
    assert set(found.model.required) >= {"*7", "piece"}
    assert found.step.findings["copies"] == {}
    assert "piece" in str(found.step.findings["pieces"])
    assert not [doubt for doubt in found.step.warnings if "there twice" in doubt]
