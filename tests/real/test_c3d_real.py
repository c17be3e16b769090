"""Every real C3D file: read as two other readers read it, and written back without loss."""

import io
import os
import time
import warnings
from functools import cache
from pathlib import Path

import c3d
import ezc3d
import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from kinesphere.errors import UnreadableFile
from kinesphere.io import read
from kinesphere.io.c3d import read_c3d, write_c3d

pytestmark = pytest.mark.real

CUT_SHORT = "Optotrak.c3d"
"""Shipped with 29 of its 1149 frames; the others' readers say nothing about it."""
SINGLE = 1.2e-7  # relative; what a 32-bit float loses
READING_TIME = 1.0  # s of processor time; the largest takes 0.06


def c3d_files():
    """Yield the names of all files but the one that is cut short."""
    default = Path(__file__).parents[3] / "shared" / "data"
    folder = Path(os.environ.get("KINESPHERE_DATA", default))
    paths = sorted(folder.rglob("*.c3d"))
    return [str(p.relative_to(folder)) for p in paths if p.name != CUT_SHORT] or ["none"]


@pytest.fixture(params=c3d_files())
def path(request, recordings):
    return recordings / request.param


@cache
def pure(path):
    """Points (n_frames, n_points, 5) and analog samples as the c3d package reads them, or None."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            reader = c3d.Reader(io.BytesIO(path.read_bytes()))
            frames = list(reader.read_frames())
        except (AssertionError, KeyError):
            return None
    return np.array([p for _, p, _ in frames]), np.array([a for _, _, a in frames])


def theirs(path):
    """Return the file as ezc3d reads it; None if it refuses."""
    if path.name.startswith("sgi_"):
        with pytest.raises(RuntimeError, match="MIPS"):
            ezc3d.c3d(str(path))
        return None
    return ezc3d.c3d(str(path))


def all_points(recording):
    """Return markers and outputs in the order and unit of the file, (n_frames, n_points, 3)."""
    source = recording.details["c3d"]
    points = np.empty((recording.n_frames, len(source.labels), 3))
    at = {label: i for i, label in enumerate(source.labels)}
    points[:, [at[label] for label in recording.labels]] = recording.markers / source.metres
    for output in recording.outputs:
        points[:, at[output.label]] = output.values
    return points


def test_we_read_what_others_read(path):
    before = time.process_time()
    recording = read(path)
    assert time.process_time() - before < READING_TIME
    points = all_points(recording)
    if (other := theirs(path)) is not None:
        assert_allclose(points, other["data"]["points"][:3].transpose(2, 1, 0), rtol=SINGLE)
        if recording.analog is not None:
            analog = other["data"]["analogs"][0].T
            assert_allclose(recording.analog.values, analog, rtol=SINGLE, atol=1e-6)
    if (other := pure(path)) is not None:
        seen = other[0][..., 3] >= 0
        assert_allclose(points[seen], other[0][..., :3][seen], rtol=SINGLE)
        assert_array_equal(np.isfinite(points).all(axis=2), seen)


def test_a_file_written_back_is_the_same_to_everybody(path, tmp_path):
    ours = tmp_path / "ours.c3d"
    recording = read_c3d(path)
    write_c3d(recording, ours)
    again = read_c3d(ours)
    old, new = recording.details["c3d"], again.details["c3d"]
    for name in ("points", "fourth", "analog"):
        assert_array_equal(getattr(old.frames, name), getattr(new.frames, name))
    assert again.labels == recording.labels
    assert again.events == recording.events
    assert again.first_frame == recording.first_frame
    assert_same_parameters(old.layout.section, new.layout.section)
    before, after = theirs(path), theirs(ours)
    if before is not None:
        assert before["header"]["points"] == after["header"]["points"]
        assert_array_equal(before["data"]["points"], after["data"]["points"])
        assert_array_equal(before["data"]["analogs"], after["data"]["analogs"])
        for name in ("residuals", "camera_masks"):
            of = "meta_points"
            assert_array_equal(before["data"][of][name], after["data"][of][name])
    both = pure(ours)
    assert both is not None, "the c3d package reads every file of ours"
    if (before := pure(path)) is not None:
        assert_array_equal(before[0], both[0])
        assert_array_equal(before[1], both[1])
    seen = both[0][..., 3] >= 0
    points = after["data"]["points"][:3].transpose(2, 1, 0)
    assert_allclose(points[seen], both[0][..., :3][seen], rtol=SINGLE)


def assert_same_parameters(old, new):
    """Compare group by group; only where the data start may differ, and names said twice."""
    for was, now in zip(old.groups, new.groups, strict=True):
        assert (was.name, was.description, was.locked) == (now.name, now.description, now.locked)
        names = [p.name for p in was.parameters]
        for p, q in zip(was.parameters, now.parameters, strict=True):
            if (was.name, p.name) == ("POINT", "DATA_START"):
                continue
            if names.count(p.name) == 1:
                assert p == q
            else:
                assert q.name.startswith(p.name)
            assert (p.kind, p.dims, p.data) == (q.kind, q.dims, q.data)


def test_six_encodings_of_one_trial(recordings):
    six = {
        name: read(recordings / "encodings" / f"{name}.c3d")
        for name in ("pc_real", "dec_real", "sgi_real", "pc_int", "dec_int", "sgi_int")
    }
    first = six["pc_real"]
    step = first.details["c3d"].layout.scale * 1e-3
    for name, other in six.items():
        exact = name.endswith("real")
        assert_array_equal(other.seen, first.seen)
        assert_allclose(other.markers, first.markers, rtol=0, atol=0.0 if exact else step)
        assert_array_equal(other.residuals, first.residuals)
        assert_allclose(other.analog.values, first.analog.values, rtol=SINGLE, atol=1e-6)
        assert other.labels == first.labels
        assert other.analog.labels == first.analog.labels
        assert other.history[0].findings["unit"] == "mm"
        n = len(other.events)
        assert n == (8 if name == "dec_int" else 9)  # so the file
        assert other.events == first.events[:n]


def test_the_mask_is_in_the_high_byte(recordings):
    """Every point of a trial was seen by two cameras at least; the low byte would often say none.

    ezc3d 1.7 takes the bytes the other way round.
    """
    source = read(recordings / "encodings" / "pc_real.c3d").details["c3d"]
    word = source.frames.fourth[source.frames.fourth > 0].astype(int)
    cameras = np.array([f"{w >> 8:b}".count("1") for w in word])
    swapped = np.array([f"{w & 0xFF:b}".count("1") for w in word])
    assert cameras.min() >= 2
    assert swapped.min() < 2


def test_cut_short_and_said_so(recordings):
    with pytest.raises(UnreadableFile, match="1149 frames of 54 points declared, 29 present"):
        read(recordings / "encodings" / CUT_SHORT)


@pytest.mark.parametrize(
    ("name", "n_markers"),
    [
        ("PiG_Calibration-FlatFoot-Full", 35),
        ("PiG_Motion-FlatFoot-Full", 35),
        ("pycgm_static", 77),  # 38 of them without a name
        ("pycgm_movement", 81),  # 42 of them
    ],
)
def test_no_output_of_plug_in_gait_is_a_marker(recordings, name, n_markers):
    recording = read(recordings / "plugin-gait" / f"{name}.c3d")
    assert recording.n_markers == n_markers
    assert not [label for label in recording.labels if len(label) > 4]
    kinds = {output.kind for output in recording.outputs}
    assert {"angle", "segment_frame"} <= kinds
    knee = next(o for o in recording.outputs if o.label == "LKneeAngles")
    assert knee.unit == "deg"
    assert 1.0 < np.nanmax(np.abs(knee.values)) < 180.0


def test_units_and_frames_of_odd_files(recordings):
    plates = read(recordings / "plates" / "KneeltoProne01.c3d")
    assert "mm is guessed" in plates.history[0].warnings[0]
    assert read(recordings / "cmu41" / "06_01.c3d").first_frame == 187
    assert read(recordings / "rigid-bodies" / "walkingOptiTrack.c3d").first_frame == 0
    walk = read(recordings / "plugin-gait" / "PiG_Motion-FlatFoot-Full.c3d")
    last = walk.times[-1]
    assert all(0 <= event.time <= last for event in walk.events)
