"""Level sets: a contour that moves to where the statistics of two regions part."""

import numpy as np
from numpy.typing import NDArray

from kinesphere.kernels.jit import kernel

Array = NDArray[np.float64]
Image = NDArray[np.uint8]
Phi = NDArray[np.float32]

_MOST = 6.0  # nats; a pixel's say is cut there, as both densities are guesses


@kernel
def region_counts_kernel(features: Image, phi: Phi, counts: Array) -> None:
    """Count the feature values inside (Φ > 0) and outside.

    Parameters
    ----------
    features : (height, width, n_features)
    phi : (height, width)
    counts : (2, n_features, 256)
        Inside, outside. Written.
    """
    counts[:] = 0.0
    height, width, n = features.shape
    for row in range(height):
        for col in range(width):
            side = 0 if phi[row, col] > 0 else 1
            for k in range(n):
                counts[side, k, features[row, col, k]] += 1.0


@kernel
def ratios_kernel(features: Image, phi: Phi, ratios: Array, band: float, force: Phi) -> None:
    """Write how much likelier each pixel near the contour is the person's, in nats.

    Parameters
    ----------
    features, phi
        As in `region_counts_kernel`.
    ratios : (n_features, 256)
        log p₁/p₂ of each value of each feature; features count as independent.
    band
        px to either side of the contour.
    force : (height, width)
        Written within the band.
    """
    height, width, n = features.shape
    for row in range(height):
        for col in range(width):
            if abs(phi[row, col]) < band:
                ratio = 0.0
                for k in range(n):
                    ratio += ratios[k, features[row, col, k]]
                force[row, col] = ratio


@kernel
def evolve_kernel(
    phi: Phi,
    force: Phi,
    length: float,
    shape: float,
    prior: Phi,
    inside_delta: bool,
    width_px: float,
    band: float,
    rate: float,
    steps: int,
) -> float:
    """Move Φ by ``steps`` of gradient descent in a narrow band about its zero level.

    Equation 2; with ``shape`` > 0 equation 4, whose last term is by the energy's own derivative
    outside H'(Φ)(…), and inside it as printed where ``inside_delta`` is set.

    Parameters
    ----------
    phi : (height, width) px
        Positive inside. Changed.
    force : (height, width)
        log p₁/p₂ of each pixel of the band.
    length
        ν, weight of the contour's length.
    shape
        λ, in 1/px: weight of staying near ``prior``, Φ₀ of the projected surface.
    width_px
        Standard deviation of H', in px.
    band
        px to either side of the contour.
    rate
        Time step.
    steps

    Returns
    -------
    float
        Mean change of Φ in the last step, in px, over the band.
    """
    height, width = phi.shape
    count = 0
    for row in range(1, height - 1):
        for col in range(1, width - 1):
            if abs(phi[row, col]) < band:
                count += 1
    where = np.empty((count, 2), dtype=np.int32)
    pull = np.empty(count)
    at = 0
    for row in range(1, height - 1):
        for col in range(1, width - 1):
            if abs(phi[row, col]) < band:
                where[at, 0] = row
                where[at, 1] = col
                pull[at] = min(max(force[row, col], -_MOST), _MOST)
                at += 1
    change = np.empty(count)
    delta_0 = 1.0 / (width_px * np.sqrt(2.0 * np.pi))
    moved = 0.0
    for _ in range(steps):
        moved = 0.0
        for i in range(count):
            row, col = where[i, 0], where[i, 1]
            c = phi[row, col]
            left, right = phi[row, col - 1], phi[row, col + 1]
            up, down = phi[row - 1, col], phi[row + 1, col]
            px, py = 0.5 * (right - left), 0.5 * (down - up)
            pxx, pyy = right - 2 * c + left, down - 2 * c + up
            pxy = 0.25 * (
                phi[row + 1, col + 1]
                - phi[row + 1, col - 1]
                - phi[row - 1, col + 1]
                + phi[row - 1, col - 1]
            )
            slope = px * px + py * py + 1e-6
            curvature = (pxx * py * py - 2 * px * py * pxy + pyy * px * px) / slope**1.5
            curvature = min(max(curvature, -1.0), 1.0)
            delta = delta_0 * np.exp(-0.5 * (c / width_px) ** 2)
            to_prior = 2.0 * shape * (prior[row, col] - c)
            if inside_delta:
                change[i] = rate * delta * (pull[i] + length * curvature + to_prior)
            else:
                change[i] = rate * (delta * (pull[i] + length * curvature) + to_prior)
        for i in range(count):
            phi[where[i, 0], where[i, 1]] += change[i]
            moved += abs(change[i])
    return moved / max(count, 1)


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
