"""Which markers count, and what is refused because nothing can be told from it."""

import numpy as np
import pytest

from kinesphere.errors import BadRecording, DegenerateMotion
from kinesphere.geometry.lifetimes import longest_runs, worth_grouping
from kinesphere.skeleton.discovery.rigidity import (
    MOST_TRIMMED,
    measure_rigidity,
    trimmed_share,
)

RATE = 50.0


def test_reflections_are_told_from_markers_by_how_long_they_stay():
    seen = np.ones((500, 5), dtype=bool)
    seen[::4, 0] = False  # gaps everywhere, never half a second at a stretch
    seen[:, 1] = False
    seen[100:115, 1] = True  # a reflection of 0.3 s
    seen[:, 2] = False  # never seen
    seen[50:90, 3] = False  # an honest gap
    assert worth_grouping(seen, RATE, 0.5).tolist() == [True, False, False, True, True]
    assert worth_grouping(seen, RATE, 0.0).tolist() == [True, False, False, True, True]


def test_a_marker_that_blinks_while_it_is_around_is_no_reflection():
    seen = np.zeros((1000, 4), dtype=bool)
    seen[:, 3] = True
    seen[0:150, 0] = True
    seen[0:150:3, 0] = False  # a third missing, one frame at a time
    seen[0:150, 1] = True
    for start in range(0, 150, 15):  # gone for 0.2 s at a time: ten reflections
        seen[start : start + 10, 1] = False
    for start in range(0, 1000, 50):  # 20 reflections, each of 0.3 s
        seen[start : start + 15, 2] = True
    assert worth_grouping(seen, RATE, 0.5).tolist() == [True, False, False, True]


@pytest.mark.parametrize("share", [0.05, 0.3])
def test_samples_missing_at_random_make_no_reflections(rng, share):
    seen = rng.random((300, 41)) > share
    assert worth_grouping(seen, 100.0, 0.5).all()


def test_a_recording_shorter_than_two_ghosts_keeps_its_markers():
    assert worth_grouping(np.ones((12, 4), dtype=bool), RATE, 0.5).all()


def test_longest_runs_count_the_ends():
    seen = np.array([[1, 0, 1], [1, 0, 0], [0, 0, 1], [1, 0, 1]], dtype=bool)
    assert longest_runs(seen).tolist() == [2, 0, 2]
    assert longest_runs(seen, 1).tolist() == [4, 0, 4]


def test_what_a_reflection_lives_is_trimmed_and_no_more():
    assert trimmed_share(50.0, 0.5) == pytest.approx(0.01)
    assert trimmed_share(480.0, 0.5) == pytest.approx(0.5 / 480)
    assert trimmed_share(3.0, 0.5) == MOST_TRIMMED
    assert trimmed_share(10.0, 0.5) == trimmed_share(10.0, 40.0) == MOST_TRIMMED
    assert trimmed_share(10.0, 0.0) == 0.0


def test_a_joint_that_bends_for_a_few_seconds_of_a_minute_shows(rng):
    """Two markers, 0.2 m apart, come 50 mm nearer for 4 s; a reflection takes 0.4 s of a third."""
    n = int(60 * RATE)
    points = rng.normal(scale=0.001, size=(n, 4, 3))
    points += np.array([[0.0, 0, 0], [0.2, 0, 0], [0.1, 0.1, 0], [0.1, 0, 0.15]])
    bend = slice(1000, 1000 + int(4 * RATE))
    points[bend, 1, 0] -= 0.05 * np.sin(np.linspace(0, np.pi, int(4 * RATE)))
    points[2000:2020, 2, 1] += 0.3
    points += np.linspace(0.0, 2.0, n)[:, None, None]  # they walk as they do it
    hidden = measure_rigidity(points, trim=0.05).wander
    shown = measure_rigidity(points, trim=trimmed_share(60.0, 0.5)).wander
    steady = shown[0, 3]
    assert hidden[0, 1] < 3 * steady
    assert shown[0, 1] > 5 * steady
    assert shown[0, 2] < 1.5 * steady  # the reflection does not


def test_noise_is_what_steady_distances_wander_by(rng, moving_bodies):
    points, _ = moving_bodies(rng, (4, 3, 5), noise=0.001)
    rigidity = measure_rigidity(points)
    assert rigidity.noise == pytest.approx(0.001, rel=0.2)  # √2 σ of two ends, 0.79 for trimming
    assert not rigidity.is_one_body


def test_who_stands_still_is_told_to_move(rng):
    points = rng.normal(size=(1, 9, 3)) + rng.normal(scale=3e-4, size=(80, 9, 3))
    with pytest.raises(DegenerateMotion, match="hardly move relative to each other"):
        measure_rigidity(points)


def test_one_rigid_thing_on_its_way_is_one_body(rng, moving_bodies):
    points, _ = moving_bodies(rng, (6,), noise=3e-4)
    assert measure_rigidity(points).is_one_body


@pytest.mark.parametrize("size", [3, 4, 5, 8])
def test_a_thing_rigid_to_the_last_bit_is_one_body(rng, moving_bodies, size):
    points, _ = moving_bodies(rng, (size,))
    assert measure_rigidity(points).is_one_body
    assert measure_rigidity(points.astype(np.float32).astype(float) + 40.0).is_one_body


def test_what_cannot_be_resolved_is_no_wander(rng, moving_bodies):
    points, of = moving_bodies(rng, (4, 3))
    rigidity = measure_rigidity(points)
    within = (of[:, None] == of) & ~np.eye(7, dtype=bool)
    assert np.ptp(rigidity.wander[within]) < 1e-9  # no pattern of rounding errors
    assert 1e-6 < rigidity.noise < 3e-5  # m, of bodies half a metre apart
    assert not rigidity.is_one_body


def test_frames_that_are_all_the_same_hold_no_motion(rng):
    points = np.repeat(rng.normal(size=(1, 20, 3)), 500, axis=0)
    points[:250, 3] = np.nan
    points[250:, 4] = np.nan  # never seen with the other
    with pytest.raises(DegenerateMotion, match="nothing tells one body from another"):
        measure_rigidity(points)


@pytest.mark.parametrize("shape", [(200, 2), (9, 12)])
def test_too_little_is_refused(rng, shape):
    with pytest.raises(BadRecording, match=r"at least 3 markers in 10 frames"):
        measure_rigidity(rng.normal(size=(*shape, 3)))


def test_markers_never_seen_together_are_refused(rng):
    points = np.full((90, 3, 3), np.nan)
    for m in range(3):
        points[30 * m : 30 * m + 30, m] = rng.normal(size=(30, 3))
    with pytest.raises(BadRecording, match="no two markers"):
        measure_rigidity(points)


@pytest.mark.parametrize(("wobble", "one"), [(2.5, True), (7.0, False)])
def test_what_wanders_little_more_than_noise_is_one_body(rng, moving_bodies, wobble, one):
    """Half of a body comes and goes: twice and five times what its steadiest distances wander."""
    noise = 0.001
    points, _ = moving_bodies(rng, (6,), noise=noise, n_frames=1000)
    points[:, 3:] += wobble * noise * rng.normal(size=(len(points), 1, 3))
    assert measure_rigidity(points).is_one_body == one


def test_markers_that_keep_no_distance_are_not_told_to_move(rng):
    points = rng.normal(size=(80, 9, 3))
    with pytest.raises(DegenerateMotion, match="no markers keep their distances"):
        measure_rigidity(points)
