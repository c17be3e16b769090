"""The markerless benchmark measures what it says, and its page is made of outcomes alone."""

from dataclasses import replace

import numpy as np
import pytest

pytest.importorskip("cv2")
pytest.importorskip("av")

from benchmarks.markerless.measures import errors_of
from benchmarks.markerless.page import page
from benchmarks.markerless.real import RealOutcome
from benchmarks.markerless.rendered import Case, Outcome

from kinesphere.synthetic.film import make_film


@pytest.fixture(scope="module")
def film():
    return make_film(1, "arms", size=(32, 24), n_frames=10)


def test_the_truth_has_no_error(film, tracked_film):
    errors = errors_of(replace(tracked_film(film), seconds={"tracking": 2.0}), film)
    assert errors.elbow_rms < 1e-6
    assert errors.joints_p95 < 1e-6
    assert errors.frames_astray == 0
    assert errors.frames_per_s == pytest.approx(5.0)


def test_known_errors_are_found(film, tracked_film):
    tracked = tracked_film(film)
    origins = tracked.origins + np.array([0.003, 0.0, 0.004])
    hand = tracked.limb_names.index("left_hand")
    origins[4:7, hand, 1] += 0.4
    parameters = tracked.parameters.copy()
    parameters[9] = np.nan
    errors = errors_of(replace(tracked, origins=origins, parameters=parameters), film)
    assert errors.frames_astray == 3
    assert errors.frames_unsolved == 1
    assert errors.joints_mean > 5
    assert errors.elbow_rms < 1e-6  # the hand's place is no part of the elbow's angle
    forearm = tracked.limb_names.index("right_forearm")
    ends = tracked.ends.copy()
    ends[forearm] *= 1.5
    assert errors_of(replace(tracked, ends=ends), film).elbow_rms < 1e-6  # nor is a length


def test_the_page_shows_the_worst_seed_and_what_was_missed(film, tracked_film):
    good = errors_of(replace(tracked_film(film), seconds={"tracking": 2.0}), film)
    bad = replace(good, elbow_rms=3.0)
    case = Case("a case", "arms", seeds=(1, 2), rms=2.3)
    films = [Outcome(case, 1, good), Outcome(case, 2, bad)]
    assert [outcome.missed for outcome in films] == [False, True]
    text = page(films, [RealOutcome("real", failed="nobody there")], 300)
    assert "| 3.00° (2.3°) |" in text
    assert "**missed**" in text
    assert "nobody there" in text
    lost = Outcome(case, 1, None, "the person was not found")
    assert lost.missed
    assert "the person was not found" in page([lost], [], 300)
