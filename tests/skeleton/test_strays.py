"""Sightings far off for a moment change nothing, are told, and the recording keeps them."""

from dataclasses import replace

import numpy as np
import pytest

from kinesphere.data import Recording
from kinesphere.skeleton import discover, fit_skeleton
from kinesphere.skeleton.discovery.size import subject_size
from kinesphere.skeleton.strays import without_strays
from kinesphere.synthetic import HAND, make_performance


@pytest.fixture(scope="module")
def moved(bodies):
    """Return the performance's recording with every 500th sighting 1 m off, and which."""
    rng = np.random.default_rng(3)
    markers = bodies.recording.markers + rng.normal(
        scale=0.001, size=bodies.recording.markers.shape
    )
    off = rng.random(markers.shape[:2]) < 0.002
    way = rng.normal(size=(int(off.sum()), 3))
    clean = replace(bodies.recording, markers=markers)
    spoilt = markers.copy()
    spoilt[off] += way / np.linalg.norm(way, axis=1)[:, None]
    return clean, replace(clean, markers=spoilt), off


def test_skeleton_and_poses_are_those_of_the_same_gaps(bodies, moved):
    clean, spoilt, off = moved
    gaps = replace(clean, markers=np.where(off[..., None], np.nan, clean.markers))
    right, found = (fit_skeleton(r, bodies.model) for r in (gaps, spoilt))
    assert [j.observability for j in found.skeleton.joints] == [
        j.observability for j in right.skeleton.joints
    ]
    np.testing.assert_array_equal(found.joint_centres(), right.joint_centres())
    np.testing.assert_array_equal(found.residuals, right.residuals)
    assert np.nanmax(found.residuals) < 0.01


def test_they_are_told(bodies, moved):
    _, spoilt, off = moved
    kept = spoilt.markers.copy()
    step = fit_skeleton(spoilt, bodies.model).history[-1]
    told = step.findings["stray_sightings"]
    labels = spoilt.labels
    assert {label: one["sightings"] for label, one in told.items()} == {
        labels[c]: off[:, c].sum() for c in np.flatnonzero(off.any(axis=0))
    }
    for label, one in told.items():
        frames = np.flatnonzero(off[:, labels.index(label)]) + spoilt.first_frame
        assert set(one["first_frames"]) <= set(frames.tolist())
        assert one["farthest_mm"] == pytest.approx(1000, abs=25)
    (line,) = [text for text in step.warnings if "off the path" in text]
    assert line.startswith(f"{off.sum():,} sightings are off the path of {len(told)} markers")
    np.testing.assert_array_equal(spoilt.markers, kept)


def test_bodies_and_names_from_motion_alone_are_those_without_them(recorded_alone):
    whole = discover(recorded_alone)
    rng = np.random.default_rng(4)
    markers = recorded_alone.markers.copy()
    off = rng.random(markers.shape[:2]) < 0.01
    way = rng.normal(size=(int(off.sum()), 3))
    markers[off] += way / np.linalg.norm(way, axis=1)[:, None]
    found = discover(replace(recorded_alone, markers=markers))
    assert {frozenset(s.markers) for s in found.model.segments} == {
        frozenset(s.markers) for s in whole.model.segments
    }
    assert {s.name for s in found.model.segments} == {s.name for s in whole.model.segments}


def test_a_marker_once_a_kilometre_away_leaves_bodies_and_names(recorded_alone):
    whole = discover(recorded_alone)
    for where in ((300, 5), (300,)):
        markers = recorded_alone.markers.copy()
        markers[where] += 1e3
        found = discover(replace(recorded_alone, markers=markers))
        assert {s.name: set(s.markers) for s in found.model.segments} == {
            s.name: set(s.markers) for s in whole.model.segments
        }


def test_nothing_is_told_where_nothing_strays(recorded_alone):
    size = subject_size(recorded_alone.markers)
    found, told = without_strays(recorded_alone, size)
    assert found is recorded_alone
    assert told.findings == {}
    assert told.warnings == ()


@pytest.mark.parametrize("plan", [{"plan": HAND}, {}], ids=["hand", "person"])
@pytest.mark.parametrize("rate", [8.0, 12.0, 20.0, 30.0, 50.0])
def test_few_frames_a_second_make_no_strays_of_movement(rate, plan):
    performance = make_performance(np.random.default_rng(4), rate=rate, free_s=20, **plan)
    recording = performance.recording
    bodies = [segment.markers for segment in performance.model.segments]
    found, _ = without_strays(recording, subject_size(recording.markers), bodies)
    assert found is recording


def test_at_few_frames_a_second_bodies_tell(bodies):
    """A movement may leave its path by 0.3 m between two of twelve frames; no body stretches so."""
    slow = bodies.recording.markers[::8].copy()
    slow[20, 3] += [0.0, 0.3, 0.3]
    recording = replace(bodies.recording, markers=slow, rate=bodies.recording.rate / 8)
    size = subject_size(slow)
    assert without_strays(recording, size)[0] is recording
    found, _ = without_strays(recording, size, [s.markers for s in bodies.model.segments])
    assert not found.seen[20, 3]
    assert found.seen.sum() == recording.seen.sum() - 1


@pytest.mark.parametrize("times", [0.001, 1.0, 1000.0])
def test_the_unit_does_not_matter(moved, times):
    _, spoilt, off = moved
    scaled = replace(spoilt, markers=spoilt.markers * times)
    found, _ = without_strays(scaled, subject_size(scaled.markers))
    np.testing.assert_array_equal(found.seen, ~off)


def test_one_sighting_reads_as_one():
    path = np.zeros((30, 4, 3)) + np.arange(4)[:, None] * 0.4
    path[:, :, 0] += np.linspace(0, 0.3, 30)[:, None]
    path[12, 2, 1] += 0.4
    recording = Recording(path, ("a", "b", "c", "d"), 100.0, first_frame=5)
    found, told = without_strays(recording, 0.8)
    assert told.warnings == (
        "1 sighting is off the path that the marker is on just before and after, by up to 400 mm "
        "(c in frame 17): taken for missing, and kept in the files that are written",
    )
    assert not found.seen[12, 2]
    assert found.seen.sum() == 30 * 4 - 1


def test_fingers_tap_as_fast_as_people_move():
    """50 mm there and back in 150 ms at 60 Hz, on a hand."""
    rate, tap = 60.0, 0.025 * (1 - np.cos(2 * np.pi * np.arange(9) / 9))
    grid = np.stack(np.meshgrid(*[np.arange(4) * 0.04] * 2, [0.0]), axis=-1).reshape(16, 3)
    paths = np.repeat(grid[None], 300, axis=0)
    for start in range(20, 280, 40):
        paths[start : start + 9, 5, 2] += tap
    recording = Recording(paths, tuple(map(str, range(16))), rate)
    assert subject_size(paths) < 0.4
    assert without_strays(recording, subject_size(paths))[0] is recording
    paths[150, 9, 2] += 0.5
    found, _ = without_strays(replace(recording, markers=paths), subject_size(paths))
    assert not found.seen[150, 9]
