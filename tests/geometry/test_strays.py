"""Who leaves and comes back within a moment strays; who moves does not."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from kinesphere.geometry.strays import find_strays, find_strays_of_body

RATE = 100.0
LEAST = 0.05  # m


@pytest.fixture
def paths(rng):
    """Return four markers that go about smoothly at up to 3 m/s, with 1 mm noise, (300, 4, 3) m."""
    t = np.arange(300)[:, None, None] / RATE
    swing = 0.3 * np.sin(2 * np.pi * rng.uniform(0.2, 1.5, (4, 3)) * t + rng.uniform(0, 6, (4, 3)))
    return swing + rng.normal(scale=0.001, size=(300, 4, 3))


def strays_at(paths, frames, column=1):
    expected = np.zeros(paths.shape[:2], dtype=bool)
    expected[frames, column] = True
    return expected


RUNS = [
    (first, length)
    for first in (0, 1, 2, 100, 299)
    for length in (1, 2, 3, 5, 10)
    if first >= 2 or length <= 3  # of longer ones at the beginning nothing says where they are from
]


@pytest.mark.parametrize(("first", "length"), RUNS)
def test_a_run_that_is_elsewhere_strays(paths, first, length):
    last = min(first + length, 300)
    paths[first:last, 1] += [0.4, -0.2, 0.4]
    np.testing.assert_array_equal(
        find_strays(paths, RATE, LEAST), strays_at(paths, slice(first, last))
    )


def test_frames_that_are_each_somewhere_else_stray(paths, rng):
    way = rng.normal(size=(4, 3))
    paths[100:104, 1] += 0.5 * way / np.linalg.norm(way, axis=1)[:, None]
    np.testing.assert_array_equal(
        find_strays(paths, RATE, LEAST), strays_at(paths, slice(100, 104))
    )


def test_strays_close_together_are_found(paths, rng):
    frames = [100, 102, 105, 106, 108, 111]
    way = rng.normal(size=(6, 3))
    paths[frames, 1] += 0.5 * way / np.linalg.norm(way, axis=1)[:, None]
    np.testing.assert_array_equal(find_strays(paths, RATE, LEAST), strays_at(paths, frames))


def test_a_stray_beside_a_gap_is_found(paths):
    paths[100:105, 1] = np.nan
    paths[105, 1] += 0.3
    paths[99, 1] -= 0.3
    np.testing.assert_array_equal(find_strays(paths, RATE, LEAST), strays_at(paths, [99, 105]))


def test_who_goes_and_stays_does_not_stray(paths):
    paths[100:, 1] += 0.5
    paths[200:211, 2] += 0.5  # eleven frames: longer than a tenth of a second
    assert not find_strays(paths, RATE, LEAST).any()


@pytest.mark.parametrize(
    ("rate", "longest"), [(4.0, 1), (12.0, 1), (50.0, 5), (100.0, 10), (240.0, 10)]
)
def test_runs_last_a_tenth_of_a_second_in_one_to_ten_frames(rate, longest):
    for more in (0, 1):
        still = np.zeros((60, 1, 3))
        still[20 : 20 + longest + more] = [0.0, 0.3, 0.0]
        assert find_strays(still, rate, LEAST).sum() == (0 if more else longest)


def test_a_punch_there_and_back_does_not_stray():
    t = np.arange(-0.5, 0.5, 1 / 50)
    punch = np.zeros((len(t), 1, 3))
    punch[:, 0, 0] = 0.6 * np.exp(-((t / 0.06) ** 2))  # 9 m/s, 300 m/s², there and back in 0.2 s
    assert not find_strays(punch, 50.0, LEAST).any()


def test_who_stops_at_the_first_or_last_frame_does_not_stray():
    kick = np.zeros((40, 1, 3))
    kick[0, 0, 0] = 0.25  # 3 m/s at 12 Hz, and rest
    assert not find_strays(kick, 12.0, LEAST).any()
    assert not find_strays(kick[::-1], 12.0, LEAST).any()


def test_a_stop_in_one_frame_does_not_stray():
    fall = np.zeros((100, 1, 3))
    fall[:, 0, 1] = np.maximum(5.0 - 0.06 * np.arange(100), 2.0)  # 6 m/s, and the floor
    assert not find_strays(fall, RATE, LEAST).any()


@pytest.mark.parametrize("scale", [0.05, 0.3])
def test_noise_cloth_and_walks_do_not_stray(rng, scale):
    noise = rng.normal(scale=scale, size=(2000, 5, 3))
    assert not find_strays(noise, RATE, LEAST).any()
    walk = np.cumsum(rng.normal(scale=scale / 10, size=(2000, 5, 3)), axis=0)
    assert not find_strays(walk, RATE, LEAST).any()


def test_time_order_and_turns_do_not_matter(rng):
    t = np.arange(600)[:, None, None] / RATE
    paths = 0.4 * np.sin(2 * np.pi * rng.uniform(0.5, 3, (6, 3)) * t)
    off = rng.random(paths.shape[:2]) < 0.05
    paths[off] += rng.normal(scale=0.2, size=(int(off.sum()), 3))
    paths[rng.random(paths.shape[:2]) < 0.1] = np.nan
    found = find_strays(paths, RATE, LEAST)
    assert found.sum() > 50
    np.testing.assert_array_equal(find_strays(paths[::-1], RATE, LEAST)[::-1], found)
    order = rng.permutation(6)
    np.testing.assert_array_equal(find_strays(paths[:, order], RATE, LEAST), found[:, order])
    turned = paths @ Rotation.from_rotvec([0.3, -1.2, 2.0]).as_matrix().T + [5.0, 1.0, -3.0]
    np.testing.assert_array_equal(find_strays(turned, RATE, LEAST), found)
    np.testing.assert_array_equal(find_strays(1e3 * paths, RATE, 1e3 * LEAST), found)


def test_nothing_is_made_of_little():
    for n_frames in range(6):
        assert not find_strays(np.ones((n_frames, 3, 3)), RATE, LEAST).any()
    assert find_strays(np.zeros((10, 0, 3)), RATE, LEAST).shape == (10, 0)
    assert not find_strays(np.full((50, 2, 3), np.nan), RATE, LEAST).any()


@pytest.fixture
def kicked(rng):
    """Return a body of four at 12 Hz that a foot may be in a kick, (200, 4, 3) m."""
    shape = rng.normal(scale=0.08, size=(4, 3))
    t = np.arange(200) / 12
    turns = Rotation.from_rotvec(np.outer(1.5 * np.sin(4 * t), [0.2, 0.1, 0.9])).as_matrix()
    way = 0.8 * np.stack([np.sin(5 * t), np.cos(4 * t), np.sin(3 * t)], axis=1)
    return np.einsum("fij,mj->fmi", turns, shape) + way[:, None]


def test_a_body_shows_what_strays_in_a_fast_movement(kicked):
    kicked[100, 2] += [0.12, 0.1, -0.1]
    assert not find_strays(kicked, 12.0, LEAST).any()
    np.testing.assert_array_equal(
        find_strays_of_body(kicked, 12.0, LEAST / 2), strays_at(kicked, [100], 2)
    )


def test_a_body_shows_what_strays_at_an_end(kicked):
    kicked[0, 2] += [0.3, 0.2, -0.3]
    assert not find_strays(kicked, 12.0, LEAST).any()
    np.testing.assert_array_equal(
        find_strays_of_body(kicked, 12.0, LEAST / 2), strays_at(kicked, [0], 2)
    )


def test_a_body_that_moves_shows_none(kicked, rng):
    assert not find_strays_of_body(kicked, 12.0, LEAST / 2).any()
    loose = kicked + 0.1 * np.sin(np.arange(200) / 6)[:, None, None] * rng.normal(size=(4, 3))
    assert not find_strays_of_body(loose, 12.0, LEAST / 2).any()
    kicked[80:, 1] += 0.3  # it slipped, or is another's: told elsewhere
    assert not find_strays_of_body(kicked, 12.0, LEAST / 2).any()


def test_two_markers_do_not_tell_which_strays(kicked):
    kicked[100, 1] += 0.3
    assert not find_strays_of_body(kicked[:, :2], 12.0, LEAST / 2).any()
