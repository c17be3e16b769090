"""TRC files and a marker set that other programs wrote, against values read by eye."""

import re

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from kinesphere.io import read, read_segments, write_trc

pytestmark = pytest.mark.real

PRINTED = 5.1e-10  # m; we print to 1e-6 mm
FILES = {
    # name: frames, markers, Hz, unit, share of points seen
    "dataWithBlanksForMissingMarkers.trc": (464, 40, 250.0, "mm", 0.1915),
    "dataWithEformat.trc": (5, 14, 119.88012, "m", 1.0),
    "dataWithNaNsOfDifferentCases.trc": (5, 14, 250.0, "mm", 65 / 70),
    "dataWithNaNsWithSpaces.trc": (427, 42, 100.0, "mm", 0.9988),
    "exampleFormat.trc": (5, 3, 100.0, "m", 13 / 15),
    "gait10dof18musc_walk_CRLF_line_ending.trc": (10, 41, 60.0, "mm", 1.0),
}


@pytest.fixture(params=FILES)
def trc(request, recordings):
    path = recordings / "formats" / request.param
    return request.param, path, read(path)


def test_size_rate_and_gaps(trc):
    name, _, recording = trc
    n_frames, n_markers, rate, unit, seen = FILES[name]
    assert recording.markers.shape == (n_frames, n_markers, 3)
    assert recording.rate == rate
    assert recording.first_frame == 1
    assert recording.history[-1].findings["unit"] == unit
    assert not recording.history[-1].warnings
    assert recording.seen.mean() == pytest.approx(seen, abs=1e-4)


def test_every_number_of_the_file_is_where_it_belongs(trc):
    """A naive twin: numbers and gaps of a data row in order, blanks cut away."""
    _, path, recording = trc
    metres = {"mm": 1e-3, "m": 1.0}[recording.history[-1].findings["unit"]]
    rows = [re.split("\t", line) for line in path.read_text().splitlines()[5:]]
    rows = [row for row in rows if row[0].strip()]
    assert len(rows) == recording.n_frames
    for row, markers in zip(rows, recording.markers, strict=True):
        cells = [cell.strip().lower() for cell in row[2 : 2 + 3 * recording.n_markers]]
        cells += [""] * (3 * recording.n_markers - len(cells))
        expected = [np.nan if cell in ("", "nan") else float(cell) * metres for cell in cells]
        assert_array_equal(markers.ravel(), expected)


@pytest.mark.parametrize(
    ("name", "label", "frame", "position"),
    [
        ("dataWithEformat.trc", "RFAsuperior", 1, [-0.273, 0.0745, -1.57]),
        ("dataWithNaNsOfDifferentCases.trc", "toe", 2, [0.175819695, -0.333810091, 0.033154368]),
        ("dataWithNaNsWithSpaces.trc", "RASI", 0, [1.009526917, 1.016496277, -0.198410294]),
        ("exampleFormat.trc", "marker2", 0, [-0.152, 0.245, -1.71]),
        ("exampleFormat.trc", "marker2", 2, [np.nan] * 3),
        ("exampleFormat.trc", "marker1", 0, [np.nan] * 3),
        (
            "gait10dof18musc_walk_CRLF_line_ending.trc",
            "V.Sacral",
            9,
            [0.45049979, 1.05427356, 0.00588769],
        ),
        ("dataWithBlanksForMissingMarkers.trc", "LTH3", 463, [1.5527605, 0.41156931, 0.63657843]),
        ("dataWithBlanksForMissingMarkers.trc", "LTH3", 0, [np.nan] * 3),
    ],
)
def test_values_read_by_eye(recordings, name, label, frame, position):
    recording = read(recordings / "formats" / name)
    found = recording.markers[frame, recording.labels.index(label)]
    assert_allclose(found, position, atol=1e-12)


def test_written_and_read_again(trc, tmp_path):
    _, _, recording = trc
    write_trc(recording, tmp_path / "a.trc")
    again = read(tmp_path / "a.trc")
    assert again.labels == recording.labels
    assert_array_equal(again.seen, recording.seen)
    assert_allclose(again.markers, recording.markers, atol=PRINTED, rtol=0)


def test_the_plates_of_a_marker_set(recordings):
    segments = read_segments(recordings / "plates" / "MarkerSet.xml")
    assert sum(map(len, segments.values())) == 62
    assert segments["right_thigh"] == ("RTHPA", "RTHPP", "RTHDP", "RTHDA")
    assert segments["left_hand"] == ("LHAND",)
    assert set(segments) == {
        *("head", "trunk", "pelvis"),
        *(
            f"{side}_{limb}"
            for side in ("left", "right")
            for limb in ("upper_arm", "forearm", "hand", "thigh", "shank", "foot")
        ),
    }
