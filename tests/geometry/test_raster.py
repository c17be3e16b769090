"""Drawing triangles, against a naive twin and against areas that are known."""

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from kinesphere.geometry.raster import NOTHING, barycentric, silhouette, visible_faces

WIDTH, HEIGHT = 37, 29


def cross(a, b):
    return a[0] * b[1] - a[1] * b[0]


def naive_visible(pixels, depths, faces):
    """Every pixel against every triangle, both sides drawn."""
    ids = np.full((HEIGHT, WIDTH), NOTHING, dtype=np.int32)
    best = np.zeros((HEIGHT, WIDTH))
    for row in range(HEIGHT):
        for col in range(WIDTH):
            for f, corners in enumerate(faces):
                p = pixels[corners] - [col, row]
                part = [cross(p[(k + 1) % 3], p[(k + 2) % 3]) for k in range(3)]
                if not (min(part) >= 0 or max(part) <= 0) or sum(part) == 0:
                    continue
                near = np.dot(part, 1 / depths[corners]) / sum(part)
                if near > best[row, col]:
                    best[row, col], ids[row, col] = near, f
    return ids, best


def some_triangles(rng, n=12):
    pixels = rng.uniform([-9, -9], [WIDTH + 9, HEIGHT + 9], (3 * n, 2))
    return pixels, rng.uniform(1, 5, 3 * n), np.arange(3 * n, dtype=np.int32).reshape(n, 3)


def test_nearest_face_is_that_of_the_naive_twin(rng):
    for _ in range(5):
        pixels, depths, faces = some_triangles(rng)
        pixels[4] = np.nan
        ids, near = visible_faces(pixels, depths, faces, WIDTH, HEIGHT, closed=False)
        expected, expected_near = naive_visible(pixels, depths, faces)
        assert_array_equal(ids, expected)
        assert_allclose(near, expected_near, rtol=1e-5)
        covered = silhouette(pixels, faces, WIDTH, HEIGHT, closed=False)
        assert_array_equal(covered, ids != NOTHING)


def test_corners_at_pixel_centres_are_covered(rng):
    """Integers everywhere: horizontal edges, upright edges, triangles without area."""
    pixels = rng.integers(0, 9, (300, 2)).astype(float)
    faces = np.arange(300, dtype=np.int32).reshape(-1, 3)
    for corners in faces:
        mask = silhouette(pixels, corners[None], WIDTH, HEIGHT, closed=False)
        expected, _ = naive_visible(pixels, np.ones(300), corners[None])
        a, b, c = pixels[corners]
        differ = np.argwhere(mask != (expected != NOTHING))[:, ::-1]
        # a slope of thirds rounds: only centres exactly on an edge may differ
        for at in differ:
            assert min(abs(cross(q - p, at - p)) for p, q in ((a, b), (b, c), (c, a))) == 0
        if cross(b - a, c - a) == 0:
            assert not mask.any()
        assert len(differ) <= 2


def test_area_is_right_on_average(rng):
    """Over random places the count of pixels is the area; OpenCV's fill is larger."""
    cv2 = pytest.importorskip("cv2")
    angles = np.linspace(0, 2 * np.pi, 41)[:-1]
    fan = np.array([[0, (k + 1) % 40 + 1, k + 1] for k in range(40)], dtype=np.int32)
    area = 0.5 * 40 * np.sin(2 * np.pi / 40) * 9.0**2
    ours, theirs = [], []
    for centre in rng.uniform(11, 16, (200, 2)):
        rim = centre + 9.0 * np.stack([np.cos(angles), np.sin(angles)], axis=1)
        ours.append(silhouette(np.vstack([centre, rim]), fan, WIDTH, HEIGHT).sum())
        canvas = np.zeros((HEIGHT, WIDTH), dtype=np.uint8)
        cv2.fillPoly(canvas, [np.round(rim * 16).astype(np.int32)], 1, shift=4)
        theirs.append(int(canvas.sum()))
    assert np.mean(ours) == pytest.approx(area, rel=0.003)
    assert np.mean(theirs) > 1.05 * area


def test_neighbours_leave_no_gap(rng):
    """A finely divided square has no hole, and each pixel one face."""
    n = 40
    x, y = np.meshgrid(np.linspace(2.2, 33.1, n), np.linspace(3.3, 25.7, n))
    pixels = np.stack([x, y], axis=-1)
    pixels[1:-1, 1:-1] += rng.normal(scale=0.15, size=(n - 2, n - 2, 2))
    at = np.arange(n * n).reshape(n, n)
    a, b, c, d = at[:-1, :-1], at[:-1, 1:], at[1:, :-1], at[1:, 1:]
    faces = np.concatenate([np.stack([a, c, b], -1), np.stack([b, c, d], -1)]).reshape(-1, 3)
    mask = silhouette(pixels.reshape(-1, 2), faces.astype(np.int32), WIDTH, HEIGHT, closed=False)
    expected = np.zeros_like(mask)
    expected[4:26, 3:34] = True
    assert_array_equal(mask, expected)


def test_backs_are_left_out_of_closed_surfaces():
    # counter-clockwise for a person; on the screen y points down
    pixels = np.array([[5.0, 20], [30, 20], [15, 4]])
    face, back = np.array([[0, 1, 2]], dtype=np.int32), np.array([[0, 2, 1]], dtype=np.int32)
    assert silhouette(pixels, face, WIDTH, HEIGHT).sum() > 150
    assert not silhouette(pixels, back, WIDTH, HEIGHT).any()
    assert (visible_faces(pixels, np.ones(3), back, WIDTH, HEIGHT)[0] == NOTHING).all()


def test_shares_give_the_point_in_space(rng):
    """A pixel's shares of its corners lie on its line of sight, at the depth of the buffer."""
    corners = np.array([[-0.9, -0.6, 2.0], [1.4, 0.1, 5.0], [-0.2, 0.9, 3.0]])
    pixels = corners[:, :2] / corners[:, 2:] * 30 + [18.0, 14.0]
    faces = np.array([[0, 2, 1]], dtype=np.int32)
    ids, near = visible_faces(pixels, corners[:, 2], faces, WIDTH, HEIGHT)
    rows, columns, shares = barycentric(ids, pixels, corners[:, 2], faces)
    assert len(rows) == (ids == 0).sum() > 100
    points = shares @ corners[faces[0]]
    assert_allclose(points[:, 0] / points[:, 2] * 30 + 18, columns, atol=1e-9)
    assert_allclose(points[:, 1] / points[:, 2] * 30 + 14, rows, atol=1e-9)
    assert_allclose(1 / points[:, 2], near[rows, columns], rtol=1e-5)


def test_nothing_to_draw_and_nowhere_near():
    none = np.empty((0, 3), dtype=np.int32)
    assert not silhouette(np.empty((0, 2)), none, WIDTH, HEIGHT).any()
    far = np.array([[1e9, 1e9], [1e9 + 5, 1e9], [1e9, 1e9 + 5], [-1e9, -1e9]])
    faces = np.array([[0, 1, 2]], dtype=np.int32)
    assert not silhouette(far, faces, WIDTH, HEIGHT, closed=False).any()
    # one that covers the whole image although none of its corners is near
    wide = np.array([[-1e7, -1e7], [1e7, -1e7], [0, 3e7]])
    assert silhouette(wide, faces, WIDTH, HEIGHT, closed=False).all()
