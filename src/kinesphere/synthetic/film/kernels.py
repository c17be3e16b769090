"""Light on skin and cloth: the seen face of every sample becomes a colour."""

import math

import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Array
from kinesphere.kernels.jit import kernel


@kernel
def shade_kernel(
    face_ids: NDArray[np.int32],
    finer: int,
    pixels: Array,
    depths: Array,
    faces: NDArray[np.int32],
    normals: Array,
    rest: Array,
    colours: Array,
    patterned: Array,
    light: Array,
    ambient: float,
    picture: Array,
) -> None:
    """Blend what is seen into a picture.

    Parameters
    ----------
    face_ids : (height × finer, width × finer)
        The face seen by each sample, −1 for none.
    finer
        Samples a pixel, each way.
    pixels, depths : (n_vertices, 2), (n_vertices,)
        In samples, and m ahead of the camera.
    normals, rest : (n_vertices, 3)
        Unit normals in the world, and the skin at rest, which the pattern sticks to.
    colours : (n_vertices, 3)
        0–255.
    patterned : (n_vertices,)
        0–1, how strong the pattern of the cloth is.
    light : (3,)
        Unit vector towards the light.
    ambient
        0–1, the share of light from everywhere.
    picture : (height, width, 3)
        Holds the background, 0–255; written.
    """
    height, width = picture.shape[0], picture.shape[1]
    share = 1.0 / (finer * finer)
    for row in range(height):
        for col in range(width):
            red = green = blue = covered = 0.0
            for y in range(row * finer, row * finer + finer):
                for x in range(col * finer, col * finer + finer):
                    f = face_ids[y, x]
                    if f < 0:
                        continue
                    a, b, c = faces[f, 0], faces[f, 1], faces[f, 2]
                    ax, ay = pixels[a, 0] - x, pixels[a, 1] - y
                    bx, by = pixels[b, 0] - x, pixels[b, 1] - y
                    cx, cy = pixels[c, 0] - x, pixels[c, 1] - y
                    p = (bx * cy - by * cx) / depths[a]
                    q = (cx * ay - cy * ax) / depths[b]
                    r = (ax * by - ay * bx) / depths[c]
                    total = p + q + r
                    p, q, r = p / total, q / total, r / total
                    towards = 0.0
                    for k in range(3):
                        n = p * normals[a, k] + q * normals[b, k] + r * normals[c, k]
                        towards += n * light[k]
                    lit = ambient + (1.0 - ambient) * max(0.0, towards)
                    cloth = p * patterned[a] + q * patterned[b] + r * patterned[c]
                    if cloth > 0.01:
                        u = p * rest[a, 0] + q * rest[b, 0] + r * rest[c, 0]
                        v = p * rest[a, 1] + q * rest[b, 1] + r * rest[c, 1]
                        w = p * rest[a, 2] + q * rest[b, 2] + r * rest[c, 2]
                        wave = math.sin(90.0 * v) * math.sin(70.0 * (u + w))
                        lit *= 1.0 + 0.55 * cloth * (1.0 if wave > 0.0 else -1.0)
                    red += lit * (p * colours[a, 0] + q * colours[b, 0] + r * colours[c, 0])
                    green += lit * (p * colours[a, 1] + q * colours[b, 1] + r * colours[c, 1])
                    blue += lit * (p * colours[a, 2] + q * colours[b, 2] + r * colours[c, 2])
                    covered += 1.0
            if covered > 0.0:
                left = 1.0 - covered * share
                picture[row, col, 0] = left * picture[row, col, 0] + red * share
                picture[row, col, 1] = left * picture[row, col, 1] + green * share
                picture[row, col, 2] = left * picture[row, col, 2] + blue * share
