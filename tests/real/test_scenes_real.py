"""Real footage opened through scenes: cameras, frames, masks that fit each other."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

pytest.importorskip("cv2")
pytest.importorskip("av")

from kinesphere.io.scene import read_scene
from kinesphere.markerless.consistency import disagreement, sights

pytestmark = pytest.mark.real


@pytest.fixture(scope="module")
def scenes():
    """Return the module that writes the scenes; found beside the tests."""
    import sys
    from pathlib import Path

    root = str(Path(__file__).parents[2])
    if root not in sys.path:
        sys.path.append(root)
    from benchmarks.markerless import real_scenes

    return real_scenes


def test_pose2sim_opens_as_it_is(tmp_path, recordings, scenes):
    scene = read_scene(scenes.write_pose2sim_scene(tmp_path, recordings))
    assert (scene.n_frames, scene.rate, len(scene.cameras)) == (100, 60.0, 4)
    assert [camera.width for camera in scene.cameras] == [1080, 1080, 1088, 1088]
    frame = scene.frame(5)
    assert [image.shape for image in frame.images] == [
        (camera.height, camera.width, 3) for camera in scene.cameras
    ]
    share = [mask.mean() for mask in frame.references]
    assert min(share) > 0.02
    assert max(share) < 0.15
    assert scene.frame(6).references == (None,) * 4
    # cameras hang at the height of a person's head, all around
    heights = [camera.centre[1] for camera in scene.cameras]
    assert min(heights) > 1.5
    assert max(heights) < 2.3


def test_both_calibrations_of_pose2sim_are_nearly_one(tmp_path, recordings, scenes):
    ours = read_scene(scenes.write_pose2sim_scene(tmp_path / "a", recordings))
    shipped = read_scene(scenes.write_pose2sim_scene(tmp_path / "b", recordings, qualisys=True))
    assert shipped.history[0].findings["unit"] == "mm"
    for one, other in zip(ours.cameras, shipped.cameras, strict=True):
        assert np.linalg.norm(one.centre - other.centre) < 0.2  # 15 px and 9 px off each
        turn = one.rotation @ other.rotation.T
        assert np.degrees(np.arccos((np.trace(turn) - 1) / 2)) < 3
        assert_allclose(one.matrix[0, 0], other.matrix[0, 0], rtol=0.01)


def test_the_better_calibration_of_pose2sim_fits_the_masks_better(tmp_path, recordings, scenes):
    apart = []
    for qualisys in (False, True):
        folder = tmp_path / str(qualisys)
        scene = read_scene(scenes.write_pose2sim_scene(folder, recordings, qualisys=qualisys))
        masks = [f.references for f in scene.frames() if f.references[0] is not None]
        assert len(masks) == 4
        apart.append(disagreement(sights(scene.cameras, masks)))
    assert apart[0] < apart[1]
    assert apart[0] < 0.008 * np.hypot(1088, 1920)


def test_parsec_opens_and_its_foreground_maps_fit_its_calibration(tmp_path, recordings, scenes):
    from kinesphere.markerless.checks import check_scene

    scene = read_scene(scenes.write_parsec_scene(tmp_path, recordings))
    assert (scene.n_frames, scene.has_masks) == (1, True)
    frame = scene.frame(0)
    assert all((image[..., 0] == image[..., 2]).all() for image in frame.images)  # grey
    step = check_scene(scene)
    assert step.findings["disagreement_px"] < 0.008 * np.hypot(640, 480)
    # the cameras were moved by some pixels since: the hull fills more of the maps with them mended
    assert step.warnings
    assert all("seems to have been moved" in warning for warning in step.warnings)
