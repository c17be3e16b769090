"""What can be shown, and what is refused in a line."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_array_equal

from kinesphere.errors import BadRecording, BadSetting
from kinesphere.viewer import serve, take_from
from kinesphere.viewer.panel import plain


def test_a_solution_stands_on_the_floor_and_faces_ahead(solution):
    take = take_from(solution, "walk")
    assert take.floor() == 0.0
    assert take.middle()[1] == pytest.approx(0.9, abs=0.4)
    forward, up, right = take.facing().T
    assert np.cross(forward, up) == pytest.approx(right)
    root = solution.motion.rotations[0, 0, :, 0]
    assert forward @ root > 0.8


def test_a_recording_is_turned_upright(solution):
    recording = solution.recording
    swap = np.array([[1.0, 0, 0], [0, 0, 1], [0, -1, 0]])  # z up
    file = replace(recording, markers=recording.markers @ swap, up=None)
    take = take_from(file, "walk.c3d")
    assert take.skeleton is None
    low, high = np.nanmin(take.recording.markers[..., 1]), np.nanmax(take.recording.markers[..., 1])
    assert high - low > 1.2
    assert low > -0.3
    assert take.at(3)[0] is None


def test_a_motion_shows_its_skeleton_and_cannot_be_edited(solution):
    take = take_from(solution.motion, "walk.bvh")
    assert take.poses is None
    assert take.skeleton is solution.motion.skeleton
    rotations, origins, markers = take.at(5)
    assert_array_equal(rotations, solution.motion.rotations[5])
    assert_array_equal(origins, solution.motion.origins[5])
    assert markers.shape == (0, 3)
    assert take.middle() == pytest.approx(solution.motion.origins[0].mean(axis=0))


@pytest.mark.parametrize("spoilt", ["no frames", "nothing seen", "no recording"])
def test_what_shows_nothing_is_refused(solution, spoilt):
    recording = solution.recording
    found = {
        "no frames": replace(recording, markers=recording.markers[:0], residuals=None),
        "nothing seen": replace(recording, markers=np.full(recording.markers.shape, np.nan)),
        "no recording": solution.skeleton,
    }[spoilt]
    with pytest.raises(BadRecording, match=r"walk\.c3d"):
        take_from(found, "walk.c3d")


def test_a_port_that_is_taken_is_said(solution, tmp_path):
    pytest.importorskip("viser")
    take = take_from(solution, "walk")
    server, viewer = serve(take, "walk", tmp_path / "edits.toml")
    try:
        port = server.get_port()
        assert server.get_host() == "127.0.0.1"
        with pytest.raises(BadSetting, match=f"port {port} .* --port"):
            serve(take, "walk", tmp_path / "edits.toml", port=port)
        other, second = serve(take, "walk", tmp_path / "edits.toml")
        assert other.get_port() != port
        second.stop()
        other.stop()
    finally:
        viewer.stop()
        server.stop()


def test_text_of_a_file_means_nothing_in_markdown():
    assert plain("**[a](javascript:x)**\n<b>") == r"\*\*\[a\]\(javascript:x\)\*\* \<b\>"
