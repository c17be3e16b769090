"""Correspondence lines: how likely pixels across the rim are the person's, where the edge is.

After Stoiber et al. (2022), SRT3D, doi:10.1007/s11263-022-01579-8: the posterior of the contour's
offset along a line is the product, over its pixels, of what a smoothed step there would expect.
"""

import numpy as np
from numpy.typing import NDArray

from kinesphere.kernels.jit import kernel
from kinesphere.markerless.kernels.contour import NOWHERE

Array = NDArray[np.float64]
Ints = NDArray[np.int32]

REACH = 7
"""Samples to each side of the rim."""
SEARCH = 5
"""Offsets to each side of it that are weighed."""
SAMPLES = 2 * REACH + 1
NEUTRAL = 0.5


@kernel
def open_line_kernel(
    pixels: Array,
    normals: Array,
    rim_parts: Ints,
    parts: Ints,
    near_limbs: NDArray[np.bool_],
    step: float,
    use: NDArray[np.int8],
) -> None:
    """Write which samples of every line can tell something.

    Parameters
    ----------
    pixels, normals, rim_parts : (n, 2)
        The rim.
    parts : (height, width)
        Limb of every pixel.
    near_limbs : (n_limbs, n_limbs)
        Whether two limbs are one for this purpose: the same, or joined.
    step
        px between samples.
    use : (n, SAMPLES)
        1 for a sample the line's own limb or its background should be at; 0 where the line has run
        into another limb, through its own, or out of the image. Written.
    """
    height, width = parts.shape
    for i in range(len(pixels)):
        own, beyond = rim_parts[i, 0], rim_parts[i, 1]
        for side in (-1, 1):
            free = True
            for j in range(0 if side < 0 else 1, REACH + 1):
                r = side * j * step
                col = int(np.rint(pixels[i, 0] + r * normals[i, 0]))
                row = int(np.rint(pixels[i, 1] + r * normals[i, 1]))
                if not (0 <= row < height and 0 <= col < width):
                    free = False
                elif j * step > 1.5:
                    seen = parts[row, col]
                    if side < 0:
                        free = free and seen != NOWHERE and near_limbs[own, seen]
                    else:
                        free = free and seen == beyond
                use[i, REACH + side * j] = free


@kernel
def mask_samples_kernel(
    pixels: Array,
    normals: Array,
    use: NDArray[np.int8],
    level: NDArray[np.uint8],
    factor: float,
    step: float,
    probabilities: Array,
) -> None:
    """Write how likely each sample is the person's, from an image of that likelihood.

    Parameters
    ----------
    pixels, normals, use, step
        As in `open_line_kernel`.
    level : (height, width)
        0 to 255, ``factor`` times smaller than the view.
    probabilities : (n, SAMPLES)
        Written; 0.5 where nothing can be told.
    """
    height, width = level.shape
    for i in range(len(pixels)):
        for j in range(SAMPLES):
            probabilities[i, j] = NEUTRAL
            if not use[i, j]:
                continue
            r = (j - REACH) * step
            x = (pixels[i, 0] + r * normals[i, 0] + 0.5) / factor - 0.5
            y = (pixels[i, 1] + r * normals[i, 1] + 0.5) / factor - 0.5
            x, y = min(max(x, 0.0), width - 1.0), min(max(y, 0.0), height - 1.0)
            col, row = min(int(x), width - 2), min(int(y), height - 2)
            u, v = x - col, y - row
            value = (1 - v) * ((1 - u) * level[row, col] + u * level[row, col + 1]) + v * (
                (1 - u) * level[row + 1, col] + u * level[row + 1, col + 1]
            )
            probabilities[i, j] = 0.02 + 0.96 * value / 255.0


@kernel
def offsets_kernel(
    probabilities: Array,
    steepness: float,
    trust: float,
    means: Array,
    variances: Array,
    agreement: Array,
) -> None:
    """Write where on each line the edge is, in samples outward from the rim.

    Parameters
    ----------
    probabilities : (n, SAMPLES)
        Of being the person's, from inside out.
    steepness
        Samples over which the expected step goes from one side to the other.
    trust
        Half the height of that step, below 0.5: how often a pixel may be on the wrong side.
    means, variances : (n,)
        Of the offset's posterior. Written.
    agreement : (n,)
        Share of the line's evidence that says, with the edge where the rim is, what it should
        (0 to 1); NaN where the line has none. Written.
    """
    n_offsets = 2 * SEARCH + 1
    table = np.empty(2 * (REACH + SEARCH) + 1)
    for k in range(len(table)):
        table[k] = 0.5 - trust * np.tanh((k - REACH - SEARCH) / steepness)
    posterior = np.empty(n_offsets)
    for i in range(len(probabilities)):
        total = mean = square = 0.0
        for o in range(n_offsets):
            d = o - SEARCH
            p = 1.0
            for j in range(SAMPLES):
                f = probabilities[i, j]
                h = table[j - d + SEARCH]
                p *= 2.0 * (h * f + (1.0 - h) * (1.0 - f))
            posterior[o] = p
            total += p
            mean += p * d
        mean /= total
        for o in range(n_offsets):
            square += posterior[o] * (o - SEARCH - mean) ** 2
        means[i] = mean
        variances[i] = square / total
        right = told = 0.0
        for j in range(SAMPLES):
            f = 2.0 * probabilities[i, j] - 1.0
            if j == REACH:
                continue
            told += abs(f)
            right += max(f, 0.0) if j < REACH else max(-f, 0.0)
        agreement[i] = right / told if told > 0.5 else np.nan
