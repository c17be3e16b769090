"""``kinesphere compare``: two solved folders, a table, JSON, and a page that stands alone."""

import json
import re

import numpy as np
import pytest

from kinesphere.io import read, write


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("compare")


@pytest.fixture
def solved(folder, c3d, call):
    walk = folder / "walk"
    if not walk.exists():
        assert call("solve", c3d, "-o", walk).code == 0
    return walk


@pytest.fixture
def bent(folder, solved, call):
    out = folder / "bent"
    if not out.exists():
        edits = folder / "edits.toml"
        edits.write_text(
            '[[edit]]\njoint = "left_elbow"\naxis = 1\nadd_deg = 30.0\nframes = [100, 200]\n'
        )
        assert call("edit", solved, "--apply", edits, "-o", out).code == 0
    return out


def test_an_edit_is_found_where_it_was_made(solved, bent, folder, call):
    page = folder / "both.html"
    called = call("compare", solved, bent, "--joint", "left_elbow", "-o", page)
    assert called.code == 0, called.err
    assert "walk against" in called.out
    assert "time offset" in called.out
    assert "left_elbow" in called.out
    html = page.read_text(encoding="utf-8")
    assert '<option value="left_elbow" selected>' in html
    assert not re.search(r'(src|href)="?https?:', html)
    found = json.loads(call("compare", solved, bent, "--json").out)
    assert found["offset_s"] == 0
    by_name = {(p["joint"], p["name"]): p for p in found["parameters"]}
    share = 101 / found["n_frames"]
    before = by_name["left_elbow", "axis1"]["before"]
    assert before["rmsd_deg"] == pytest.approx(30 * np.sqrt(share), rel=1e-6)
    assert before["bias_deg"] == pytest.approx(30 * share, rel=1e-6)
    after = by_name["left_elbow", "axis1"]["after"]
    assert after["bias_deg"] == pytest.approx(before["bias_deg"])
    assert after["rmsd_deg"] == pytest.approx(before["rmsd_deg"])
    assert found["shared"] == {"clock": True, "world": True, "limb_frames": True}
    assert "no turn is taken out" in called.out
    assert "one skeleton" in html
    assert by_name["right_elbow", "axis1"]["after"]["rmsd_deg"] < 1e-6
    assert found["only_in_first"] == {"limbs": [], "joints": []}


def test_parameters_alone_can_be_compared_with_the_folder(solved, call):
    found = json.loads(call("compare", solved / "parameters.csv", solved, "--json").out)
    assert found["offset_s"] == 0
    # the table has no poses of its own: limbs are rebuilt, and stray by the residual
    assert max(j["orientation_after_deg"] for j in found["joints"]) < 8


def test_its_own_bvh_stands_for_a_folder(solved, call):
    found = json.loads(call("compare", solved, solved / "motion.bvh", "--json").out)
    assert found["offset_s"] == 0
    assert "left_elbow" in {j["name"] for j in found["joints"]}
    assert found["only_in_second"] == {"limbs": [], "joints": []}
    assert max(j["orientation_after_deg"] for j in found["joints"]) < 0.5


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (("--offset", "1000"), "no moment in common"),
        (("--joint", "tail"), "--joint tail: not compared; there are"),
        (("-o", "nowhere/at/all/x.html"), "nowhere"),
    ],
)
def test_what_cannot_be_done_is_one_line(solved, call, words, says):
    called = call("compare", solved, solved, *words)
    assert called.code == 2
    assert says in called.err
    assert len(called.error_lines) == 1


def test_a_recording_is_no_solution(solved, c3d, call):
    called = call("compare", solved, c3d)
    assert called.code == 2
    assert "solve it first" in called.err


def test_the_folder_has_the_clinical_angles(solved):
    names, *rows = (solved / "isb_angles.csv").read_text(encoding="utf-8").splitlines()
    columns = names.split(",")
    for name in ("left_knee.flexion_deg", "right_shoulder.elevation_deg", "left_knee.gimbal"):
        assert name in columns
    solution = read(solved)
    assert len(rows) == solution.motion.n_frames
    from kinesphere import isb_angles

    found = isb_angles(solution.motion, solution.skeleton)
    at = columns.index("left_knee.flexion_deg")
    shown = np.array([float(row.split(",")[at] or "nan") for row in rows])
    np.testing.assert_allclose(shown, np.rad2deg(found.angle("left_knee.flexion")), atol=1e-6)
    summary = json.loads((solved / "summary.json").read_text(encoding="utf-8"))
    assert summary["isb_angles"]["joints"]["left_knee"]["sequence"] == "ZXY"
    assert 0 <= summary["isb_angles"]["joints"]["left_shoulder"]["near_gimbal"] <= 1


def test_a_folder_of_an_older_version_is_whole_without_them(solved, tmp_path):
    import shutil

    shutil.copytree(solved, tmp_path / "old")
    (tmp_path / "old" / "isb_angles.csv").unlink()
    solution = read(tmp_path / "old")
    write(solution, tmp_path / "old")
    assert (tmp_path / "old" / "isb_angles.csv").exists()
