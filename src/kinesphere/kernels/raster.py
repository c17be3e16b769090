"""Triangles drawn into pixels: a pixel belongs to a triangle that covers its centre.

Edges are computed from their upper end, so two triangles share an edge to the last bit and leave
no gap along it. Nothing is drawn of a triangle with a corner that is NaN (behind the camera).
"""

import math

import numpy as np
from numpy.typing import NDArray

from kinesphere.kernels.jit import kernel

Array = NDArray[np.float64]


@kernel
def _cross(pixels: Array, a: int, b: int, c: int) -> float:
    """Return twice the signed area: positive where the corners turn clockwise on the screen."""
    return float(
        (pixels[b, 0] - pixels[a, 0]) * (pixels[c, 1] - pixels[a, 1])
        - (pixels[b, 1] - pixels[a, 1]) * (pixels[c, 0] - pixels[a, 0])
    )


@kernel
def _from_top(pixels: Array, a: int, b: int, c: int) -> tuple[int, int, int]:
    """Return the corners from the uppermost to the lowest."""
    if pixels[a, 1] > pixels[b, 1]:
        a, b = b, a
    if pixels[b, 1] > pixels[c, 1]:
        b, c = c, b
        if pixels[a, 1] > pixels[b, 1]:
            a, b = b, a
    return a, b, c


@kernel
def _rows(pixels: Array, a: int, c: int, height: int) -> tuple[int, int]:
    """Return the first row that a triangle covers and the one after the last."""
    top, bottom = pixels[a, 1], pixels[c, 1]
    if not (bottom >= 0.0 and top <= height - 1.0):
        return 0, 0
    return int(max(0.0, math.ceil(top))), int(min(height - 1.0, math.floor(bottom))) + 1


@kernel
def _slopes(pixels: Array, a: int, b: int, c: int) -> tuple[float, float, float]:
    """Return columns a row along the edges from the top to the bottom, the middle, and thence."""
    x0, y0 = pixels[a, 0], pixels[a, 1]
    x1, y1 = pixels[b, 0], pixels[b, 1]
    x2, y2 = pixels[c, 0], pixels[c, 1]
    upper = (x1 - x0) / (y1 - y0) if y1 > y0 else 0.0
    lower = (x2 - x1) / (y2 - y1) if y2 > y1 else 0.0
    return (x2 - x0) / (y2 - y0), upper, lower


@kernel
def _columns(
    pixels: Array, a: int, b: int, c: int, slopes: tuple[float, float, float], row: int, width: int
) -> tuple[int, int]:
    """Return the first column that a triangle covers in a row and the one after the last.

    The corners come from the top; every edge is followed from its upper end.
    """
    long, upper, lower = slopes
    from_a, from_b = row - pixels[a, 1], row - pixels[b, 1]
    one = pixels[a, 0] + from_a * long
    if from_b < 0.0 or pixels[c, 1] <= pixels[b, 1]:
        other = pixels[a, 0] + from_a * upper
    else:
        other = pixels[b, 0] + from_b * lower
    left, right = min(one, other), max(one, other)
    if not (left <= width - 1 and right >= 0):
        return 0, 0
    return max(0, math.ceil(left)), min(width - 1, math.floor(right)) + 1


@kernel
def silhouette_kernel(
    pixels: Array, faces: NDArray[np.int32], cull: bool, mask: NDArray[np.bool_]
) -> None:
    """Set the pixels that any triangle covers.

    Parameters
    ----------
    pixels : (n_vertices, 2)
    faces : (n_faces, 3)
        Counter-clockwise seen from outside.
    cull
        Leave out what shows its back: right for closed surfaces, and twice as fast.
    mask : (height, width)
        Written to where covered; nothing is cleared.
    """
    height, width = mask.shape
    for f in range(len(faces)):
        a, b, c = faces[f, 0], faces[f, 1], faces[f, 2]
        turn = _cross(pixels, a, b, c)
        # y points down on the screen: what faces the camera turns the other way there
        if not (turn < 0.0 or (turn > 0.0 and not cull)):
            continue
        a, b, c = _from_top(pixels, a, b, c)
        first, last = _rows(pixels, a, c, height)
        slopes = _slopes(pixels, a, b, c)
        for row in range(first, last):
            begin, end = _columns(pixels, a, b, c, slopes, row, width)
            for col in range(begin, end):
                mask[row, col] = True


@kernel
def visible_faces_kernel(
    pixels: Array,
    depths: Array,
    faces: NDArray[np.int32],
    cull: bool,
    nearness: NDArray[np.float32],
    face_ids: NDArray[np.int32],
) -> None:
    """Write, for each pixel, the nearest triangle that covers it.

    Parameters
    ----------
    pixels, faces, cull
        As in `silhouette_kernel`.
    depths : (n_vertices,) m
        Ahead of the camera; positive.
    nearness : (height, width)
        1/depth of what is nearest so far (0: nothing), updated. It is linear across the image of a
        flat triangle, depth itself is not.
    face_ids : (height, width)
        Updated where something nearer comes.
    """
    height, width = nearness.shape
    for f in range(len(faces)):
        a, b, c = faces[f, 0], faces[f, 1], faces[f, 2]
        turn = _cross(pixels, a, b, c)
        if not (turn < 0.0 or (turn > 0.0 and not cull)):
            continue
        a, b, c = _from_top(pixels, a, b, c)
        x0, y0 = pixels[a, 0], pixels[a, 1]
        x1, y1 = pixels[b, 0], pixels[b, 1]
        x2, y2 = pixels[c, 0], pixels[c, 1]
        first, last = _rows(pixels, a, c, height)
        if first >= last:
            continue
        w0 = 1.0 / depths[a]
        dw1, dw2 = 1.0 / depths[b] - w0, 1.0 / depths[c] - w0
        area = (x1 - x0) * (y2 - y0) - (x2 - x0) * (y1 - y0)
        along_x = (dw1 * (y2 - y0) - dw2 * (y1 - y0)) / area
        along_y = (dw2 * (x1 - x0) - dw1 * (x2 - x0)) / area
        slopes = _slopes(pixels, a, b, c)
        for row in range(first, last):
            begin, end = _columns(pixels, a, b, c, slopes, row, width)
            near = w0 + (row - y0) * along_y + (begin - x0) * along_x
            for col in range(begin, end):
                if near > nearness[row, col]:
                    nearness[row, col] = near
                    face_ids[row, col] = f
                near += along_x
