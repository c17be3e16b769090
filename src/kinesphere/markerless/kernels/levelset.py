"""Level sets: a contour that moves to where the statistics of two regions part."""

import numpy as np
from numpy.typing import NDArray

from kinesphere.kernels.jit import kernel

Array = NDArray[np.float64]
Image = NDArray[np.uint8]
Phi = NDArray[np.float32]
Runs = NDArray[np.int32]


@kernel
def region_counts_kernel(features: Image, inside: NDArray[np.bool_], counts: Array) -> None:
    """Count the feature values inside and outside.

    Parameters
    ----------
    features : (height, width, n_features)
    inside : (height, width)
        Where Φ > 0.
    counts : (2, n_features, 256)
        Inside, outside. Written.
    """
    counts[:] = 0.0
    height, width, n = features.shape
    for row in range(height):
        for col in range(width):
            side = 0 if inside[row, col] else 1
            for k in range(n):
                counts[side, k, features[row, col, k]] += 1.0


@kernel
def recount_kernel(
    features: Image, phi: Phi, runs: Runs, inside: NDArray[np.bool_], counts: Array
) -> None:
    """Bring counts up to date where the contour has passed over pixels.

    Parameters
    ----------
    features, counts
        As in `region_counts_kernel`; counts are changed.
    phi : (height, width)
    runs : (n_runs, 3)
        The band in which Φ may have changed, as `band_runs_kernel` gives it.
    inside : (height, width)
        What has been counted as inside. Changed.
    """
    for k in range(len(runs)):
        row = runs[k, 0]
        for col in range(runs[k, 1], runs[k, 2]):
            now = phi[row, col] > 0
            if now != inside[row, col]:
                inside[row, col] = now
                side = 0 if now else 1
                for f in range(features.shape[2]):
                    counts[side, f, features[row, col, f]] += 1.0
                    counts[1 - side, f, features[row, col, f]] -= 1.0


@kernel
def ratios_kernel(features: Image, runs: Runs, ratios: Array, force: Phi) -> None:
    """Write how much likelier each pixel near the contour is the person's, in nats.

    Parameters
    ----------
    features, runs
        As in `recount_kernel`.
    ratios : (n_features, 256)
        log p₁/p₂ of each value of each feature; features count as independent.
    force : (height, width)
        Written within the band.
    """
    n = features.shape[2]
    for i in range(len(runs)):
        row = runs[i, 0]
        for col in range(runs[i, 1], runs[i, 2]):
            ratio = 0.0
            for k in range(n):
                ratio += ratios[k, features[row, col, k]]
            force[row, col] = ratio


@kernel
def contour_kernel(
    phi: Phi, spacing: int, points: Array, normals: Array, taken: NDArray[np.bool_]
) -> int:
    """Write the points where Φ is zero between neighbouring pixels, one in each cell.

    Parameters
    ----------
    phi : (height, width)
    spacing
        px, side of a cell.
    points, normals : (n, 2)
        Pixel (column, row) and the outward unit normal, down the slope of Φ. Written.
    taken : (height // spacing + 1, width // spacing + 1)
        Cleared here.

    Returns
    -------
    int
        How many; at most as many as fit.
    """
    height, width = phi.shape
    taken[:] = False
    count = 0
    for row in range(2, height - 3):
        for col in range(2, width - 3):
            c = phi[row, col]
            for way in range(2):
                d = phi[row, col + 1] if way == 0 else phi[row + 1, col]
                if (c > 0) == (d > 0) or taken[row // spacing, col // spacing]:
                    continue
                t = c / (c - d)
                gx = gy = 0.0
                for k in range(-2, 3):  # over five pixels: a mask's own steps are too rough
                    gx += phi[row + k, col + 2] - phi[row + k, col - 2]
                    gy += phi[row + 2, col + k] - phi[row - 2, col + k]
                size = np.sqrt(gx * gx + gy * gy)
                if size == 0.0:
                    continue
                taken[row // spacing, col // spacing] = True
                points[count, 0] = col + (t if way == 0 else 0.0)
                points[count, 1] = row + (t if way == 1 else 0.0)
                normals[count, 0] = -gx / size
                normals[count, 1] = -gy / size
                count += 1
                if count == len(points):
                    return count
    return count
