"""``kinesphere track`` as a person would run it, on a small film with its masks."""

import json
import signal
from dataclasses import replace

import numpy as np
import pytest

pytest.importorskip("cv2")
pytest.importorskip("av")

from kinesphere.io import read_solution
from kinesphere.io.images import read_image
from kinesphere.io.scene import write_scene
from kinesphere.synthetic.film import make_film

pytestmark = pytest.mark.slow  # rendering takes long in plain Python


@pytest.fixture(scope="module")
def film():
    return make_film(1, "arms", n_frames=5, masks=True)


@pytest.fixture(scope="module")
def scene(film, tmp_path_factory):
    folder = tmp_path_factory.mktemp("film") / "scene"
    return write_scene(replace(film.scene, name="Small film"), folder, "png")


def test_a_scene_becomes_a_solved_folder(call, scene, film, tmp_path):
    out = tmp_path / "out"
    shown = call("track", scene, "-o", out, "--json")
    assert shown.code == 0, shown.err
    summary = json.loads(shown.out)
    assert summary["model"] == "markerless"
    assert summary["tracking"]["n_solved"] == 5
    assert summary["tracking"]["overlap_mean"] > 0.85
    assert len(summary["tracking"]["limbs"]) == 15
    solution = read_solution(out)
    assert solution.recording.n_markers == 0
    assert solution.motion.n_frames == 5
    names = film.motion.surface.limbs
    centres = solution.motion.joint_centres()
    for joint, limb in (
        ("neck", "head"),
        ("left_elbow", "left_forearm"),
        ("right_knee", "right_shank"),
    ):
        found = centres[:, solution.skeleton.joint_names.index(joint)]
        true = film.motion.joint_centres[:, names.index(limb)]
        assert np.linalg.norm(found - true, axis=1).max() < 0.05
    assert read_image(out / "overlays.jpg").shape[0] > 100
    import av

    with av.open(str(out / "overlays.mp4")) as container:
        assert len(list(container.decode(video=0))) == 5
    assert len((out / "tracking.csv").read_text().splitlines()) == 6
    page = (out / "report.html").read_text()
    assert "Small film" in page
    assert "data:image/jpeg;base64," in page
    assert '<video controls loop muted playsinline preload="metadata" src="overlays.mp4"' in page
    assert solution.surface is not None


def test_interrupted_it_keeps_what_was_solved(call, scene, tmp_path, monkeypatch):
    from kinesphere.markerless.account import Account

    enter = Account.enter

    def three_at_most(account, *args, **kwargs):
        if account.n_entered == 3:
            raise KeyboardInterrupt
        enter(account, *args, **kwargs)

    monkeypatch.setattr(Account, "enter", three_at_most)
    out = tmp_path / "out"
    shown = call("track", scene, "-o", out, "--no-video")
    assert shown.code == 2
    assert f"interrupted after 3 of 5 frames; they are kept in {out}" in shown.err
    solution = read_solution(out)
    seen = np.isfinite(solution.motion.origins[:, 0, 0])
    assert seen.tolist() == [True, True, True, False, False]
    assert any("interrupted after 3 of 5" in warning for warning in solution.warnings)
    assert not (out / "overlays.mp4").exists()
    assert "overlays.mp4" not in (out / "report.html").read_text()


def test_who_will_not_wait_for_the_video_keeps_the_rest(call, scene, tmp_path, monkeypatch):
    from kinesphere.report import overlay_film

    def stopped(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr(overlay_film, "drawn_panels", stopped)
    out = tmp_path / "out"
    assert call("track", scene, "-o", out).code == 0
    assert read_solution(out).motion.n_frames == 5
    assert not (out / "overlays.mp4").exists()


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
@pytest.mark.parametrize("stage", ["normalization", "parameterization", "surface", "strip"])
def test_interrupted_after_tracking_only_the_video_is_left_out(
    call, scene, tmp_path, monkeypatch, stage, number
):
    from kinesphere.pipeline import track as line
    from kinesphere.report import strip

    place, name = {
        "normalization": (line, "normalized_at_any_rate"),
        "parameterization": (line, "parameterized_at_any_rate"),
        "surface": (line, "surface_for"),
        "strip": (strip, "overlay_strip"),
    }[stage]
    work, before = getattr(place, name), signal.getsignal(number)

    def interrupted(*args, **kwargs):
        signal.raise_signal(number)
        return work(*args, **kwargs)

    monkeypatch.setattr(place, name, interrupted)
    out = tmp_path / "out"
    shown = call("track", scene, "-o", out, "--set", "tracking.shape_rounds=0")
    assert shown.code == 0, shown.err
    assert "interrupted: what was tracked is being written first" in shown.err + shown.out
    assert read_solution(out).motion.n_frames == 5
    assert (out / "overlays.jpg").exists()
    assert not (out / "overlays.mp4").exists()
    assert signal.getsignal(number) is before


def test_who_insists_is_obeyed_after_tracking(call, scene, tmp_path, monkeypatch):
    from kinesphere.pipeline import track as line

    def twice(*_args, **_kwargs):
        signal.raise_signal(signal.SIGINT)
        signal.raise_signal(signal.SIGINT)

    monkeypatch.setattr(line, "surface_for", twice)
    shown = call("track", scene, "-o", tmp_path / "out", "--set", "tracking.shape_rounds=0")
    assert shown.code != 0
    assert not (tmp_path / "out").exists()


def test_what_cannot_be_meant_is_said_before_tracking(call, scene, tmp_path, monkeypatch):
    from kinesphere.pipeline import track as line

    def never(*_):
        raise AssertionError("tracking began")

    monkeypatch.setattr(line, "track", never)
    for words, said in (
        (("--calibration", "50:60"), "calibration is 50–60 s; the scene runs from 0 to 0.13 s"),
        (("--facing", "north"), "facing is 'north'; known are"),
    ):
        shown = call("track", scene, "-o", tmp_path / "out", *words)
        assert shown.code == 2
        assert said in shown.err
        assert len(shown.error_lines) == 1
    (tmp_path / "calibration").mkdir()
    onto = ("-o", tmp_path / "calibration", "--calibration-from", tmp_path / "calibration")
    shown = call("track", scene, *onto)
    assert shown.code == 2
    assert "calibration is read from; name another place" in shown.err


def test_a_scene_that_does_not_fit_is_one_line(call, scene, tmp_path):
    text = scene.read_text().replace('name = "cam02"', 'name = "cam07"')
    wrong = scene.parent / "wrong.toml"
    wrong.write_text(text)
    shown = call("track", wrong, "-o", tmp_path / "out")
    assert shown.code == 2
    assert "cam07 is not calibrated" in shown.err
    assert len(shown.error_lines) == 1
    assert not (tmp_path / "out").exists()


def test_other_peoples_files_are_never_replaced(call, scene, tmp_path):
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / "thesis.txt").write_text("…")
    shown = call("track", scene, "-o", tmp_path / "out")
    assert shown.code == 2
    assert (tmp_path / "out" / "thesis.txt").read_text() == "…"


def test_without_opencv_it_says_how_to_get_it(call, scene, tmp_path, monkeypatch):
    import sys

    from kinesphere.io import images

    images.opencv.cache_clear()
    monkeypatch.setitem(sys.modules, "cv2", None)
    shown = call("track", scene, "-o", tmp_path / "out")
    images.opencv.cache_clear()
    assert shown.code == 2
    assert "pip install 'kinesphere[markerless]'" in shown.err
