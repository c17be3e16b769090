"""Points without identity: followed from frame to frame, labelled live and in a file."""

from concurrent.futures import Future
from dataclasses import replace

import numba
import numpy as np
import pytest

from kinesphere.errors import BadModel, BadSetting
from kinesphere.labelling import LiveLabeller, label
from kinesphere.labelling.crowd import followed, is_crowd, taken
from kinesphere.labelling.lock_on import SLICE

slow_in_python = pytest.mark.skipif(
    bool(numba.config.DISABLE_JIT), reason="a search in plain Python takes minutes"
)

FREE = 1000  # frames in which the actor moves one joint after the other; then all at once


def crowds_of(markers, rng, n_ghosts=0):
    """Return the points of each frame in an order of its own, and which marker each is."""
    frames, truth = [], []
    for frame in markers:
        ghosts = rng.uniform(3, 9, size=(n_ghosts, 3))
        order = rng.permutation(len(frame) + n_ghosts)
        frames.append(np.concatenate([frame, ghosts])[order])
        seen = np.isfinite(frames[-1][:, 0])
        truth.append(np.where((order < len(frame)) & seen, order, -1))
    return frames, truth


class TestFollowing:
    def test_points_far_apart_are_followed_for_good(self, rng):
        t = np.arange(200)[:, None] / 100
        ways = np.stack([np.hstack([np.sin(t + k), t, 0 * t + 2 * k]) for k in range(4)], axis=1)
        frames, truth = crowds_of(ways, rng)
        source = followed(frames, 100.0)
        assert source.shape == (200, 4)
        who = np.array([[truth[f][k] for k in row] for f, row in enumerate(source)])
        assert (who == who[0]).all()

    def test_every_point_is_in_one_column(self, legs, rng):
        frames, _ = crowds_of(legs[1].markers[:50], rng, 3)
        source = followed(frames, legs[1].rate)
        for frame, row in zip(frames, source, strict=True):
            assert sorted(row[row >= 0]) == list(range(len(frame)))
        points = taken(frames, source)
        assert np.isfinite(points).all(axis=2).sum() == sum(map(len, frames))

    def test_a_gap_ends_a_trajectory(self):
        still = np.zeros((9, 1, 3))
        still[4] = np.nan
        source = followed(list(still), 100.0)
        assert (source[4] == -1).all()
        assert ((source >= 0).sum(axis=1) == [1, 1, 1, 1, 0, 1, 1, 1, 1]).all()

    def test_where_two_would_do_nobody_is_followed(self):
        frames = [np.array([[0.0, 0, 0]]), np.array([[0.012, 0, 0], [-0.012, 0, 0]])]
        source = followed(frames, 100.0)
        assert source.shape[1] == 3

    def test_nothing_is_nothing(self):
        assert followed([np.empty((0, 3))] * 3, 100.0).shape == (3, 0)

    def test_columns_that_mean_nothing_are_seen(self, legs, rng):
        markers = legs[1].markers[:60]
        assert not is_crowd(markers, legs[1].rate)
        assert is_crowd(np.array(crowds_of(markers, rng)[0]), legs[1].rate)


@slow_in_python
def test_a_file_of_points_in_changing_order_is_labelled(legs, rng):
    model, recording = legs
    frames, _ = crowds_of(recording.markers, rng)
    raw = replace(
        recording,
        markers=np.array(frames),
        labels=tuple(f"*{i}" for i in range(recording.n_markers)),
    )
    found = label(raw, model)
    right = wrong = 0
    for name in set(found.labels) & set(recording.labels):
        given = found.markers[:, found.labels.index(name)]
        same = (given == recording.markers[:, recording.labels.index(name)]).all(axis=1)
        right += same.sum()
        wrong += (np.isfinite(given[:, 0]) & ~same).sum()
    assert right > 0.97 * recording.seen.sum()
    assert wrong < 0.005 * right


class TestLiveLabeller:
    @slow_in_python
    @pytest.mark.parametrize("background", [False, True])
    def test_it_locks_on_and_follows(self, legs, rng, background):
        model, recording = legs
        live = LiveLabeller(model, recording.rate, 8.0, background=background)
        frames, truth = crowds_of(recording.markers[FREE:], rng, 2)
        wrong = right = 0
        for frame, true in zip(frames, truth, strict=True):
            given = live.label(frame)
            if live.locked_on:
                right += ((given >= 0) & (given == true)).sum()
                wrong += ((given >= 0) & (given != true)).sum()
            elif background and live._pending is not None:
                live._pending.result()  # as slow as frames come in life
            else:
                assert (given < 0).all()
        live.close()
        assert live.locked_on
        assert live.note == ""
        assert wrong == 0
        assert right > 0.98 * recording.n_markers * (len(frames) - 401)

    @slow_in_python
    def test_frames_that_waited_are_made_up_for_in_slices(self, legs, rng):
        model, recording = legs
        live = LiveLabeller(model, recording.rate, 8.0)
        frames, truth = crowds_of(recording.markers[FREE:], rng)
        coming = zip(frames, truth, strict=True)
        while live._pending is None:
            live.label(next(coming)[0])
        recognised, live._pending = live._pending.result(), Future()
        waiting = 3 * SLICE
        for _ in range(waiting):
            assert (live.label(next(coming)[0]) < 0).all()
        live._pending.set_result(recognised)
        calls = 0
        while not live.locked_on or live._behind:
            frame, true = next(coming)
            behind = len(live._behind) if live.locked_on else waiting
            given = live.label(frame)
            assert behind + 1 - len(live._behind) <= SLICE
            assert (given < 0).all() == bool(live._behind)
            calls += 1
        live.close()
        assert calls == 4
        assert (given == true).mean() > 0.9

    @slow_in_python
    def test_a_body_that_left_is_waited_for(self, legs):
        model, recording = legs
        live = LiveLabeller(model, recording.rate, 8.0, background=False)
        for frame in recording.markers[FREE : FREE + 450]:
            live.label(frame)
        assert live.locked_on
        for _ in range(150):
            live.label(np.empty((0, 3)))
        assert not live.locked_on
        assert "lost" in live.note

    @slow_in_python
    def test_no_body_is_said(self, legs, rng):
        live = LiveLabeller(legs[0], 50.0, 1.0, background=False)
        for _ in range(60):
            given = live.label(rng.normal(size=(14, 3)))
        assert (given < 0).all()
        assert not live.locked_on
        assert live.note != "waiting for 1 s of motion"

    @pytest.mark.parametrize(("rate", "seconds"), [(0.0, 5.0), (np.nan, 5.0), (100.0, -1.0)])
    def test_nonsense_is_refused(self, legs, rate, seconds):
        with pytest.raises(BadSetting, match="more than nothing"):
            LiveLabeller(legs[0], rate, seconds)

    def test_a_model_without_statistics_is_refused(self, legs):
        with pytest.raises(BadModel, match="no statistics"):
            LiveLabeller(replace(legs[0], statistics=()), 100.0)
