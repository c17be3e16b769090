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
        if pixels[a, 1] > pixels[b, 1]:
            a, b = b, a
        if pixels[b, 1] > pixels[c, 1]:
            b, c = c, b
            if pixels[a, 1] > pixels[b, 1]:
                a, b = b, a
        x0, y0 = pixels[a, 0], pixels[a, 1]
        x1, y1 = pixels[b, 0], pixels[b, 1]
        y2 = pixels[c, 1]
        first, last = max(0.0, math.ceil(y0)), min(height - 1.0, math.floor(y2))
        if first > last:
            continue
        long = (pixels[c, 0] - x0) / (y2 - y0)
        upper = (x1 - x0) / (y1 - y0) if y1 > y0 else 0.0
        lower = (pixels[c, 0] - x1) / (y2 - y1) if y2 > y1 else 0.0
        for row in range(int(first), int(last) + 1):
            one = x0 + (row - y0) * long
            other = x0 + (row - y0) * upper if row < y1 or y2 <= y1 else x1 + (row - y1) * lower
            left, right = min(one, other), max(one, other)
            if left <= width - 1 and right >= 0:
                for col in range(max(0, math.ceil(left)), min(width - 1, math.floor(right)) + 1):
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
        if pixels[a, 1] > pixels[b, 1]:
            a, b = b, a
        if pixels[b, 1] > pixels[c, 1]:
            b, c = c, b
            if pixels[a, 1] > pixels[b, 1]:
                a, b = b, a
        x0, y0 = pixels[a, 0], pixels[a, 1]
        x1, y1 = pixels[b, 0], pixels[b, 1]
        x2, y2 = pixels[c, 0], pixels[c, 1]
        first, last = max(0.0, math.ceil(y0)), min(height - 1.0, math.floor(y2))
        if first > last:
            continue
        w0 = 1.0 / depths[a]
        dw1, dw2 = 1.0 / depths[b] - w0, 1.0 / depths[c] - w0
        area = (x1 - x0) * (y2 - y0) - (x2 - x0) * (y1 - y0)
        along_x = (dw1 * (y2 - y0) - dw2 * (y1 - y0)) / area
        along_y = (dw2 * (x1 - x0) - dw1 * (x2 - x0)) / area
        long = (x2 - x0) / (y2 - y0)
        upper = (x1 - x0) / (y1 - y0) if y1 > y0 else 0.0
        lower = (x2 - x1) / (y2 - y1) if y2 > y1 else 0.0
        for row in range(int(first), int(last) + 1):
            one = x0 + (row - y0) * long
            other = x0 + (row - y0) * upper if row < y1 or y2 <= y1 else x1 + (row - y1) * lower
            left, right = min(one, other), max(one, other)
            if not (left <= width - 1 and right >= 0):
                continue
            begin, end = max(0, math.ceil(left)), min(width - 1, math.floor(right))
            near = w0 + (row - y0) * along_y + (begin - x0) * along_x
            for col in range(begin, end + 1):
                if near > nearness[row, col]:
                    nearness[row, col] = near
                    face_ids[row, col] = f
                near += along_x
