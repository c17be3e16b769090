"""The rim: where a surface turns away from a camera, and what is seen on either side of it."""

import numpy as np
from numpy.typing import NDArray

from kinesphere.kernels.jit import kernel

Array = NDArray[np.float64]
Ints = NDArray[np.int32]

INSIDE, OUTSIDE = 1.5, 1.5  # px from the rim at which the part buffer is asked
NOWHERE = -1
"""Part of a pixel that shows no limb."""


@kernel
def project_kernel(
    points: Array, rotation: Array, shift: Array, lens: Array, pixels: Array, depths: Array
) -> tuple[float, float, float, float]:
    """Write pixels (NaN behind the camera) and depths of points seen by a pinhole.

    Parameters
    ----------
    points : (n, 3) m
    rotation, shift
        ``camera_from_world``.
    lens : (4,)
        fx, fy, cx, cy in px.
    pixels, depths : (n, 2), (n,)
        Written.

    Returns
    -------
    left, top, right, bottom : float
        px, the outermost pixels; left > right where all is behind the camera.
    """
    left, top, right, bottom = np.inf, np.inf, -np.inf, -np.inf
    for i in range(len(points)):
        x, y, z = points[i, 0], points[i, 1], points[i, 2]
        w = rotation[2, 0] * x + rotation[2, 1] * y + rotation[2, 2] * z + shift[2]
        depths[i] = w
        if w <= 1e-3:
            pixels[i, 0] = np.nan
            pixels[i, 1] = np.nan
            continue
        u = rotation[0, 0] * x + rotation[0, 1] * y + rotation[0, 2] * z + shift[0]
        v = rotation[1, 0] * x + rotation[1, 1] * y + rotation[1, 2] * z + shift[1]
        pixels[i, 0] = lens[0] * u / w + lens[2]
        pixels[i, 1] = lens[1] * v / w + lens[3]
        left, right = min(left, pixels[i, 0]), max(right, pixels[i, 0])
        top, bottom = min(top, pixels[i, 1]), max(bottom, pixels[i, 1])
    return left, top, right, bottom


@kernel
def parts_kernel(face_ids: Ints, part_of_face: Ints, parts: Ints) -> None:
    """Write which limb each pixel shows, NOWHERE for none; both (height, width)."""
    for row in range(face_ids.shape[0]):
        for col in range(face_ids.shape[1]):
            f = face_ids[row, col]
            parts[row, col] = part_of_face[f] if f >= 0 else NOWHERE


@kernel
def rim_kernel(
    points: Array,
    normals: Array,
    edges: Ints,
    centre: Array,
    rotation: Array,
    shift: Array,
    lens: Array,
    parts: Ints,
    nearness: NDArray[np.float32],
    limb_of_vertex: Ints,
    cell: int,
    behind: float,
    taken: NDArray[np.bool_],
    rim_edges: Ints,
    rim_shares: Array,
    rim_pixels: Array,
    rim_normals: Array,
    rim_parts: Ints,
) -> int:
    """Find the visible rim: zero crossings of n · (c − x) along the mesh's edges.

    A rim point counts where the part buffer shows its own surface just inside and, just outside,
    the background or something clearly farther away. One is kept in each cell of the image.

    Parameters
    ----------
    points, normals : (n_vertices, 3)
    edges : (n_edges, 2)
    centre : (3,) m
        The camera's.
    rotation, shift, lens
        As in `project_kernel`.
    parts, nearness : (height, width)
        Limb and 1/depth of what each pixel shows; NOWHERE and 0 where nothing.
    limb_of_vertex : (n_vertices,)
    cell
        px.
    behind
        m; how much farther what is seen outside must be, so that a fold is no rim.
    taken : (height // cell + 1, width // cell + 1)
        Cleared here.
    rim_edges, rim_shares
        Edge of each rim point, and how far along it the point is (0 to 1). Written.
    rim_pixels, rim_normals : (n, 2)
        px, and the outward unit normal in the image. Written.
    rim_parts : (n, 2)
        The limb inside, and what is seen outside. Written.

    Returns
    -------
    int
        How many were found; at most as many as fit.
    """
    height, width = parts.shape
    taken[:] = False
    facing = np.empty(len(points))
    for v in range(len(points)):
        facing[v] = (
            normals[v, 0] * (centre[0] - points[v, 0])
            + normals[v, 1] * (centre[1] - points[v, 1])
            + normals[v, 2] * (centre[2] - points[v, 2])
        )
    count = 0
    for e in range(len(edges)):
        a, b = edges[e, 0], edges[e, 1]
        if (facing[a] > 0.0) == (facing[b] > 0.0):
            continue
        t = facing[a] / (facing[a] - facing[b])
        x = points[a, 0] + t * (points[b, 0] - points[a, 0])
        y = points[a, 1] + t * (points[b, 1] - points[a, 1])
        z = points[a, 2] + t * (points[b, 2] - points[a, 2])
        depth = rotation[2, 0] * x + rotation[2, 1] * y + rotation[2, 2] * z + shift[2]
        if not depth > 1e-3:
            continue
        u = rotation[0, 0] * x + rotation[0, 1] * y + rotation[0, 2] * z + shift[0]
        v = rotation[1, 0] * x + rotation[1, 1] * y + rotation[1, 2] * z + shift[1]
        px = lens[0] * u / depth + lens[2]
        py = lens[1] * v / depth + lens[3]
        if not (0.0 <= px <= width - 1.0 and 0.0 <= py <= height - 1.0):
            continue
        if taken[int(py) // cell, int(px) // cell]:
            continue
        x = normals[a, 0] + t * (normals[b, 0] - normals[a, 0])
        y = normals[a, 1] + t * (normals[b, 1] - normals[a, 1])
        z = normals[a, 2] + t * (normals[b, 2] - normals[a, 2])
        # the tangent plane goes through the camera, so its image is a line with this normal
        nx = (rotation[0, 0] * x + rotation[0, 1] * y + rotation[0, 2] * z) / lens[0]
        ny = (rotation[1, 0] * x + rotation[1, 1] * y + rotation[1, 2] * z) / lens[1]
        size = np.sqrt(nx * nx + ny * ny)
        if size == 0.0:
            continue
        nx /= size
        ny /= size
        col, row = int(np.rint(px - INSIDE * nx)), int(np.rint(py - INSIDE * ny))
        if not (0 <= row < height and 0 <= col < width) or parts[row, col] == NOWHERE:
            continue
        if abs(1.0 / nearness[row, col] - depth) > 2.0 * behind:
            continue  # something else is in front of it
        col, row = int(np.rint(px + OUTSIDE * nx)), int(np.rint(py + OUTSIDE * ny))
        beyond = NOWHERE
        if 0 <= row < height and 0 <= col < width and parts[row, col] != NOWHERE:
            beyond = parts[row, col]
            if 1.0 / nearness[row, col] < depth + behind:
                continue
        taken[int(py) // cell, int(px) // cell] = True
        rim_edges[count] = e
        rim_shares[count] = t
        rim_pixels[count, 0] = px
        rim_pixels[count, 1] = py
        rim_normals[count, 0] = nx
        rim_normals[count, 1] = ny
        rim_parts[count, 0] = limb_of_vertex[a] if t < 0.5 else limb_of_vertex[b]
        rim_parts[count, 1] = beyond
        count += 1
        if count == len(rim_edges):
            break
    return count
