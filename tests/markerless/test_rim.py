"""What a camera sees of a body: against the drawn silhouette and finite differences."""

import cv2
import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from kinesphere.markerless.kernels.contour import NOWHERE
from kinesphere.markerless.pieces import around
from kinesphere.markerless.pose import bind_pose, moved, posed
from kinesphere.markerless.rim import Canvas, image_directions
from kinesphere.markerless.views import view_of

pytestmark = pytest.mark.slow  # in plain Python


@pytest.fixture(scope="module")
def seen(whole, ring):
    """Return canvas, points, normals, parts and rim of one camera."""
    canvas = Canvas(view_of(ring(3)[1], 640), whole, 6)
    points = whole.skinned(posed(whole.chain, bind_pose(whole.chain)))
    normals = whole.normals(points)
    parts = canvas.draw(points)
    return canvas, points, normals, parts, canvas.rim(points, normals, parts)


def test_the_outer_rim_is_the_silhouettes_edge(seen):
    _, _, _, parts, rim = seen
    mask = (parts.limbs != NOWHERE).astype(np.uint8)
    inside = cv2.distanceTransform(mask, cv2.DIST_L2, 5)
    outside = cv2.distanceTransform(1 - mask, cv2.DIST_L2, 5)
    outer = rim.pixels[rim.parts[:, 1] == NOWHERE]
    assert len(outer) > 150
    col, row = np.rint(outer).astype(int).T
    away = np.maximum(inside, outside)[row, col]
    assert np.percentile(away, 95) < 2.3  # px; the edge's own pixels are 1 away from the other side


def test_normals_point_out_of_the_silhouette(seen):
    _, _, _, parts, rim = seen
    outer = rim.parts[:, 1] == NOWHERE
    for side, there in ((-4, True), (4, False)):
        col, row = np.rint(rim.pixels[outer] + side * rim.normals[outer]).astype(int).T
        hits = (parts.limbs[row, col] != NOWHERE) == there
        assert hits.mean() > 0.9  # thin limbs may end within 4 px


def test_an_arm_before_the_trunk_has_an_inner_rim_and_hides_the_trunks(whole, ring):
    names = list(whole.parameter_names)
    step = np.zeros(len(names))
    step[names.index("right_upper_arm.turn1")] = 0.7  # arm down, beside the trunk
    pose = moved(whole.chain, bind_pose(whole.chain), step)
    canvas = Canvas(view_of(ring(1, radius=3.0)[0], 640), whole, 6)
    points = whole.skinned(posed(whole.chain, pose))
    normals = whole.normals(points)
    parts = canvas.draw(points)
    rim = canvas.rim(points, normals, parts)
    inner = rim.parts[:, 1] != NOWHERE
    assert inner.sum() > 5
    # what is seen outside an inner rim is really farther away
    col, row = np.rint(rim.pixels[inner] + 1.5 * rim.normals[inner]).astype(int).T
    on_rim = (1 - rim.shares[inner])[:, None] * points[rim.pairs[inner, 0]] + rim.shares[
        inner, None
    ] * points[rim.pairs[inner, 1]]
    depth = on_rim @ canvas.view.rotation[2] + canvas.view.shift[2]
    assert (1 / parts.nearness[row, col] > depth).all()


def test_drawing_again_gives_the_same(seen):
    canvas, points, normals, parts, rim = seen
    first = parts.limbs.copy()
    canvas.draw(points + np.array([0.3, 0.2, 0.1]))
    again = canvas.draw(points)
    assert_array_equal(again.limbs, first)
    assert_allclose(canvas.rim(points, normals, again).pixels, rim.pixels)


def test_a_body_behind_the_camera_is_not_seen(seen):
    canvas, points, normals, _, _ = seen
    behind = points + 8 * (canvas.view.centre - points.mean(axis=0))
    parts = canvas.draw(behind)
    assert (parts.limbs == NOWHERE).all()
    assert len(canvas.rim(behind, normals, parts).shares) == 0


def test_image_directions_are_derivatives(seen, rng):
    canvas, points, _, _, _ = seen
    view = canvas.view
    pairs = rng.integers(0, len(points), (30, 2)).astype(np.int32)
    shares = rng.uniform(size=30)
    some = points[pairs[:, 0]] + shares[:, None] * (points[pairs[:, 1]] - points[pairs[:, 0]])
    normals = rng.normal(size=(30, 2))
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    directions = image_directions(view, points, pairs, shares, normals)
    small = 1e-6
    for axis in np.eye(3):
        pair = [plain_pixels(view, some + s * small * axis) for s in (-1, 1)]
        numeric = ((pair[1] - pair[0]) * normals).sum(axis=1) / (2 * small)
        assert_allclose(directions @ axis, numeric, rtol=1e-6, atol=1e-4)


def plain_pixels(view, points):
    p = points @ view.rotation.T + view.shift
    return view.lens[:2] * p[:, :2] / p[:, 2:] + view.lens[2:]


def test_around_holds_the_mask_and_its_margin():
    mask = np.zeros((20, 30), dtype=bool)
    assert around(mask, 3) is None
    mask[5:8, 10:12] = True
    assert around(mask, 3) == (slice(2, 11), slice(7, 15))
    assert around(mask, 100) == (slice(0, 20), slice(0, 30))
