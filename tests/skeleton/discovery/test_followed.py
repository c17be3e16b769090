"""Recordings in which every marker lives for seconds, one life after the other."""

from dataclasses import replace

import numpy as np
import pytest

from kinesphere.data import TopologicalModel
from kinesphere.skeleton import discover
from kinesphere.skeleton.discovery.followed import follow
from kinesphere.skeleton.discovery.lives import find_lives, with_lives_joined
from kinesphere.synthetic import make_performance, spoil_with_noise

RATE = 50.0


def in_lives(markers, rng, gap, life=(4.0, 9.0), rate=RATE):
    """Return each marker in pieces of so many seconds, a gap between them, and whose they are."""
    pieces, of = [], []
    for m in range(markers.shape[1]):
        start = 0
        while start < len(markers):
            end = start + int(rng.uniform(*life) * rate)
            end = len(markers) if len(markers) - end < rate else end
            piece = np.full(markers[:, m].shape, np.nan)
            piece[start:end] = markers[start:end, m]
            pieces.append(piece)
            of.append(m)
            start = end + int(rng.uniform(*gap) * rate)
    return np.stack(pieces, axis=1), np.array(of)


@pytest.fixture(scope="module")
def person():
    performance = make_performance(np.random.default_rng(41), n_frames=3600)
    return spoil_with_noise(performance.recording, np.random.default_rng(42), deviation=1e-3)


@pytest.mark.parametrize(("gap", "least"), [((0.05, 0.3), 0.95), ((0.1, 1.5), 0.85)])
def test_a_person_all_in_pieces_is_put_together(person, gap, least):
    pieces, of = in_lives(person.markers, np.random.default_rng(5), gap)
    tracks, joined = follow(pieces, person.rate)
    assert all(len({of[m] for m in track}) == 1 for track in tracks)
    assert len(of) - len(tracks) >= least * (len(of) - person.n_markers)
    for track, points in zip(tracks, np.moveaxis(joined, 1, 0), strict=True):
        whole = person.markers[:, of[track[0]]]
        shown = np.isfinite(points[:, 0])
        np.testing.assert_array_equal(points[shown], whole[shown])
        assert shown.sum() == np.isfinite(pieces[:, track, 0]).sum()


def test_pieces_in_any_order_are_joined_alike(person):
    pieces, _ = in_lives(person.markers, np.random.default_rng(6), (0.05, 0.5))
    shuffled = np.random.default_rng(7).permutation(pieces.shape[1])
    there = {frozenset(track) for track in follow(pieces, person.rate)[0]}
    again = follow(np.ascontiguousarray(pieces[:, shuffled]), person.rate)[0]
    assert {frozenset(int(shuffled[m]) for m in track) for track in again} == there


@pytest.mark.parametrize("gap", [3, 10, 40])
def test_a_neighbour_that_appears_where_one_was_lost_is_not_taken_for_it(rng, moving_bodies, gap):
    markers = moving_bodies(rng, (5, 5), n_frames=600, noise=1e-4)[0]
    markers[300:, 0] = np.nan
    markers[: 300 + gap, 1] = np.nan
    assert follow(markers, RATE)[0] == [[m] for m in range(10)]


def test_a_lone_marker_goes_on_where_its_way_leads_and_not_elsewhere():
    """No fellow is steady: only the way beside the nearest one tells."""
    t = np.arange(400)[:, None] / RATE
    path = np.hstack([np.sin(2 * t), np.cos(2 * t), t / 4])
    other = 0.3 * np.hstack([np.sin(3 * t), t, np.cos(t)])
    for aside, found in ((0.0, [[0, 2], [1]]), (0.06, [[0], [1], [2]])):
        again = path + np.array([aside, 0, 0])
        first, second = path.copy(), again.copy()
        first[200:], second[:203] = np.nan, np.nan
        assert follow(np.stack([first, other, second], axis=1), RATE)[0] == found


def test_lives_that_are_a_small_share_of_a_long_recording_are_no_reflections(person):
    few = person.markers[:, :16]
    lives, of = in_lives(few, np.random.default_rng(8), (0.05, 0.2), (2.5, 3.5))
    labels = tuple(f"*{m}" for m in range(len(of)))
    recording = replace(person, markers=lives, labels=labels, residuals=None)
    whole_of = find_lives(recording, 0.5)
    assert all(of[piece] == of[whole] for piece, whole in whole_of.items())
    assert len(whole_of) >= 0.8 * (len(of) - few.shape[1])
    joined = with_lives_joined(recording, whole_of)
    assert joined.seen.sum() == recording.seen.sum()
    assert not set(joined.labels) & {labels[piece] for piece in whole_of}


def test_lives_too_short_to_tell_who_is_steady_stay_apart(person):
    lives, of = in_lives(person.markers[:, :8], np.random.default_rng(8), (0.05, 0.2), (0.8, 1.4))
    tracks, _ = follow(lives, person.rate)
    assert all(len({of[m] for m in track}) == 1 for track in tracks)
    assert len(tracks) >= 0.9 * len(of)


def test_what_is_whole_is_not_touched(person):
    assert find_lives(person, 0.5) == {}
    assert with_lives_joined(person, {}) is person


def test_a_person_in_pieces_has_the_bodies_of_the_whole_one(person):
    lives, of = in_lives(person.markers, np.random.default_rng(9), (0.05, 0.2), (8.0, 15.0))
    labels = tuple(f"*{m}" for m in range(len(of)))
    found = discover(replace(person, markers=lives, labels=labels, residuals=None)).model

    def bodies(model: TopologicalModel, owner: dict[str, str]) -> dict[str, set[str]]:
        return {s.name: {owner[m] for m in s.markers} for s in model.segments}

    owner = {label: person.labels[m] for label, m in zip(labels, of, strict=True)}
    same = {label: label for label in person.labels}
    assert bodies(found, owner) == bodies(discover(person).model, same)
