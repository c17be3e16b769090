"""Surfaces drawn into images: their silhouette, and which face is seen in each pixel."""

import numpy as np
from numpy.typing import NDArray

from kinesphere.kernels.raster import silhouette_kernel, visible_faces_kernel

Array = NDArray[np.float64]
NOTHING = -1
"""In a buffer of face numbers: no face."""


def silhouette(
    pixels: Array, faces: NDArray[np.int32], width: int, height: int, *, closed: bool = True
) -> NDArray[np.bool_]:
    """Return which pixels a surface covers, (height, width).

    A pixel counts where its centre is covered, so areas are right on average; OpenCV's polygon
    fill also sets what the outline touches, half a pixel too much all around.

    Parameters
    ----------
    pixels : (n_vertices, 2) px
        Pixel centres at integers. Faces with a NaN corner are left out.
    faces : (n_faces, 3)
        Counter-clockwise seen from outside.
    closed
        Whether the surface is closed, so that what shows its back need not be drawn.
    """
    mask = np.zeros((height, width), dtype=np.bool_)
    silhouette_kernel(pixels, faces, closed, mask)
    return mask


def visible_faces(
    pixels: Array,
    depths: Array,
    faces: NDArray[np.int32],
    width: int,
    height: int,
    *,
    closed: bool = True,
) -> tuple[NDArray[np.int32], NDArray[np.float32]]:
    """Return which face is seen in each pixel (−1: none), and its 1/depth (0: none).

    Parameters
    ----------
    pixels : (n_vertices, 2) px
    depths : (n_vertices,) m
        Ahead of the camera. The other parameters are those of `silhouette`.

    Returns
    -------
    face_ids : (height, width)
    nearness : (height, width) 1/m
    """
    face_ids = np.full((height, width), NOTHING, dtype=np.int32)
    nearness = np.zeros((height, width), dtype=np.float32)
    visible_faces_kernel(pixels, depths, faces, closed, nearness, face_ids)
    return face_ids, nearness


def barycentric(
    face_ids: NDArray[np.int32], pixels: Array, depths: Array, faces: NDArray[np.int32]
) -> tuple[NDArray[np.intp], NDArray[np.intp], Array]:
    """Return, for each covered pixel, row, column and the shares of its face's corners.

    Shares are of the surface in space (perspective corrected), so they carry colours, normals or
    skin weights.

    Returns
    -------
    rows, columns : (n,)
    shares : (n, 3)
        They sum to one.
    """
    rows, columns = np.nonzero(face_ids != NOTHING)
    corners = faces[face_ids[rows, columns]]
    p = pixels[corners] - np.stack([columns, rows], axis=-1)[:, None]
    following, last = np.roll(p, -1, axis=1), np.roll(p, -2, axis=1)
    # the part of the triangle opposite a corner is that corner's share of the image
    shares = following[..., 0] * last[..., 1] - following[..., 1] * last[..., 0]
    shares /= depths[corners]
    shares /= shares.sum(axis=1, keepdims=True)
    return rows, columns, shares
