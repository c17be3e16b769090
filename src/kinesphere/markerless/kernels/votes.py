"""Votes of contour points for the limbs they belong to (Rosenhahn et al. 2006, section 2.2)."""

import numpy as np
from numpy.typing import NDArray

from kinesphere.kernels.jit import kernel

Array = NDArray[np.float64]
Ints = NDArray[np.int32]


@kernel
def vote_kernel(
    points: Array,
    normals: Array,
    rim_pixels: Array,
    rim_normals: Array,
    rim_limbs: Ints,
    radius: float,
    agree: float,
    inward: Ints,
    outward: Ints,
    far_in: Array,
    far_out: Array,
) -> None:
    """Match a contour to the rim both ways (section 2.2).

    Inward, every compatible rim point within the radius of a contour point votes for its limb, a
    near one more; of the limb that wins the nearest is taken. Outward, each rim point takes the
    nearest compatible contour point.

    Parameters
    ----------
    points, normals : (n, 2)
        Of the contour.
    rim_pixels, rim_normals, rim_limbs : (m, 2), (m, 2), (m,)
    radius
        px.
    agree
        Least cosine between the normals.
    inward, far_in : (n,)
        Rim point, −1 for none; px, NaN for none. Written.
    outward, far_out : (m,)
        Contour point, and the same. Written.
    """
    n_limbs = rim_limbs.max() + 1 if len(rim_limbs) else 0
    votes, nearest = np.empty(n_limbs), np.empty(n_limbs)
    best = np.empty(n_limbs, dtype=np.int32)
    order = np.argsort(rim_pixels[:, 1])  # so that only rows within the radius are gone through
    rows = rim_pixels[order, 1]
    soft = (0.25 * radius) ** 2
    outward[:] = -1
    far_out[:] = np.inf
    for i in range(len(points)):
        votes[:] = 0.0
        nearest[:] = np.inf
        for k in range(np.searchsorted(rows, points[i, 1] - radius), len(order)):
            if rows[k] > points[i, 1] + radius:
                break
            j = order[k]
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
            if square < far_out[j]:
                far_out[j] = square
                outward[j] = i
        inward[i] = -1
        far_in[i] = np.nan
        if n_limbs and votes.max() > 0.0:
            limb = votes.argmax()
            inward[i] = best[limb]
            far_in[i] = np.sqrt(nearest[limb])
    for j in range(len(far_out)):
        far_out[j] = np.sqrt(far_out[j]) if outward[j] >= 0 else np.nan


@kernel
def match_kernel(
    points: Array,
    normals: Array,
    rim_pixels: Array,
    rim_normals: Array,
    rim_limbs: Ints,
    radius: float,
    agree: float,
    reject: float,
) -> tuple[Ints, Ints]:
    """Return rim points and the contour points they belong to, (n,) each: inward, then outward.

    Parameters
    ----------
    points, normals, rim_pixels, rim_normals, rim_limbs, radius, agree
        As in `vote_kernel`.
    reject
        Pairs are left out that are farther apart than so many times the median, and than 2 px.
    """
    n, m = len(points), len(rim_pixels)
    inward, outward = np.empty(n, dtype=np.int32), np.empty(m, dtype=np.int32)
    far_in, far_out = np.empty(n), np.empty(m)
    vote_kernel(
        points,
        normals,
        rim_pixels,
        rim_normals,
        rim_limbs,
        radius,
        agree,
        inward,
        outward,
        far_in,
        far_out,
    )
    rims, targets = np.empty(n + m, dtype=np.int32), np.empty(n + m, dtype=np.int32)
    far = np.empty(n + m)
    count = 0
    for i in range(n):
        if inward[i] >= 0:
            rims[count], targets[count], far[count] = inward[i], i, far_in[i]
            count += 1
    for j in range(m):
        if outward[j] >= 0:
            rims[count], targets[count], far[count] = j, outward[j], far_out[j]
            count += 1
    if count == 0:
        return rims[:0], targets[:0]
    most = max(reject * np.median(far[:count]), 2.0)
    kept = 0
    for k in range(count):
        if far[k] <= most:
            rims[kept], targets[kept] = rims[k], targets[k]
            kept += 1
    return rims[:kept], targets[:kept]
