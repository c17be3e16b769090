"""Gaps, and zeros, of many markers are one line for a person, and one each for a machine."""

from dataclasses import replace

import numpy as np

from kinesphere.pipeline.doubts import with_checks
from kinesphere.quality import Finding, check_recording, gathered
from kinesphere.synthetic import make_performance


def gap(marker, share, longest, severity="warning"):
    return Finding(
        "gap",
        severity,
        f"{marker} is missing",
        "fill it",
        markers=(marker,),
        frame=1,
        numbers=(("missing_share", share), ("longest_s", longest)),
    )


def test_gaps_of_one_severity_are_one_line_with_their_number_and_the_worst():
    swap = Finding("swap", "warning", "A and B swap", "swap them back")
    notes = [gap("D", 0.1, 0.6, "note"), gap("E", 0.2, 0.7, "note")]
    told = gathered([gap("A", 0.5, 4.0), swap, gap("B", 0.91, 2.0), gap("C", 0.7, 3.0), *notes])
    assert [finding.rule for finding in told] == ["gap", "swap", "gap"]
    assert told[0].what == (
        "3 markers are missing in 50.0% to 91.0% of the frames, most B; "
        "the longest gap is A's, 4.00 s"
    )
    assert told[0].markers == ("A", "B", "C")
    assert told[1] is swap
    assert (told[2].severity, told[2].markers) == ("note", ("D", "E"))


def test_a_single_gap_is_told_as_it_is():
    one = [gap("A", 0.5, 4.0), gap("B", 0.1, 0.6, "note")]
    assert gathered(one) == tuple(one)
    assert gathered([]) == ()


def test_a_solution_warns_once_of_many_gaps_and_holds_the_list():
    performance = make_performance(np.random.default_rng(0), rate=50, calibration_s=4, free_s=2)
    markers = performance.recording.markers.copy()
    for k in range(10, 40):  # each gone for more than half of the time
        markers[k : k + int(0.6 * len(markers)), k] = np.nan
    recording = replace(performance.recording, markers=markers)
    gone = recording.labels[10:40]
    step = with_checks(recording).history[-1]
    (told,) = (doubt for doubt in step.warnings if "missing" in doubt)
    assert told.startswith("30 markers are missing in ")
    assert set(step.findings["missing"]) == set(gone)
    assert all(row["missing_share"] > 0.59 for row in step.findings["missing"].values())
    assert sum(f["rule"] == "gap" for f in step.findings["found"]) == 30
    assert sum(f.rule == "gap" for f in check_recording(recording)) == 30


def test_zeros_of_many_markers_are_one_line_with_the_worst():
    """Alone, one is told as it is; gaps beside it stay what they are."""
    performance = make_performance(np.random.default_rng(0), rate=50, calibration_s=40, free_s=2)
    recording = replace(performance.recording, first_frame=7)
    n, markers = recording.n_frames, recording.markers.copy()
    markers[5:8, 3] = 0
    one = check_recording(replace(recording, markers=markers))
    assert gathered(one) == one
    markers[4:20, 11] = 0
    markers[: int(0.6 * n), 20] = np.nan
    found = check_recording(replace(recording, markers=markers))
    rules = [f.rule for f in found]
    assert (rules.count("at-zero"), rules.count("gap")) == (2, 1)
    assert "jump" not in rules
    zeros, gap = (f for f in gathered(found) if f.rule in ("at-zero", "gap"))
    assert zeros.what == (
        f"2 markers are exactly at the origin in {3 / n:.1%} to {16 / n:.1%} of the frames, "
        f"19 positions from frame 11 on, most {recording.labels[11]}: likely missing, written as "
        "zero"
    )
    assert (zeros.markers, zeros.frame) == ((recording.labels[3], recording.labels[11]), 11)
    assert gap.markers == (recording.labels[20],)


def test_many_copies_are_one_line_that_names_some_pairs():
    copies = [
        Finding(
            "coincident",
            "warning",
            f"*{k} and c{k} are at the same place",
            "leave one out",
            markers=(f"*{k}", f"c{k}"),
            frame=5 + k,
        )
        for k in range(7)
    ]
    (told,) = gathered(copies)
    assert told.what == (
        "7 pairs of markers are at the same place: "
        "*0 and c0, *1 and c1, *2 and c2, *3 and c3, *4 and c4, …"
    )
    assert (len(told.markers), told.frame) == (14, 5)
    assert gathered(copies[:1]) == tuple(copies[:1])


def test_jumps_of_more_than_five_markers_are_one_line_with_most_and_fastest():
    performance = make_performance(np.random.default_rng(0), rate=50, calibration_s=40, free_s=2)
    markers = performance.recording.markers.copy()
    for k in range(7):
        markers[20 + k : 300 : 100, k] += 1.0 + 0.1 * (k == 4)
    markers[[150, 170], 2] += 1.0
    recording = replace(performance.recording, markers=markers, first_frame=11)
    found = [f for f in check_recording(recording) if f.rule == "jump"]
    assert len(found) == 7
    (told,) = gathered(found)
    jumps = {f.markers[0]: dict(f.numbers)["jumps"] for f in found}
    label = recording.labels
    assert set(told.markers) == {*label[:7]}
    assert told.what.startswith(
        f"7 markers jump {sum(jumps.values())} times, first into frame {20 + 11}, most {label[2]} "
    )
    assert f"the fastest is {label[4]}, with " in told.what
    assert gathered(found[:5]) == tuple(found[:5])
