"""Votes of contour points for the limbs they belong to (Rosenhahn et al. 2006, section 2.2)."""

import numpy as np
from numpy.typing import NDArray

from kinesphere.kernels.jit import kernel

Array = NDArray[np.float64]


@kernel
def vote_kernel(
    points: Array,
    normals: Array,
    rim_pixels: Array,
    rim_normals: Array,
    rim_limbs: NDArray[np.int32],
    radius: float,
    agree: float,
    match: NDArray[np.int32],
    distances: Array,
) -> None:
    """Match each point of a contour to a point of the rim, by a vote on the limb (section 2.2).

    Every compatible rim point within the radius votes for its limb, a near one more; of the limb
    that wins the nearest is taken.

    Parameters
    ----------
    points, normals : (n, 2)
        Of the contour.
    rim_pixels, rim_normals, rim_limbs : (m, 2), (m, 2), (m,)
    radius
        px.
    agree
        Least cosine between the normals.
    match, distances : (n,)
        Rim point, −1 for none; px. Written.
    """
    n_limbs = rim_limbs.max() + 1 if len(rim_limbs) else 0
    votes, nearest = np.empty(n_limbs), np.empty(n_limbs)
    best = np.empty(n_limbs, dtype=np.int32)
    soft = (0.25 * radius) ** 2
    for i in range(len(points)):
        votes[:] = 0.0
        nearest[:] = np.inf
        for j in range(len(rim_pixels)):
            dx, dy = rim_pixels[j, 0] - points[i, 0], rim_pixels[j, 1] - points[i, 1]
            square = dx * dx + dy * dy
            if square > radius * radius:
                continue
            if normals[i, 0] * rim_normals[j, 0] + normals[i, 1] * rim_normals[j, 1] < agree:
                continue
            limb = rim_limbs[j]
            votes[limb] += 1.0 / (1.0 + square / soft) ** 2
            if square < nearest[limb]:
                nearest[limb] = square
                best[limb] = j
        match[i] = -1
        distances[i] = np.nan
        if n_limbs and votes.max() > 0.0:
            limb = votes.argmax()
            match[i] = best[limb]
            distances[i] = np.sqrt(nearest[limb])
