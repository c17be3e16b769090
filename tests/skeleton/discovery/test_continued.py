"""One marker that was lost and found again under another number."""

from dataclasses import replace

import numpy as np
import pytest

from kinesphere.skeleton import discover
from kinesphere.skeleton.discovery.continued import find_continued

RATE = 50.0
N = 600


@pytest.fixture
def plates(rng, moving_bodies):
    """Return two bodies of five markers, 0.4 m apart, with a tenth of a millimetre of noise."""
    return moving_bodies(rng, (5, 5), n_frames=N, noise=1e-4)[0]


def broken(markers, column, *, lost, gap, into=None):
    """Return the markers, one of them another one (or ``into``) after a gap of so many frames."""
    again = markers[:, [column if into is None else into]].copy()
    again[: lost + gap] = np.nan
    markers = np.concatenate([markers, again], axis=1)
    markers[lost:, column] = np.nan
    return markers


def continued(markers):
    return find_continued(markers, RATE, np.arange(markers.shape[1]))


@pytest.mark.parametrize("gap", [0, 30])
def test_what_keeps_its_distances_is_the_same_marker(plates, gap):
    assert continued(broken(plates, 2, lost=400, gap=gap)) == {10: 2}
    assert continued(broken(plates, 2, lost=200, gap=gap)) == {2: 10}  # seen less often


def test_three_pieces_are_one_marker(plates):
    markers = broken(broken(plates, 2, lost=250, gap=20), 10, lost=400, gap=20)
    assert continued(markers) == {10: 2, 11: 2}


@pytest.mark.parametrize("into", [3, 7])
def test_another_marker_is_not_the_same_wherever_it_is(plates, into):
    markers = broken(plates, 2, lost=300, gap=5, into=into)
    markers = np.delete(markers, into, axis=1)  # it is seen nowhere else
    assert continued(markers) == {}


def test_what_lives_at_the_same_time_is_not_the_same(plates):
    markers = broken(plates, 2, lost=300, gap=0)
    markers[250:310, 2] = plates[250:310, 2]
    assert continued(markers) == {}


def test_where_two_could_be_meant_neither_is(plates):
    """Two trajectories begin where one was lost."""
    markers = broken(plates, 2, lost=300, gap=5)
    markers = np.concatenate([markers, markers[:, -1:] + 1e-5], axis=1)
    assert continued(markers) == {}


@pytest.mark.parametrize(("gap", "found"), [(4, {4: 0}), (6, {})])
def test_one_fellow_is_enough_only_where_no_time_is_lost(rng, moving_bodies, gap, found):
    pair = moving_bodies(rng, (2, 2), n_frames=N, noise=1e-4)[0]
    assert continued(broken(pair, 0, lost=400, gap=gap)) == found


def test_a_leap_is_no_continuation(plates):
    """Its mirror image in the plane of three keeps the distances from them."""
    three = plates[:, :3]
    normal = np.cross(three[:, 1] - three[:, 0], three[:, 2] - three[:, 0])
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    above, below = (three.mean(axis=1) + side * 0.05 * normal for side in (1, -1))
    found = {}
    for name, then in (("same", above), ("mirrored", below)):
        markers = broken(np.stack([*np.moveaxis(three, 1, 0), above], axis=1), 3, lost=400, gap=0)
        markers[400:, 4] = then[400:]
        found[name] = continued(markers)
    assert found == {"same": {4: 3}, "mirrored": {}}


def test_whole_and_unseen_trajectories_say_nothing(plates):
    assert continued(plates) == {}
    plates = np.concatenate([plates, np.full((N, 2, 3), np.nan)], axis=1)
    assert continued(plates) == {}


def test_pieces_are_markers_of_their_limb_and_it_is_said(recorded):
    markers, labels = recorded.markers, list(recorded.labels)
    for column in (7, 20):
        markers = broken(markers, column, lost=recorded.n_frames // 2, gap=10)
        labels.append(f"again {column}")
    found = discover(replace(recorded, markers=markers, labels=tuple(labels)))
    whole = {s.name: set(s.markers) for s in discover(recorded).model.segments}
    for label, piece in (("*7", "again 7"), ("*20", "again 20")):
        next(markers for markers in whole.values() if label in markers).add(piece)
    assert {s.name: set(s.markers) for s in found.model.segments} == whole
    (told,) = (w for w in found.step.warnings if "pieces of others" in w)
    assert told.startswith("2 trajectories")
    assert set(found.step.findings["pieces"]) | set(found.step.findings["pieces"].values()) == {
        "*7", "*20", "again 7", "again 20"
    }  # fmt: skip
