"""How much likelier pixels are a limb's than the background's, alone and summed up by limb."""

import numpy as np
from numpy.typing import NDArray

from kinesphere.kernels.jit import kernel
from kinesphere.markerless.kernels.colour import FLOOR, bin_of
from kinesphere.markerless.kernels.contour import NOWHERE

Array = NDArray[np.float64]
Ints = NDArray[np.int32]
Image = NDArray[np.uint8]
Bins = NDArray[np.uint16]


@kernel
def log_ratios_kernel(
    owners: Ints,
    level: Image,
    bins: Bins,
    groups: Ints,
    limbs: NDArray[np.float32],
    near: NDArray[np.float32],
    far: NDArray[np.float32],
    local: float,
    ratios: NDArray[np.float32],
) -> None:
    """Write how much likelier each pixel is its limb's than the background's, in nats.

    Parameters
    ----------
    owners : (height, width)
        The limb a pixel is asked for; NOWHERE for none.
    level, bins, groups, limbs, near, far, local
        As in `colour_samples_kernel`.
    ratios : (height, width)
        Written; 0 where no limb is asked for.
    """
    table = np.empty(limbs.shape, dtype=np.float32)
    for g in range(limbs.shape[0]):
        for b in range(limbs.shape[1]):
            outside = local * near[g, b] + (1.0 - local) * far[b] + FLOOR
            table[g, b] = np.log((limbs[g, b] + FLOOR) / outside)
    height, width = owners.shape
    for row in range(height):
        for col in range(width):
            limb = owners[row, col]
            ratios[row, col] = 0.0
            if limb != NOWHERE:
                ratios[row, col] = table[groups[limb], bin_of(level, row, col, bins)]


@kernel
def region_score_kernel(
    parts: Ints,
    level: Image,
    bins: Bins,
    groups: Ints,
    limbs: NDArray[np.float32],
    far: NDArray[np.float32],
    stride: int,
    most: float,
    scores: Array,
    counts: Array,
) -> None:
    """Sum, over the pixels each limb covers, how much likelier they are its than background.

    Parameters
    ----------
    most
        The most one pixel may say for or against, in nats.
    scores, counts : (n_limbs,)
        Added to.
    """
    height, width = parts.shape
    for row in range(0, height, stride):
        for col in range(0, width, stride):
            limb = parts[row, col]
            if limb != NOWHERE:
                b = bin_of(level, row, col, bins)
                ratio = np.log((limbs[groups[limb], b] + FLOOR) / (far[b] + FLOOR))
                scores[limb] += min(max(ratio, -most), most)
                counts[limb] += 1.0


@kernel
def mask_score_kernel(
    parts: Ints, level: Image, stride: int, most: float, scores: Array, counts: Array
) -> None:
    """Sum the same from an image of how likely each pixel is the person's, 0 to 255."""
    height, width = parts.shape
    for row in range(0, height, stride):
        for col in range(0, width, stride):
            limb = parts[row, col]
            if limb != NOWHERE:
                p = 0.02 + 0.96 * level[row, col] / 255.0
                scores[limb] += min(max(np.log(p / (1.0 - p)), -most), most)
                counts[limb] += 1.0
