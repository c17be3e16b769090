"""Whatever is wrong with a file: one clear error or a valid recording, soon and in little room."""

import time
import tracemalloc

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from kinesphere.errors import KinesphereError, UnreadableFile
from kinesphere.io import read
from kinesphere.io.c3d import read_c3d, write_c3d

BLOCK = 512
ROOM = 20  # times the file's size; a sound file takes about 12 of its own
TIME = 1.0  # s of processor time; a file of this size takes some milliseconds

fuzz = settings(
    deadline=None, max_examples=60, suppress_health_check=[HealthCheck.function_scoped_fixture]
)


@pytest.fixture
def sound(c3d_file):
    """Return the bytes of a file with everything in it, and a function that reads others."""
    points = [[(float(i), float(j), 900.0) for j in range(5)] for i in range(7)]
    path = c3d_file(
        points=points,
        labels=["A", "B", "C", "LKneeAngles", "E"],
        analog=[[(1.0, 2.0), (3.0, 4.0)]] * 7,
        events=[(0.01, "RHS")],
        groups={
            "POINT": {"ANGLES": ["LKneeAngles"], "ANGLE_UNITS": "deg", "Y_SCREEN": "+Z"},
            "TRIAL": {"ACTUAL_START_FIELD": [1, 0], "ACTUAL_END_FIELD": [7, 0]},
            "ANALOG": {"SCALE": [1.0, 2.0], "OFFSET": [0, 0], "LABELS": ["Fx", "Fy"]},
            "EVENT": {"USED": [1], "LABELS": ["Foot Off"], "TIMES": [0.0, 0.02]},
        },
    )
    return path.read_bytes()


def survives(content, path):
    """Read ``content``: a recording, or an error that names the file in one line."""
    path.write_bytes(content)
    recording, error = None, None
    tracemalloc.start()
    before = time.process_time()
    try:
        recording = read_c3d(path)
    except KinesphereError as caught:
        error = str(caught)
    taken, room = time.process_time() - before, tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert taken < TIME
    assert room < ROOM * len(content) + 1e6
    assert recording is None or recording.n_frames > 0
    assert error is None or (str(path) in error and "\n" not in error)
    return recording


@fuzz
@given(data=st.data())
def test_flipped_bytes_in_header_and_parameters(sound, tmp_path, data):
    end = (sound[16] - 1) * BLOCK
    content = bytearray(sound)
    for _ in range(data.draw(st.sampled_from([1, 2, 5, 30]))):
        content[data.draw(st.integers(0, end - 1))] = data.draw(st.integers(0, 255))
    recording = survives(bytes(content), tmp_path / "flipped.c3d")
    if recording is not None:
        write_c3d(recording, tmp_path / "again.c3d")
        again = read_c3d(tmp_path / "again.c3d")
        np.testing.assert_array_equal(again.markers, recording.markers)
        assert again.labels == recording.labels


@fuzz
@given(data=st.data())
def test_flipped_bytes_in_the_numbers(sound, tmp_path, data):
    start = (sound[16] - 1) * BLOCK
    content = bytearray(sound)
    for _ in range(30):
        at = data.draw(st.integers(start, len(sound) - 1))
        content[at] = data.draw(st.sampled_from([0, 127, 128, 255]))
    assert survives(bytes(content), tmp_path / "flipped.c3d") is not None


@fuzz
@given(noise=st.binary(max_size=3 * BLOCK))
def test_random_bytes_behind_the_magic(tmp_path, noise):
    survives(b"\x02\x50" + noise, tmp_path / "noise.c3d")


@fuzz
@given(share=st.floats(0, 1, exclude_max=True))
def test_a_file_cut_anywhere_is_refused(sound, tmp_path, share):
    needed = sound.rstrip(b"\0")  # what follows is padding
    cut = tmp_path / "cut.c3d"
    cut.write_bytes(needed[: int(share * (len(needed) - 4))])
    with pytest.raises(UnreadableFile, match="cut"):
        read(cut)


def test_cut_in_the_data_says_how_much_is_there(sound, tmp_path):
    start = (sound[16] - 1) * BLOCK
    frame = (5 * 4 + 4) * 4
    cut = tmp_path / "cut.c3d"
    cut.write_bytes(sound[: start + 3 * frame + 10])
    with pytest.raises(UnreadableFile, match="7 frames of 5 points declared, 3 present"):
        read_c3d(cut)


def test_cut_in_the_parameters_names_the_place(sound, tmp_path):
    cut = tmp_path / "cut.c3d"
    cut.write_bytes(sound[: BLOCK + 40])
    with pytest.raises(UnreadableFile, match="parameter section ends inside the"):
        read_c3d(cut)


@pytest.mark.parametrize(
    ("at", "value", "message"),
    [
        (0, 200, "should start at block 200; the file has"),
        (0, 1, "should start at block 1"),
        (1, 81, "second byte is 81 instead of 80"),
        (BLOCK + 3, 87, r"processor code is 87; known are 84 \(INTEL\), 85 \(DEC\), 86 \(MIPS\)"),
    ],
)
def test_a_wrong_byte_that_everything_hangs_on(sound, tmp_path, at, value, message):
    content = bytearray(sound)
    content[at] = value
    path = tmp_path / "wrong.c3d"
    path.write_bytes(bytes(content))
    with pytest.raises(UnreadableFile, match=message):
        read_c3d(path)


def test_absurd_counts_take_no_room(c3d_file):
    words = {2: 65535, 3: 65535, 5: 65535, 10: 1}
    path = c3d_file(header=words, groups={"POINT": {"USED": [65535]}})
    tracemalloc.start()
    with pytest.raises(UnreadableFile, match="65535 frames of 65535 points declared, 0 present"):
        read_c3d(path)
    assert tracemalloc.get_traced_memory()[1] < 1e6
    tracemalloc.stop()
