"""What must not be lost: a file's own content, a protected file, what a format cannot hold."""

import json
import shutil
from dataclasses import replace

import numpy as np

from kinesphere.data import Analog, Event
from kinesphere.io import read, write
from kinesphere.labelling import built_in_model


def as_json(called):
    assert called.code == 0, called.err
    return json.loads(called.out)


def test_a_file_is_never_converted_onto_itself(call, c3d, tmp_path):
    mine = shutil.copy(c3d, tmp_path / "mine.c3d")
    before = mine.read_bytes()
    shown = call("convert", mine, tmp_path / "." / "mine.c3d")
    assert (shown.code, mine.read_bytes()) == (2, before)
    assert "name another file" in shown.err


def test_a_protected_file_is_never_replaced(call, c3d, trc, tmp_path):
    mine = shutil.copy(c3d, tmp_path / "mine.c3d")
    before = mine.read_bytes()
    mine.chmod(0o444)
    shown = call("convert", trc, mine)
    assert (shown.code, mine.read_bytes()) == (2, before)
    assert "write-protected" in shown.err


def test_convert_says_what_is_left_behind(call, performance, tmp_path):
    recording = performance.recording
    samples = np.zeros((recording.n_frames, 2))
    full = replace(
        recording,
        analog=Analog(samples, ("force", "emg"), ("N", "V"), recording.rate),
        first_frame=7,
        events=(Event(0.5, "start"),),
    )
    source = tmp_path / "full.c3d"
    write(full, source)

    def lost(name):
        warnings = as_json(call("convert", source, tmp_path / name, "--json"))["warnings"]
        return [w for w in warnings if "left behind" in w]

    assert lost("a.csv") == [
        ".csv has no place for 2 analog channels, 1 events, the number of the first frame (7): "
        "left behind"
    ]
    assert lost("a.trc") == [".trc has no place for 2 analog channels, 1 events: left behind"]
    assert lost("b.c3d") == []


def test_model_without_segments_refines_a_built_in_one(call, c3d, tmp_path):
    assert call("model", c3d, "-o", tmp_path / "mine.json").code == 0
    learnt, known = read(tmp_path / "mine.json"), built_in_model("cmu41")
    assert learnt.segments == known.segments
    (statistics,) = learnt.statistics
    assert set(statistics.labels) == set(known.labels)


def test_model_without_segments_says_what_is_needed(call, performance, tmp_path):
    file = tmp_path / "odd.trc"
    write(replace(performance.recording, labels=tuple(f"P{i}" for i in range(41))), file)
    shown = call("model", file, "-o", tmp_path / "mine.json")
    assert shown.code == 2
    assert "--segments FILE" in shown.err
    assert not (tmp_path / "mine.json").exists()
