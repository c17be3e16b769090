"""``kinesphere edit``: a solved folder, a file of edits, another solved folder."""

import json

import numpy as np
import pytest
from numpy.testing import assert_allclose

from kinesphere.io import read

EDITS = """
[[edit]]
joint = "left_elbow"
axis = 1
add_deg = 30.0
frames = [100, 200]
"""


@pytest.fixture(scope="module")
def folders(tmp_path_factory):
    return tmp_path_factory.mktemp("edit")


@pytest.fixture
def solved(folders, c3d, call):
    walk = folders / "walk"
    if not walk.exists():
        assert call("solve", c3d, "-o", walk).code == 0
        (folders / "edits.toml").write_text(EDITS, encoding="utf-8")
    return walk


def test_the_elbow_is_bent_where_the_file_says(solved, folders, call):
    called = call("edit", solved, "--apply", folders / "edits.toml", "-o", folders / "bent")
    assert called.code == 0, called.err
    assert "left_elbow" in called.out
    assert "+30°" in called.out
    before, after = read(solved), read(folders / "bent")
    j = before.skeleton.joint_names.index("left_elbow")
    change = np.rad2deg(after.parameters.angles[:, j, 0] - before.parameters.angles[:, j, 0])
    expected = np.zeros(before.motion.n_frames)
    expected[99:200] = 30.0
    assert_allclose(change, expected, atol=1e-9)
    step = after.history[-1]
    assert step.name == "editing"
    assert list(step.settings["edits"][0]["frames"]) == [100, 200]
    assert "1 edits: left_elbow in 101 frames" in " ".join(
        call("info", folders / "bent").out.split()
    )


def test_machines_are_told_too(solved, folders, call):
    called = call(
        "edit", solved, "--apply", folders / "edits.toml", "-o", folders / "json", "--json"
    )
    assert json.loads(called.out)["frames"] == {"left_elbow": 101}


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("[[edit]]", "edit[0].joint is missing"),
        (EDITS.replace("left_elbow", "tail"), "edit 1: there is no joint 'tail'"),
        (EDITS.replace("200", "100000"), "frames [100, 100000] lie outside the motion"),
    ],
)
def test_a_bad_edit_leaves_nothing_behind(solved, folders, call, tmp_path, text, says):
    (tmp_path / "bad.toml").write_text(text, encoding="utf-8")
    called = call("edit", solved, "--apply", tmp_path / "bad.toml", "-o", tmp_path / "out")
    assert called.code == 2
    assert says in called.err
    assert len(called.error_lines) == 1
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("spelled", ["walk", "bent/../walk"])
def test_a_solution_is_not_edited_onto_itself(solved, folders, call, spelled):
    (folders / "bent").mkdir(exist_ok=True)
    before = (solved / "recording.c3d").read_bytes()
    called = call("edit", solved, "--apply", folders / "edits.toml", "-o", folders / spelled)
    assert called.code == 2
    assert "is read from; name another place" in called.err
    assert (solved / "recording.c3d").read_bytes() == before
