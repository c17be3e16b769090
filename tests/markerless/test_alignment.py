"""Cameras that were moved since they were calibrated, told by silhouettes."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

pytest.importorskip("cv2")

from kinesphere.markerless.alignment import aligned, moved_cameras, pixel_map
from kinesphere.markerless.hypotheses import facing, standing
from kinesphere.markerless.pose import posed
from kinesphere.markerless.rim import Canvas
from kinesphere.markerless.views import view_of

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def shot(ring, whole):
    """Return four cameras and what they see of a person who stands."""
    pose = facing(
        standing(whole.chain, "a-pose"), np.array([0.05, 0.95, 0.1]), np.array([1.0, 0, 0.4])
    )
    points = whole.skinned(posed(whole.chain, pose))
    cameras = ring(4)
    views = [view_of(camera, 640) for camera in cameras]
    return cameras, [Canvas(view, whole, 6).draw(points).limbs >= 0 for view in views]


def moved(camera, right, down):
    """Return the camera as it is calibrated if its images lie so many px off."""
    matrix = camera.matrix.copy()
    matrix[:2, 2] -= (right, down)
    return replace(camera, matrix=matrix)


def test_one_moved_camera_is_found_and_mended(shot):
    cameras, masks = shot
    wrong = (*cameras[:2], moved(cameras[2], 7.0, -10.0), cameras[3])
    found = aligned(wrong, [masks])
    assert found.filled - found.filled_before > 0.02
    assert found.filled > aligned(cameras, [masks]).filled_before - 0.02
    # sideways a camera and the one opposite share what they are off: silhouettes cannot tell
    down = found.shifts[:, 1]
    assert_allclose(down[2] - down[[0, 1, 3]].mean(), -10, atol=4)
    told = moved_cameras(wrong, [masks])
    assert any(word.startswith(cameras[2].name) for word in told)


def test_cameras_that_fit_are_left_alone(shot):
    cameras, masks = shot
    found = aligned(cameras, [masks])
    assert np.abs(found.shifts).max() <= 4
    assert moved_cameras(cameras, [masks]) == []


def test_two_cameras_tell_nothing(shot):
    cameras, masks = shot
    assert aligned(cameras, [[*masks[:2], None, None]]) is None
    assert aligned(cameras, []) is None


def test_the_line_takes_the_shift_back():
    assert pixel_map(np.array([4.0, -7.25])) == (
        "calibration_pixel = { scale = 1.0, shift = [-4.0, 7.2] }"
    )
    assert "-0.0" not in pixel_map(np.zeros(2))
