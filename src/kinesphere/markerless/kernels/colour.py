"""Colour statistics of limbs and backgrounds, and how likely a pixel is the person's by them."""

import numpy as np
from numpy.typing import NDArray

from kinesphere.kernels.jit import kernel
from kinesphere.markerless.kernels.contour import NOWHERE
from kinesphere.markerless.kernels.lines import NEUTRAL, REACH, SAMPLES

Array = NDArray[np.float64]
Ints = NDArray[np.int32]
Image = NDArray[np.uint8]
Bins = NDArray[np.uint16]

FLOOR = 2e-5
"""Density that any colour has at least, anywhere: one pixel alone proves nothing."""


@kernel
def bin_of(level: Image, row: int, col: int, bins: Bins) -> int:
    """Return the histogram bin of a pixel's colour."""
    return int(
        bins[
            ((level[row, col, 0] >> 3) << 10)
            + ((level[row, col, 1] >> 3) << 5)
            + (level[row, col, 2] >> 3)
        ]
    )


@kernel
def colour_samples_kernel(
    pixels: Array,
    normals: Array,
    rim_parts: Ints,
    use: NDArray[np.int8],
    level: Image,
    factor: float,
    step: float,
    bins: Bins,
    groups: Ints,
    limbs: NDArray[np.float32],
    near: NDArray[np.float32],
    far: NDArray[np.float32],
    local: float,
    probabilities: Array,
) -> None:
    """Write how likely each sample of each line is the person's, by its colour.

    Parameters
    ----------
    pixels, normals, rim_parts, use, step
        As in `open_line_kernel`.
    level : (height, width, 3)
        The image, ``factor`` times smaller than the view.
    bins : (32768,)
        Histogram bin of five bits each of red, green and blue.
    groups : (n_limbs,)
        Which statistics a limb has.
    limbs, near : (n_groups, n_bins)
        Densities of colours on limbs, and on the background beside them.
    far : (n_bins,)
        Density of colours anywhere in the background.
    local
        Share of ``near`` in the background of a line. What is behind an inner contour is a limb,
        and its density the background.
    probabilities : (n, SAMPLES)
        Written; 0.5 where nothing can be told.
    """
    height, width = level.shape[:2]
    for i in range(len(pixels)):
        own, beyond = groups[rim_parts[i, 0]], NOWHERE
        if rim_parts[i, 1] != NOWHERE:
            beyond = groups[rim_parts[i, 1]]
        for j in range(SAMPLES):
            probabilities[i, j] = NEUTRAL
            if not use[i, j] or own == beyond:
                continue
            r = (j - REACH) * step
            col = int(np.rint((pixels[i, 0] + r * normals[i, 0] + 0.5) / factor - 0.5))
            row = int(np.rint((pixels[i, 1] + r * normals[i, 1] + 0.5) / factor - 0.5))
            if not (0 <= row < height and 0 <= col < width):
                continue
            b = bin_of(level, row, col, bins)
            inside = limbs[own, b] + FLOOR
            if beyond == NOWHERE:
                outside = local * near[own, b] + (1.0 - local) * far[b] + FLOOR
            else:
                outside = limbs[beyond, b] + FLOOR
            probabilities[i, j] = inside / (inside + outside)


@kernel
def count_lines_kernel(
    pixels: Array,
    normals: Array,
    rim_parts: Ints,
    parts: Ints,
    near_limbs: NDArray[np.bool_],
    level: Image,
    bins: Bins,
    groups: Ints,
    first: int,
    inward: int,
    outward: int,
    limbs: NDArray[np.float32],
    near: NDArray[np.float32],
) -> None:
    """Count colours along lines across the rim, beginning ``first`` px from it to either side.

    Parameters
    ----------
    pixels, normals, rim_parts, parts, near_limbs
        As in `open_line_kernel`.
    inward, outward
        px, how far.
    limbs, near : (n_groups, n_bins)
        Counted into.
    """
    height, width = parts.shape
    for i in range(len(pixels)):
        own = rim_parts[i, 0]
        group = groups[own]
        for side in (-1, 1):
            if side > 0 and rim_parts[i, 1] != NOWHERE:
                continue
            for j in range(first, (inward if side < 0 else outward) + 1):
                col = int(np.rint(pixels[i, 0] + side * j * normals[i, 0]))
                row = int(np.rint(pixels[i, 1] + side * j * normals[i, 1]))
                if not (0 <= row < height and 0 <= col < width):
                    break
                seen = parts[row, col]
                if side < 0:
                    if seen == NOWHERE or not near_limbs[own, seen]:
                        break
                    # counted for what is seen there: the lines of a sleeve may reach the hand
                    limbs[groups[seen], bin_of(level, row, col, bins)] += 1.0
                else:
                    if seen != NOWHERE:
                        break
                    near[group, bin_of(level, row, col, bins)] += 1.0


@kernel
def count_far_kernel(
    parts: Ints, level: Image, bins: Bins, stride: int, far: NDArray[np.float32]
) -> None:
    """Count the colours of a grid of pixels that show no limb."""
    height, width = parts.shape
    for row in range(0, height, stride):
        for col in range(0, width, stride):
            if parts[row, col] == NOWHERE:
                far[bin_of(level, row, col, bins)] += 1.0


@kernel
def blurred_kernel(counts: NDArray[np.float32], side: int, smooth: NDArray[np.float32]) -> None:
    """Write a histogram of colours as a density: blurred by (¼, ½, ¼) along each axis, sum 1.

    Parameters
    ----------
    counts, smooth : (side³,)
        An empty histogram becomes an empty density.
    """
    total = 0.0
    for b in range(len(counts)):
        total += counts[b]
    if total == 0.0:
        smooth[:] = 0.0
        return
    now = counts / np.float32(total)
    stride = 1
    for _ in range(3):
        for first in range(0, len(counts), stride * side):
            for at in range(side):
                here = first + at * stride
                below = here - stride if at > 0 else here
                above = here + stride if at < side - 1 else here
                for b in range(stride):
                    smooth[here + b] = 0.5 * now[here + b] + 0.25 * (
                        now[below + b] + now[above + b]
                    )
        now = smooth.copy()
        stride *= side
