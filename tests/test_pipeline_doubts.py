"""What the line says before its stages can notice that something is off."""

from dataclasses import replace
from itertools import combinations

import numpy as np
import pytest
from benchmarks.accuracy.one_movement import ALL, DISTAL, NONE, one_movement

from kinesphere.data import Recording, Step
from kinesphere.errors import BadRecording, DegenerateMotion
from kinesphere.pipeline import settings_from, solve
from kinesphere.pipeline.doubts import OTHER_PERSON, lengths_apart, with_checks
from kinesphere.pipeline.motion_alone import _with_names_doubted
from kinesphere.skeleton.landmarks import BETWEEN, STEADY
from kinesphere.synthetic import make_performance


@pytest.fixture(scope="module")
def performance():
    return make_performance(
        np.random.default_rng(3), layout="cmu41", rate=10.0, calibration_s=20.0, free_s=2.0
    )


@pytest.fixture(scope="module")
def solution(performance):
    return solve(performance.recording)


def scaled(recording, factor):
    return replace(recording, markers=recording.markers * factor)


@pytest.mark.parametrize("factor", [1e-3, 1e3])
def test_a_body_of_impossible_size_is_a_matter_of_units(performance, factor):
    with pytest.raises(BadRecording, match=r"feet and head are .* m apart.*length unit"):
        solve(scaled(performance.recording, factor))


def test_what_checks_find_is_among_the_warnings(performance, solution):
    assert "checks" not in [step.name for step in solution.history]
    markers = np.array(performance.recording.markers)
    markers[:, 5] = markers[:, 6] + 1e-6
    same = solve(replace(performance.recording, markers=markers))
    assert [step.name for step in same.history].count("checks") == 1
    labels = [performance.recording.labels[i] for i in (5, 6)]
    assert any(all(label in warning for label in labels) for warning in same.warnings)


def bare(recording, share):
    """Return a recording without labels, with a share of its positions written as zero."""
    rng, markers = np.random.default_rng(1), recording.markers.copy()
    markers[rng.random(markers.shape[:2]) < share] = 0
    labels = tuple(f"*{c}" for c in range(recording.n_markers))
    return replace(recording, markers=markers, labels=labels)


def test_zeros_are_named_before_motion_alone_fails_on_them(performance):
    zeros = bare(performance.recording, 0.99)
    with pytest.raises(BadRecording, match=r"^41 markers are exactly at the origin in .*: "
                       r"export missing markers as missing .*; as it is, 0 of 41 markers are "
                       r"seen for long enough"):  # fmt: skip
        solve(zeros, "none")


def test_zeros_are_gaps_where_motion_alone_is_to_tell_the_bodies(performance):
    zeros = bare(performance.recording, 0.05)
    gaps = replace(zeros, markers=np.where(zeros.markers == 0, np.nan, zeros.markers))
    found, expected = solve(zeros, "none"), solve(gaps, "none")
    assert found.motion.skeleton.limb_names == expected.motion.skeleton.limb_names
    np.testing.assert_array_equal(found.motion.origins, expected.motion.origins)
    (told,) = (w for w in found.warnings if "at the origin" in w)
    assert told.startswith("41 markers are exactly at the origin in ")
    assert told.endswith("likely missing, written as zero: taken for missing")
    assert not any("at the origin" in warning for warning in expected.warnings)


def test_motion_alone_fails_without_a_word_of_zeros_where_there_are_none(performance):
    still = replace(
        bare(performance.recording, 0.0),
        markers=np.repeat(performance.recording.markers[:1], 50, axis=0),
    )
    with pytest.raises(DegenerateMotion, match=r"^the markers hardly move"):
        solve(still, "none")


def test_zeros_of_unlabelled_trajectories_are_one_warning(performance):
    told = with_checks(bare(performance.recording, 0.02)).history[-1]
    (line,) = told.warnings
    assert line.startswith("41 markers are exactly at the origin in ")
    assert len(told.findings["found"]) == 41


def test_fragments_of_a_raw_stream_are_one_line_of_gaps(performance):
    recording = performance.recording
    n = recording.n_frames
    pieces = np.full((n, 4 * recording.n_markers, 3), np.nan)
    for k in range(4):
        at = slice(k * n // 4, (k + 1) * n // 4)
        pieces[at, k :: 4] = recording.markers[at]  # fmt: skip
    raw = Recording(pieces, tuple(f"*{c}" for c in range(pieces.shape[1])), recording.rate)
    (line,) = with_checks(raw).history[-1].warnings
    assert line.startswith("164 markers are missing in 7")


@pytest.mark.parametrize("times", [1e-3, 1e3])
def test_checks_are_those_of_the_true_size_where_it_is_known(performance, times):
    recording = performance.recording
    markers = np.concatenate([recording.markers, recording.markers[:, :1]], axis=1)
    markers[50, 3] += 3.0  # a jump of 5.2 m
    labels = tuple(f"*{c}" for c in range(markers.shape[1]))
    labels = ("A", "B", "C", "D", *labels[4:-1], "copy")
    true = Recording(markers, labels, recording.rate)
    expected = set(with_checks(true).history[-1].warnings)
    assert any("jump" in w for w in expected)
    assert any("A and copy" in w for w in expected)
    other = with_checks(replace(true, markers=times * markers), times).history[-1].warnings
    assert expected < set(other)
    (unit,) = set(other) - expected
    assert "check the length unit" in unit


def test_a_window_beyond_the_end_is_said(performance, solution):
    assert not [w for w in solution.warnings if "window" in w]
    beyond = solve(performance.recording, calibration=(0.0, 600.0))
    assert any("0:600 s reaches beyond the recording, which lasts 22.00 s" in w
               for w in beyond.warnings)  # fmt: skip
    within = solve(performance.recording, calibration=(0.0, 22.0))
    assert not [w for w in within.warnings if "reaches beyond" in w]


def test_axes_of_a_body_of_another_size_are_doubted(performance, solution):
    mine = solve(performance.recording, calibration_from=solution)
    assert not [w for w in mine.warnings if "one person only" in w]
    other = solve(scaled(performance.recording, 1.15), calibration_from=solution)
    assert any("limbs differ by 15% (median)" in w for w in other.warnings)


def test_a_length_nobody_measured_tells_no_person(solution):
    """Centres between the markers are elsewhere in every trial; landmarks and motion are not."""
    skeleton = solution.skeleton
    longer = replace(
        skeleton, limbs=tuple(replace(limb, length=1.1 * limb.length) for limb in skeleton.limbs)
    )
    assert lengths_apart(skeleton, skeleton) == 0.0
    assert lengths_apart(skeleton, longer) == pytest.approx(1 - 1 / 1.1)

    def guessed(*names, place=BETWEEN, observability="undetermined"):
        return replace(
            longer,
            joints=tuple(
                replace(joint, observability=observability, note=f"placed by expectation ({place})")
                if joint.name in names
                else replace(joint, observability="determined", note="")
                for joint in longer.joints
            ),
        )

    every = skeleton.joint_names
    assert lengths_apart(skeleton, guessed("left_knee")) == pytest.approx(1 - 1 / 1.1)
    assert lengths_apart(guessed(*every), skeleton) is None
    assert lengths_apart(skeleton, guessed(*every, place=STEADY)) is None
    assert lengths_apart(skeleton, guessed(*every, observability="hinge")) is None
    told = lengths_apart(skeleton, guessed(*every, place="middle of the epicondyle markers"))
    assert told == pytest.approx(1 - 1 / 1.1)
    thigh = guessed("left_knee")
    off = {"left_thigh": 1.5, "left_shank": 1.5}
    limbs = tuple(
        replace(limb, length=off.get(limb.name, 1.0) * its.length)
        for limb, its in zip(thigh.limbs, skeleton.limbs, strict=True)
    )
    assert lengths_apart(skeleton, replace(thigh, limbs=limbs)) == 0.0


@pytest.mark.slow
def test_one_person_is_one_person_whatever_a_trial_moves():
    """The truth is one actor, whom a trial about one axis of each joint measures 9–13 % off."""
    layout = make_performance(np.random.default_rng(710), rate=12.0, calibration_s=60.0, free_s=0.0)
    trials = [one_movement(layout, about, 4.0, 9 + about) for about in (DISTAL, NONE, ALL)]
    skeletons = [solve(trial, layout.model).skeleton for trial in trials]
    for one, other in combinations(skeletons, 2):
        off = lengths_apart(one, other)
        assert off is None or off < OTHER_PERSON
    taller = solve(scaled(trials[-1], 1.1), layout.model).skeleton
    assert lengths_apart(skeletons[-1], taller) > OTHER_PERSON


# --- names of a body that never stands ---


@pytest.fixture
def doubted(solution):
    """Return the warnings about names for a body that found names and whose trunk leans so far."""

    def told(tilt, sure=0.7):
        terms = {} if tilt is None else {"trunk_tilt_deg": tilt}
        motion = replace(
            solution.motion,
            history=(
                Step("discovery", findings={"names_confidence": sure}),
                Step("normalization", findings={"terms": terms}),
            ),
        )
        after = _with_names_doubted(motion)
        return [w for step in after.history for w in step.warnings]

    return told


def test_names_of_a_body_that_never_stands_are_doubted(doubted):
    (told,) = doubted(96.0)
    assert "never stands like a person (its trunk is 96 deg off upright" in told
    assert doubted(170.0)


def test_who_stands_sits_or_has_no_names_is_not_doubted(doubted):
    assert not doubted(20.0)
    assert not doubted(None)
    assert not doubted(96.0, sure=None)


def test_a_person_who_only_lies_is_told_that_names_from_motion_may_be_wrong():
    """The same movements with the world turned under them; a model's labels are not in doubt."""
    performance = make_performance(np.random.default_rng(7), rate=25, calibration_s=40, free_s=10)
    recording = performance.recording
    lying = np.array(recording.markers)[..., [1, 0, 2]] * [1.0, -1.0, 1.0]  # about z, by 90 deg
    alone = replace(recording, markers=lying)
    settings = settings_from({"orientation": {"up": "+y"}})
    solved = solve(alone, "none", settings=settings)
    assert sum("never stands like a person" in w for w in solved.warnings) == 1
    standing = solve(recording, "none")
    assert not any("never stands" in w for w in standing.warnings)
