"""The markerless benchmark measures what it says, and its page is made of outcomes alone."""

from dataclasses import replace

import numpy as np
import pytest

pytest.importorskip("cv2")
pytest.importorskip("av")

from benchmarks.markerless.measures import errors_of
from benchmarks.markerless.page import page
from benchmarks.markerless.real import NAMES, RealOutcome
from benchmarks.markerless.rendered import CASES, Case, Outcome
from benchmarks.markerless.store import keep, kept

from kinesphere.synthetic.film import make_film


@pytest.fixture(scope="module")
def film():
    return make_film(1, "arms", size=(32, 24), n_frames=10)


def test_the_truth_has_no_error(film, tracked_film):
    errors = errors_of(tracked_film(film), film)
    assert errors.elbow_rms < 1e-6
    assert errors.joints_p95 < 1e-6
    assert errors.frames_astray == 0


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
    good = errors_of(tracked_film(film), film)
    bad = replace(good, elbow_rms=3.0)
    case = Case("a case", "arms", seeds=(1, 2), rms=2.3)
    films = [Outcome(case, 1, 300, good), Outcome(case, 2, 120, bad)]
    assert [outcome.missed for outcome in films] == [False, True]
    text = page(films, [RealOutcome("real", failed="nobody there")])
    assert "| 120 to 300 | 1, 2 |" in text
    assert "| 3.00° (2.3°) |" in text
    assert "**missed**" in text
    assert "nobody there" in text
    lost = Outcome(case, 1, 300, None, "the person was not found")
    assert lost.missed
    assert "the person was not found" in page([lost], [])


def test_wrists_count_where_the_folder_has_them():
    near = RealOutcome(
        NAMES[0], overlap=0.9, overlap_wanted=0.8, wrists_near=0.99, wrists_wanted=0.95
    )
    assert near.missed  # whether hands are held lost is not known
    assert replace(near, wrists_found=0.91).missed
    assert not replace(near, wrists_found=0.96).missed
    text = page([], [replace(near, wrists_found=0.91)])
    assert "| 99 % | 91 % (95 %) |" in text
    assert "masks of one frame" in text


def test_one_case_measured_anew_leaves_the_others(film, tracked_film, tmp_path):
    good = errors_of(tracked_film(film), film)
    path = tmp_path / "kept.json"
    first, second = CASES[0], CASES[2]
    assert kept(path) == ([], [])
    keep([Outcome(second, 1, 300, good), Outcome(first, 1, 300, good)], [], path)
    keep([], [RealOutcome(NAMES[1], overlap=0.7, overlap_wanted=0.8)], path)
    anew = Outcome(first, 1, 20, replace(good, elbow_rms=9.0))
    films, real = keep([anew], [], path)
    assert films == [anew, Outcome(second, 1, 300, good)]
    assert [(one.name, one.missed) for one in real] == [(NAMES[1], True)]
    text = page(films, real)
    assert "Not run: push-ups, true shape; " in text
    assert f"Not run: {NAMES[0]}; {NAMES[2]}" in text
    # what was measured under other limits is no result of this case
    path.write_text(path.read_text().replace('"rms": 1.2', '"rms": 1.3'))
    assert [outcome.case for outcome in kept(path)[0]] == [second]
