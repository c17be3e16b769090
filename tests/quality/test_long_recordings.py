"""A long recording is judged by some of its frames: as all of them would."""

from dataclasses import replace

import numpy as np
import pytest

from kinesphere.quality import check_recording, orient
from kinesphere.quality.body import ENOUGH_FRAMES, thinned
from kinesphere.quality.marker_checks import SAMPLED_FRAMES

SHARE = 0.01  # of what some thousand frames say from what all do


@pytest.fixture
def long(walker, rng):
    """Return the walker over and over, twice as long as what is looked at, and a bit."""
    times = -(-(2 * ENOUGH_FRAMES + 7) // walker.n_frames)
    markers = np.tile(walker.markers, (times, 1, 1))
    return replace(walker, markers=markers + rng.normal(scale=1e-4, size=markers.shape))


def test_every_nth_frame_of_a_long_one_and_all_of_a_short_one(long, walker):
    few = thinned(long, ENOUGH_FRAMES)
    assert ENOUGH_FRAMES / 2 < few.n_frames <= ENOUGH_FRAMES
    assert few.n_frames / few.rate == pytest.approx(long.n_frames / long.rate, rel=SHARE)
    assert thinned(walker, ENOUGH_FRAMES) is walker


@pytest.mark.parametrize("mirror", [1.0, -1.0])
def test_orientation_is_that_of_the_short_recording(long, walker, mirror):
    z_up = np.array([[1.0, 0, 0], [0, 0, -mirror], [0, 1, 0]])
    shown = [
        orient(replace(r, markers=r.markers @ z_up.T)).history[-1].findings for r in (long, walker)
    ]
    assert shown[0]["up"] == shown[1]["up"] == "+z"
    assert shown[0]["mirrored"] == shown[1]["mirrored"] == (mirror < 0)
    for name in ("upright_share", "right_handed_share"):
        assert shown[0][name] == pytest.approx(shown[1][name], abs=SHARE)


def test_who_moves_between_the_frames_looked_at_is_not_constant(long):
    column, markers = long.labels.index("STRN"), long.markers.copy()
    markers[:, column] = 1.0
    still = replace(long, markers=markers)
    assert [f.markers for f in check_recording(still) if f.rule == "constant"] == [("STRN",)]
    step = -(-long.n_frames // SAMPLED_FRAMES)
    markers[step + 1, column] = 1.001  # one of the frames that the sample passes over
    moved = replace(long, markers=markers)
    assert not [f for f in check_recording(moved) if f.rule == "constant"]


def test_a_marker_seen_only_between_the_frames_looked_at_is_still_judged(long):
    column, markers = long.labels.index("STRN"), long.markers.copy()
    step = -(-long.n_frames // SAMPLED_FRAMES)
    markers[:, column] = 1.0
    markers[::step, column] = np.nan
    told = check_recording(replace(long, markers=markers))
    assert [f.markers for f in told if f.rule == "constant"] == [("STRN",)]
