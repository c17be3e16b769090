"""Pinhole cameras with OpenCV's lens: world to pixel and pixel to line of sight."""

import numpy as np
from numpy.typing import NDArray

from kinesphere.kernels.jit import kernel

Array = NDArray[np.float64]

_ROUNDS = 20
_TINY = 1e-13


@kernel
def project_kernel(
    points: Array,
    rotation: Array,
    translation: Array,
    matrix: Array,
    distortion: Array,
    widest: float,
    pixels: Array,
) -> None:
    """Write the pixels of points in the world.

    Parameters
    ----------
    points : (n, 3) m
    rotation, translation
        ``camera_from_world``, (3, 3) and (3,) m.
    matrix : (3, 3)
    distortion : (5,)
        k1, k2, p1, p2, k3.
    widest
        Squared tangent of the widest angle at which the lens still maps outward; beyond it the
        polynomial folds back into the image, so NaN is written.
    pixels : (n, 2)
        Written; NaN behind the camera and where the point is NaN.
    """
    k1, k2, p1, p2, k3 = distortion[0], distortion[1], distortion[2], distortion[3], distortion[4]
    for i in range(len(points)):
        x, y, z = points[i, 0], points[i, 1], points[i, 2]
        depth = rotation[2, 0] * x + rotation[2, 1] * y + rotation[2, 2] * z + translation[2]
        if not depth > 0.0:
            pixels[i, 0] = np.nan
            pixels[i, 1] = np.nan
            continue
        a = rotation[0, 0] * x + rotation[0, 1] * y + rotation[0, 2] * z + translation[0]
        b = rotation[1, 0] * x + rotation[1, 1] * y + rotation[1, 2] * z + translation[1]
        a /= depth
        b /= depth
        r2 = a * a + b * b
        if r2 > widest:
            pixels[i, 0] = np.nan
            pixels[i, 1] = np.nan
            continue
        radial = 1.0 + r2 * (k1 + r2 * (k2 + r2 * k3))
        u = a * radial + 2.0 * p1 * a * b + p2 * (r2 + 2.0 * a * a)
        v = b * radial + p1 * (r2 + 2.0 * b * b) + 2.0 * p2 * a * b
        pixels[i, 0] = matrix[0, 0] * u + matrix[0, 1] * v + matrix[0, 2]
        pixels[i, 1] = matrix[1, 1] * v + matrix[1, 2]


@kernel
def undistort_kernel(
    pixels: Array, matrix: Array, distortion: Array, widest: float, plane: Array
) -> None:
    """Write where the lines of sight of pixels meet the plane one unit before the camera.

    Newton's method on the lens polynomial; NaN where no line belongs to the pixel.

    Parameters
    ----------
    pixels : (n, 2)
    widest
        As in `project_kernel`.
    plane : (n, 2)
        Written.
    """
    k1, k2, p1, p2, k3 = distortion[0], distortion[1], distortion[2], distortion[3], distortion[4]
    for i in range(len(pixels)):
        v = (pixels[i, 1] - matrix[1, 2]) / matrix[1, 1]
        u = (pixels[i, 0] - matrix[0, 2] - matrix[0, 1] * v) / matrix[0, 0]
        a, b = u, v
        left = np.inf
        for _ in range(_ROUNDS):
            r2 = a * a + b * b
            radial = 1.0 + r2 * (k1 + r2 * (k2 + r2 * k3))
            slope = k1 + r2 * (2.0 * k2 + 3.0 * k3 * r2)  # of radial, by r2
            e = a * radial + 2.0 * p1 * a * b + p2 * (r2 + 2.0 * a * a) - u
            f = b * radial + p1 * (r2 + 2.0 * b * b) + 2.0 * p2 * a * b - v
            left = e * e + f * f
            if not left > _TINY * _TINY:
                break
            ea = radial + 2.0 * a * a * slope + 2.0 * p1 * b + 6.0 * p2 * a
            eb = 2.0 * a * b * slope + 2.0 * p1 * a + 2.0 * p2 * b
            fb = radial + 2.0 * b * b * slope + 6.0 * p1 * b + 2.0 * p2 * a
            det = ea * fb - eb * eb
            a -= (fb * e - eb * f) / det
            b -= (ea * f - eb * e) / det
        if left < 1e-16 and a * a + b * b <= widest:
            plane[i, 0] = a
            plane[i, 1] = b
        else:
            plane[i, 0] = np.nan
            plane[i, 1] = np.nan
