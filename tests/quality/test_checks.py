"""One thing made wrong at a time: it is found, and named with marker and frame; nothing else is."""

import json
from dataclasses import replace

import numpy as np
import pytest

from kinesphere.data import Recording
from kinesphere.quality import check_recording, find_gaps, swaps, with_zeros_as_gaps

FIRST = 101  # number of the first stored frame, so that indices and frame numbers differ


@pytest.fixture
def clean(walker, rng):
    """Return a walker without gaps; noise keeps every marker moving."""
    markers = walker.markers.copy()
    frames = np.arange(walker.n_frames)
    for column in range(walker.n_markers):
        known = walker.seen[:, column]
        for axis in range(3):
            values = markers[:, column, axis]
            values[:] = np.interp(frames, frames[known], values[known])
    markers += rng.normal(scale=1e-4, size=markers.shape)
    return replace(walker, markers=markers, first_frame=FIRST)


def spoiled(recording, label, frames, values):
    markers = recording.markers.copy()
    markers[frames, recording.labels.index(label)] = values
    return replace(recording, markers=markers)


def only(findings):
    assert len(findings) == 1, [finding.what for finding in findings]
    return findings[0]


def test_a_clean_recording_has_nothing_to_say(clean):
    assert check_recording(clean) == ()


def test_a_long_gap_is_named_with_marker_frame_and_length(clean):
    found = only(check_recording(spoiled(clean, "LTOE", slice(10, 41), np.nan)))
    assert (found.rule, found.severity, found.markers) == ("gap", "warning", ("LTOE",))
    assert found.frame == FIRST + 10
    assert dict(found.numbers)["longest_s"] == pytest.approx(31 / 60, abs=1e-4)
    assert dict(found.numbers)["missing_share"] == pytest.approx(31 / 47, abs=1e-4)
    assert "LTOE is missing in 66.0% of the frames, longest from frame 111 on" in found.what


def test_a_moderate_gap_is_a_note_and_a_short_one_nothing(clean):
    assert only(check_recording(spoiled(clean, "C7", slice(5, 15), np.nan))).severity == "note"
    assert check_recording(spoiled(clean, "C7", slice(5, 7), np.nan)) == ()


def test_frames_without_anybody_are_told_once(clean):
    markers = clean.markers.copy()
    markers[20:30] = np.nan
    found = only(check_recording(replace(clean, markers=markers)))
    assert (found.rule, found.frame) == ("empty-frames", FIRST + 20)


def test_a_marker_never_seen(clean):
    found = only(check_recording(spoiled(clean, "RKNE", slice(None), np.nan)))
    assert (found.rule, found.markers) == ("never-seen", ("RKNE",))


def test_missing_written_as_zero(clean):
    zero = only(check_recording(spoiled(clean, "RELB", slice(12, 17), 0.0)))
    assert (zero.rule, zero.markers, zero.frame) == ("at-zero", ("RELB",), FIRST + 12)
    assert dict(zero.numbers) == {"frames": 5, "zero_share": round(5 / 47, 4)}


@pytest.mark.parametrize("all_of_them", [False, True])
def test_zeros_are_told_of_unlabelled_points(clean, all_of_them):
    labels = tuple(
        f"A:*{c}" if all_of_them or label == "RELB" else label
        for c, label in enumerate(clean.labels)
    )
    zero = only(check_recording(replace(spoiled(clean, "RELB", slice(12, 17), 0.0), labels=labels)))
    at = f"A:*{clean.labels.index('RELB')}"
    assert (zero.rule, zero.markers, zero.frame) == ("at-zero", (at,), FIRST + 12)


def test_one_coordinate_at_zero_is_a_place(clean):
    markers = clean.markers.copy()
    column = clean.labels.index("RELB")
    markers[12, column, :2] = 0.0
    rules = {f.rule for f in check_recording(replace(clean, markers=markers))}
    assert "at-zero" not in rules
    assert "jump" in rules


def test_a_jump_beside_zeros_is_still_a_jump(clean):
    jump = spoiled(clean, "LWRA", slice(30, 31), [5.0, 5.0, 5.0])
    found = check_recording(spoiled(jump, "LWRA", slice(12, 14), 0.0))
    assert [f.rule for f in found] == ["at-zero", "jump"]
    assert found[1].frame == FIRST + 30


SIZES = (1.0, 0.1, 1e-3, 1e3)  # of the subject, in persons


@pytest.mark.parametrize("times", SIZES)
@pytest.mark.parametrize(("before", "after", "gone"), [(0.05, 0.06, False), (0.05, 0.2, True)])
def test_a_single_zero_stays_on_the_way_past_the_origin_at_any_size(
    clean, before, after, gone, times
):
    column, markers = clean.labels.index("RELB"), clean.markers.copy()
    markers[9:12, column] = [[0.0, before, 0.0], [0.0, 0.0, 0.0], [0.0, -after, 0.0]]
    markers[:3, 0] = 0.0  # and one that is far from it, at the very beginning
    recording = replace(clean, markers=times * markers)
    found, told = with_zeros_as_gaps(recording)
    assert np.isnan(found.markers[10, column]).all() == gone
    assert (found.markers[10, column] == 0).all() == (not gone)
    assert np.isnan(found.markers[:3, 0]).all()
    same = found.seen
    np.testing.assert_array_equal(found.markers[same], recording.markers[same])
    frames = {f.markers[0]: dict(f.numbers)["frames"] for f in told}
    assert frames == {clean.labels[0]: 3} | ({"RELB": 1} if gone else {})


@pytest.mark.parametrize(
    ("columns", "frames"),
    [([3], [10, 11]), ([3], [10, 30]), ([3, 5], [10])],
    ids=["in a row", "twice", "two markers"],
)
def test_nothing_is_measured_at_the_exact_origin_twice(clean, columns, frames):
    """Not even beside it: the marker is 1 mm from the origin before and after."""
    markers = clean.markers.copy()
    for column in columns:
        markers[:, column] = [0.001, 0.0, 0.0]
    markers[np.ix_(frames, columns)] = np.nan
    zeros = replace(clean, markers=np.nan_to_num(markers))
    np.testing.assert_array_equal(with_zeros_as_gaps(zeros)[0].markers, markers)


@pytest.mark.parametrize("times", SIZES)
def test_zeros_are_gaps_at_any_size_about_the_origin(clean, rng, times):
    """As if they had been missing: of a subject in whose midst the origin is, too."""
    middle = clean.markers.mean(axis=(0, 1))
    missing = rng.random(clean.markers.shape[:2]) < 0.1
    markers = np.where(missing[..., None], np.nan, times * (clean.markers - middle))
    found, told = with_zeros_as_gaps(replace(clean, markers=np.nan_to_num(markers)))
    np.testing.assert_array_equal(found.markers, markers)
    assert sum(dict(f.numbers)["frames"] for f in told) == missing.sum()


def test_a_marker_that_is_nowhere_else_is_never_seen(clean):
    found, told = with_zeros_as_gaps(spoiled(clean, "RELB", slice(None), 0.0))
    assert not found.seen[:, clean.labels.index("RELB")].any()
    assert [f.markers for f in told] == [("RELB",)]


def test_without_zeros_nothing_changes(clean):
    assert with_zeros_as_gaps(clean) == (clean, ())


def test_a_marker_that_never_moves(clean):
    found = only(check_recording(spoiled(replace(clean, rate=40.0), "STRN", slice(None), 1.0)))
    assert (found.rule, found.markers) == ("constant", ("STRN",))


def test_a_statue_is_no_broken_recording(statue):
    assert check_recording(statue) == ()


def test_two_labels_on_one_marker(clean):
    other = clean.markers[:, clean.labels.index("LANK")]
    found = only(check_recording(spoiled(clean, "LHEE", slice(None), other + 1e-4)))
    assert (found.rule, set(found.markers)) == ("coincident", {"LANK", "LHEE"})
    assert found.frame == FIRST


def doubled(clean, *, seen, labels):
    """Return the recording with a copy of one marker that is seen in these frames."""
    at = clean.labels.index("LANK")
    copy = np.full_like(clean.markers[:, :1], np.nan)
    copy[seen, 0] = clean.markers[seen, at]
    named = tuple(labels.get(label, label) for label in (*clean.labels, "copy"))
    markers = np.concatenate([clean.markers, copy], axis=1)
    return replace(clean, markers=markers, labels=named, rate=10.0)


@pytest.mark.parametrize("labels", [{}, {"copy": "*7"}, {"copy": "*7", "LANK": "*3"}])
def test_a_copy_is_one_whether_labelled_or_not(clean, labels):
    found = only(check_recording(doubled(clean, seen=slice(None), labels=labels)))
    pair = {labels.get("LANK", "LANK"), labels.get("copy", "copy")}
    assert (found.rule, set(found.markers)) == ("coincident", pair)


def test_pieces_without_labels_that_meet_are_no_copies(clean):
    """Half of what shows one shows both: each shows what the other does not."""
    recording = doubled(clean, seen=slice(None), labels={"copy": "*7"})
    markers, n = recording.markers.copy(), len(recording.markers)
    markers[: n // 3, -1] = markers[2 * n // 3 :, recording.labels.index("LANK")] = np.nan
    rules = {f.rule for f in check_recording(replace(recording, markers=markers))}
    assert "coincident" not in rules


@pytest.mark.parametrize("times", [0.1, 1e-3])
def test_what_is_small_is_no_copy_but_a_copy_is_one(clean, times):
    small = replace(clean, markers=times * clean.markers)
    assert "coincident" not in {f.rule for f in check_recording(small)}
    copy = doubled(small, seen=slice(None), labels={})
    pairs = [f.markers for f in check_recording(copy) if f.rule == "coincident"]
    assert pairs == [("LANK", "copy")]


def test_passing_by_is_not_coincident(clean):
    other = clean.markers[3, clean.labels.index("LANK")]
    assert not any(
        f.rule == "coincident" for f in check_recording(spoiled(clean, "LHEE", 3, other))
    )


def test_a_jump_is_named_with_its_frame_and_speed(clean):
    up = clean.markers[20, clean.labels.index("LWRA")] + [0, 0.6, 0]
    found = only(check_recording(spoiled(clean, "LWRA", 20, up)))
    assert (found.rule, found.markers, found.frame) == ("jump", ("LWRA",), FIRST + 20)
    assert dict(found.numbers)["jumps"] == 2  # there and back
    assert dict(found.numbers)["fastest_m_per_s"] == pytest.approx(36, abs=3)  # 0.6 m · 60 Hz
    assert "jumps 2 times, first into frame 121" in found.what


def test_labels_that_change_places_there_and_back(clean):
    markers, pair = clean.markers.copy(), ("LANK", "RTOE")
    columns = [clean.labels.index(label) for label in pair]
    markers[20:33, columns] = markers[20:33, columns[::-1]]
    found = [f for f in check_recording(replace(clean, markers=markers)) if f.rule == "swap"]
    swap = only(found)
    assert (set(swap.markers), swap.frame) == (set(pair), FIRST + 20)
    assert dict(swap.numbers)["swaps"] == 2
    assert "change places 2 times, first into frame 121" in swap.what


@pytest.mark.parametrize("block", [1, 12, 19, 20, 21])
def test_exchanges_are_found_across_blocks_of_frames(clean, monkeypatch, block):
    monkeypatch.setattr(swaps, "BLOCK", block)
    markers = clean.markers.copy()
    columns = [clean.labels.index(label) for label in ("LANK", "RTOE")]
    markers[20:33, columns] = markers[20:33, columns[::-1]]
    found = only(list(swaps.check_swaps(replace(clean, markers=markers))))
    assert (found.frame, dict(found.numbers)["swaps"]) == (FIRST + 20, 2)


def test_two_bad_samples_that_meet_in_time_are_no_exchange(clean):
    """One marker comes back from far off as its neighbour goes there: nothing changed places."""
    markers = clean.markers.copy()
    far = np.array([0.0, 6.0, 8.0])
    there = [clean.labels.index(label) for label in ("T10", "STRN")]
    markers[18:20, there[0]] += far
    markers[20:22, there[1]] += far + np.array([0.3, 0, 0])
    found = check_recording(replace(clean, markers=markers))
    assert sorted((f.rule, *f.markers) for f in found) == [("jump", "STRN"), ("jump", "T10")]


@pytest.mark.parametrize("length", [1, 2, 12])
def test_an_exchange_of_any_length_is_found(clean, length):
    markers = clean.markers.copy()
    columns = [clean.labels.index(label) for label in ("CLAV", "LANK")]
    markers[20 : 20 + length, columns] = markers[20 : 20 + length, columns[::-1]]
    swap = only([f for f in check_recording(replace(clean, markers=markers)) if f.rule == "swap"])
    assert (swap.frame, dict(swap.numbers)["swaps"]) == (FIRST + 20, 2)


def test_one_marker_that_jumps_onto_another_is_no_exchange(clean):
    there = clean.markers[20:, clean.labels.index("RTOE")]
    spoilt = spoiled(clean, "LANK", slice(20, None), there + 0.02)
    assert not any(f.rule == "swap" for f in check_recording(spoilt))


def test_a_place_beyond_all_cameras_is_an_error(clean):
    found = check_recording(spoiled(clean, "LWRA", 7, [0.0, -2e6, 0.0]))[0]
    assert (found.rule, found.severity, found.markers) == ("far", "error", ("LWRA",))
    assert found.frame == FIRST + 7
    assert "2e+06 m away" in found.what


def test_the_same_step_at_a_low_rate_is_no_jump(clean):
    up = clean.markers[20, clean.labels.index("LWRA")] + [0, 0.6, 0]
    assert check_recording(replace(spoiled(clean, "LWRA", 20, up), rate=12.0)) == ()


@pytest.mark.parametrize(("gone_s", "jumps"), [(0.9, True), (1.1, False)])
def test_over_a_long_gap_nobody_knows_how_fast_it_was(clean, gone_s, jumps):
    slow = replace(clean, rate=20.0)
    gone = spoiled(slow, "LWRA", slice(10, 10 + int(gone_s * 20)), np.nan)
    away = spoiled(gone, "LWRA", slice(10 + int(gone_s * 20), None), [0.0, 80.0, 0.0])
    assert ("jump" in {f.rule for f in check_recording(away)}) == jumps


def test_a_marker_that_hardly_moves_is_no_constant(clean, rng):
    jitter = 1.0 + rng.normal(scale=1e-5, size=(clean.n_frames, 3))
    assert check_recording(spoiled(replace(clean, rate=40.0), "STRN", slice(None), jitter)) == ()


@pytest.mark.parametrize(("n_missing", "rules"), [(29, []), (31, ["gap"])])
def test_a_rare_gap_counts_from_half_a_second_on(clean, n_missing, rules):
    to_and_fro = np.concatenate([clean.markers, clean.markers[::-1]] * 8)
    long = replace(clean, markers=to_and_fro)
    found = check_recording(spoiled(long, "C7", slice(100, 100 + n_missing), np.nan))
    assert [f.rule for f in found] == rules


def test_unlabelled_points_may_come_and_go(clean):
    labels = tuple("*7" if label == "LTOE" else label for label in clean.labels)
    ghost = replace(spoiled(clean, "LTOE", slice(10, 41), np.nan), labels=labels)
    assert check_recording(ghost) == ()


def test_where_nothing_is_labelled_gaps_of_what_is_no_reflection_are_told(clean):
    slow = replace(clean, rate=20.0)
    toe, heel = (clean.labels.index(label) for label in ("LTOE", "LHEE"))
    gone = spoiled(slow, "LTOE", slice(10, 41), np.nan)
    blinks = spoiled(gone, "LHEE", slice(3, None), np.nan)  # three frames: a reflection
    named = {f.markers for f in check_recording(blinks)}
    assert named == {("LTOE",), ("LHEE",)}
    bare = replace(blinks, labels=tuple(f"*{c}" for c in range(clean.n_markers)))
    found = only(check_recording(bare))
    assert (found.rule, found.markers, found.frame) == ("gap", (f"*{toe}",), FIRST + 10)
    assert f"*{heel}" not in found.what


def test_unlabelled_frames_without_anybody_are_those_without_a_point(clean):
    markers = clean.markers.copy()
    markers[20:30] = np.nan
    bare = tuple(f"*{c}" for c in range(clean.n_markers))
    found = only(check_recording(replace(clean, markers=markers, labels=bare)))
    assert (found.rule, found.frame) == ("empty-frames", FIRST + 20)
    assert found.what.startswith("no marker is seen in 21.3%")


@pytest.mark.parametrize(
    ("factor", "shown"), [(1e3, "e+03"), (1e-3, "0.00"), (2.0, "3.3"), (0.15, "0.24")]
)
def test_a_giant_or_a_dwarf_has_the_wrong_unit(clean, factor, shown):
    found = [
        f
        for f in check_recording(replace(clean, markers=clean.markers * factor))
        if f.rule == "unit"
    ]
    assert shown in only(found).what


def test_a_cloud_as_large_as_a_town_has_the_wrong_unit(rng):
    cloud = Recording(rng.normal(size=(30, 4, 3)) * 1e3, ("a", "b", "c", "d"), 60.0)
    assert "unit" in {f.rule for f in check_recording(cloud)}
    assert "unit" not in {
        f.rule for f in check_recording(replace(cloud, markers=cloud.markers / 1e3))
    }


def test_one_frame_is_said(clean):
    found = only(check_recording(replace(clean, markers=clean.markers[:1])))
    assert (found.rule, found.frame) == ("one-frame", FIRST)


@pytest.mark.parametrize(
    ("shape", "what"),
    [((0, 3), "no frames"), ((4, 0), "no markers"), ((4, 3), "no marker is seen in any of the 4")],
)
def test_nothing_there_is_an_error_and_the_only_one(shape, what):
    empty = Recording(np.full((*shape, 3), np.nan), ("a", "b", "c")[: shape[1]], 60.0)
    found = only(check_recording(empty))
    assert found.severity == "error"
    assert what in found.what


def test_the_worst_comes_first(clean):
    worse = spoiled(spoiled(clean, "C7", slice(5, 15), np.nan), "RKNE", slice(None), np.nan)
    assert [f.severity for f in check_recording(worse)] == ["warning", "note"]


def test_findings_are_json(clean):
    found = only(check_recording(spoiled(clean, "LTOE", slice(10, 41), np.nan)))
    assert json.loads(json.dumps(found.as_json()))["missing_share"] == pytest.approx(0.6596)


def naive_gaps(seen):
    """Walk down every column, one frame after the other."""
    gaps = []
    for column in range(seen.shape[1]):
        start = None
        for frame in range(len(seen) + 1):
            gone = frame < len(seen) and not seen[frame, column]
            if gone and start is None:
                start = frame
            if not gone and start is not None:
                gaps.append((column, start, frame, start > 0 and frame < len(seen)))
                start = None
    return gaps


@pytest.mark.parametrize("share", [0.0, 0.2, 0.7, 1.0])
def test_gaps_are_those_one_finds_by_walking(rng, share):
    markers = rng.normal(size=(23, 5, 3))
    markers[rng.random((23, 5)) < share] = np.nan
    recording = Recording(markers, tuple("abcde"), 60.0)
    gaps = find_gaps(recording)
    assert [tuple(gap) for gap in gaps] == naive_gaps(recording.seen)
    assert sum(gap.n_frames for gap in gaps) == (~recording.seen).sum()
