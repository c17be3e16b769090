"""Cameras against OpenCV, and against themselves there and back."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation

from kinesphere.data import Camera
from kinesphere.errors import BadCamera

PIXEL = 1e-9  # px; rounding alone


def some_camera(rng, distortion=(-0.05, 0.15, 0.002, -0.001, 0.01)):
    turn = Rotation.random(rng=rng).as_matrix()
    matrix = np.array([[1671.5, 0.0, 564.6], [0, 1660.2, 933.0], [0, 0, 1]])
    return Camera("one", 1088, 1920, matrix, np.array(distortion), turn, rng.normal(size=3))


def seen_points(camera, rng, n=50):
    ahead = np.column_stack([rng.uniform(-0.4, 0.4, (n, 2)), np.ones(n)])
    ahead *= rng.uniform(0.5, 9, (n, 1))
    return (ahead - camera.translation) @ camera.rotation


@settings(deadline=None, max_examples=50)
@given(seed=st.integers(0, 2**32 - 1))
def test_projects_as_opencv_does(seed):
    cv2 = pytest.importorskip("cv2")
    rng = np.random.default_rng(seed)
    camera = some_camera(rng)
    points = seen_points(camera, rng)
    theirs, _ = cv2.projectPoints(
        points, cv2.Rodrigues(camera.rotation)[0], camera.translation, camera.matrix,
        camera.distortion,
    )  # fmt: skip
    assert_allclose(camera.project(points), theirs[:, 0], atol=1e-6)


@settings(deadline=None, max_examples=50)
@given(seed=st.integers(0, 2**32 - 1))
def test_a_point_lies_on_the_line_of_its_pixel(seed):
    rng = np.random.default_rng(seed)
    camera = some_camera(rng)
    points = seen_points(camera, rng).reshape(10, 5, 3)
    n, m = camera.lines(camera.project(points))
    assert n.shape == m.shape == (10, 5, 3)
    assert_allclose(np.linalg.norm(n, axis=-1), 1, atol=1e-12)
    assert_allclose(np.cross(points, n), m, atol=1e-8)
    assert (np.einsum("...i,...i", points - camera.centre, n) > 0).all()


def test_skew_is_heeded_both_ways(rng):
    camera = some_camera(rng)
    matrix = camera.matrix + np.array([[0, 7.0, 0], [0, 0, 0], [0, 0, 0]])
    skewed = Camera("s", 9, 9, matrix, camera.distortion, camera.rotation, camera.translation)
    points = seen_points(skewed, rng)
    pixels = skewed.project(points)
    assert np.abs(pixels - camera.project(points)).max() > 0.1
    plane = skewed.undistorted(pixels)
    local = points @ skewed.rotation.T + skewed.translation
    assert_allclose(plane, local[:, :2] / local[:, 2:], atol=1e-10)


def test_behind_and_unseen_are_nan(rng):
    camera = some_camera(rng)
    points = np.stack([camera.centre - camera.rotation[2], [np.nan] * 3, camera.centre])
    assert np.isnan(camera.project(points)).all()


def test_what_the_lens_would_fold_back_into_the_image_is_nan():
    camera = Camera(
        "wide", 640, 480, np.array([[500.0, 0, 320], [0, 500, 240], [0, 0, 1]]),
        np.array([-0.3, 0, 0, 0, 0]), np.eye(3), np.zeros(3),
    )  # fmt: skip
    turning = 1 / np.sqrt(0.9)  # r(1 − 0.3 r²) is largest here
    assert camera.widest == pytest.approx(turning**2)
    near, far = camera.project(np.array([[turning - 0.01, 0, 1], [turning + 0.01, 0, 1.0]]))
    assert np.isfinite(near).all()
    assert np.isnan(far).all()
    assert np.isnan(camera.rays(np.array([320.0 + 500 * turning, 240.0]))).all()


def test_turning_world_and_camera_changes_no_pixel(rng):
    camera = some_camera(rng)
    points = seen_points(camera, rng)
    turn, shift = Rotation.random(rng=rng).as_matrix(), rng.normal(size=3)
    other = camera.turned(turn, shift)
    assert_allclose(other.project(points @ turn.T + shift), camera.project(points), atol=1e-7)
    assert_allclose(other.centre, turn @ camera.centre + shift, atol=PIXEL)


def test_half_size_image_shows_the_same_at_half_the_place(rng):
    camera = some_camera(rng)
    points = seen_points(camera, rng)
    half = camera.resized(0.5)
    assert (half.width, half.height) == (544, 960)
    # corners, not centres, of pixels scale
    assert_allclose(half.project(points) + 0.5, (camera.project(points) + 0.5) / 2, atol=1e-9)


def test_a_mirrored_rotation_is_refused(rng):
    camera = some_camera(rng)
    with pytest.raises(BadCamera, match="mirrored"):
        camera.turned(np.diag([1.0, 1, -1]), np.zeros(3))
