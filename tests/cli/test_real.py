"""Real files of many programs: described, or refused in one line."""

import json

import pytest

REFUSED = {"Optotrak.c3d"}
"""Cut short: it declares 1149 frames and holds 29."""


@pytest.mark.real
def test_every_recording_is_described_or_refused(recordings, call):
    files = sorted([*recordings.rglob("*.c3d"), *recordings.rglob("*.trc")])
    assert len(files) > 30
    for file in files:
        called = call("info", file, "--json")
        assert "a fault of Kinesphere" not in called.err, file
        if file.name in REFUSED:
            assert (called.code, len(called.error_lines)) == (2, 1)
            continue
        assert (called.code, called.err) == (0, ""), file
        shown = json.loads(called.out)
        assert shown["n_frames"] > 0
        assert shown["up"]["text"]


@pytest.mark.real
@pytest.mark.parametrize(
    ("file", "model"),
    [
        ("cmu41/06_01.c3d", "cmu41"),
        ("plugin-gait/pycgm_static.c3d", "plugin-gait"),
        ("functional/Test_func_rhip.c3d", "plugin-gait"),
        ("rigid-bodies/arm-4-2-3.c3d", None),
    ],
)
def test_the_layout_is_recognised(file, model, recordings, call):
    called = call("info", recordings / file, "--json")
    assert json.loads(called.out)["model"] == model


@pytest.mark.real
def test_the_body_is_right_where_the_file_is_wrong(recordings, call):
    called = call("info", recordings / "functional/Test_func_rhip.c3d", "--json")
    up = json.loads(called.out)["up"]
    assert (up["file"], up["used"], up["from"]) == ("+z", "-z", "body")
    assert up["warnings"]


@pytest.mark.real
@pytest.mark.slow
def test_a_model_is_learnt_from_segments(recordings, call, tmp_path):
    plates = recordings / "plates"
    model = tmp_path / "plates.json"
    words = ("--segments", plates / "MarkerSet.xml", "-o", model)
    called = call("model", plates / "KneeltoProne01.c3d", *words, "--json")
    assert called.code == 0, called.err
    told = json.loads(called.out)
    markers = {segment["name"]: segment["markers"] for segment in told["segments"]}
    assert set(markers["left_thigh"]) == {"LTHPA", "LTHPP", "LTHDP", "LTHDA"}
    assert len(told["joints"]) == len(told["segments"]) - 1
    assert "left_thigh" in call("info", model).out
    solved = call("solve", plates / "KneeltoProne01.c3d", "--model", model, "-o", tmp_path / "s")
    assert solved.code == 0, solved.err
    assert (tmp_path / "s" / "report.html").is_file()
