"""Real footage tracked from silhouettes of one frame: beside keypoints and masks."""

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from kinesphere.data import bundled_body
from kinesphere.io import read_trc
from kinesphere.io.scene import read_scene
from kinesphere.markerless.settings import TrackSettings
from kinesphere.markerless.tracker import track

pytestmark = [pytest.mark.real, pytest.mark.slow]

NEAR = 0.15  # m; between a surface fitted to images and another system's keypoints
N = 16


@pytest.fixture(scope="module")
def scenes():
    """Return the module that writes the scenes; found beside the tests."""
    root = str(Path(__file__).parents[2])
    if root not in sys.path:
        sys.path.append(root)
    from benchmarks.markerless import real_scenes

    return real_scenes


def test_a_person_before_clutter_is_found_and_followed(tmp_path, recordings, scenes):
    scene = replace(
        read_scene(scenes.write_pose2sim_scene(tmp_path, recordings, masks=True)), n_frames=N
    )
    tracked = track(scene, bundled_body(), TrackSettings(shape_frames=N, shape_rounds=1))
    assert tracked.solved.all()
    assert np.mean(tracked.overlap[scene.start.frame]) > 0.8
    keypoints = read_trc(recordings / "video" / "pose2sim" / "Balancing_for_IK.trc")
    for side, label in (("left", "LWrist"), ("right", "RWrist"), ("left", "LAnkle")):
        column = keypoints.columns((label,))[0]
        there = keypoints.markers[:N, column][:, [2, 0, 1]] @ scene.world_from_file.T
        limb = "hand" if label.endswith("Wrist") else "foot"
        here = tracked.origins[:, tracked.limb_names.index(f"{side}_{limb}")]
        assert np.linalg.norm(here - there, axis=1).max() < NEAR
