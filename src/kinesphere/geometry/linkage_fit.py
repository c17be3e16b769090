"""Bodies that hang together at joints, fitted to their markers all at once."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinesphere.geometry.linkage import (
    WIDEST,
    Linkage,
    by_pose_of,
    equations,
    idle,
    inverse_of,
    misfit,
    moved_by,
    scale_of,
    square_of,
    still,
)
from kinesphere.geometry.vectors import is_seen, lengths

Array = NDArray[np.float64]

SETTLED = 1e-5
"""m, step of shapes and centres that ends the fit."""
STILL = 1e-3
"""rad, turn that ends the fit of a pose."""
DONE = 1e-4
"""rad, turn after which a pose is left as it is."""
NEAR = 0.3
"""rad, how far bodies may have turned since the poses that a fit of poses begins with."""
LONGEST = 0.05
"""m, longest step of them."""


class LinkageFit(NamedTuple):
    """A linkage that fits its markers, and how well they know its joints."""

    linkage: Linkage
    scale: float
    """m, robust standard deviation of a marker in each direction."""
    information: Array
    """(n_bodies, 3, 3) 1/m² of each centre, everything else unknown as well."""


def fit_linkage(
    start: Linkage,
    points: Array,
    expected: Array,
    prior: Array,
    looks: float,
    *,
    rounds: int = 60,
) -> LinkageFit:
    """Fit shapes, joint centres and poses of linked bodies by maximum a posteriori.

    Every marker's distance from where its body puts it has a soft-L1 loss; its scale is the
    residuals' own, one for all markers, for with two markers on a body each would claim to be
    exact in turn. The first body's shape stays as it is. Poses are solved out frame by frame, as
    structure is in bundle adjustment [1]_.

    Parameters
    ----------
    start
        Where to begin.
    points : (n_frames, n_markers, 3) m
        Markers in the world, body by body; NaN where not seen.
    expected : (n_bodies, 3) m
        Expected centres in their parents, as those are at the start; the first row says nothing.
    prior : (n_bodies,) 1/m²
        How firmly each is expected there, in every direction.
    looks
        How many independent looks at the joints all the frames make.
    rounds
        Most steps.

    References
    ----------
    .. [1] Triggs et al. (2000), Bundle adjustment: a modern synthesis, LNCS 1883, 298-372, section
       6.1, doi:10.1007/3-540-44480-7_21.
    """
    linkage, seen = start, is_seen(points)
    n_shared = 3 * sum(len(s) for s in start.shapes[1:]) + 3 * (len(start.parents) - 1)
    stiff = np.repeat(np.append(np.zeros(n_shared // 3 - len(prior) + 1), prior[1:]), 3)
    for _ in range(rounds):
        off = misfit(linkage, points, seen)
        scale = scale_of(off, seen, len(linkage.parents))
        size = lengths(off) / scale
        weights = seen / np.sqrt(1 + (size / 2) ** 2) / scale**2 * (looks / len(points))
        normal = equations(linkage, off, weights)
        told = normal.told + np.diag(stiff) + still(linkage)
        strays = np.zeros(n_shared)
        strays[-3 * (len(prior) - 1) :] = (linkage.centres[1:] - expected[1:]).ravel()
        step = -inverse_of(told) @ (normal.score + stiff * strays)
        turning = idle(linkage)
        step -= turning @ (turning.T @ step)
        length = float(np.linalg.norm(step))
        step *= min(1.0, LONGEST / max(length, 1e-12))
        linkage = moved_by(linkage, step, -(normal.own + normal.follow @ step))
        if length < SETTLED:
            break
    known = normal.told + still(linkage)
    covariance = inverse_of(known + np.diag(stiff))
    first = n_shared - 3 * (len(prior) - 1)
    blocks = [np.zeros((3, 3))]
    for body in range(len(prior) - 1):
        at = slice(first + 3 * body, first + 3 * body + 3)
        told_here = np.linalg.pinv(covariance[at, at], hermitian=True) - np.diag(stiff[at])
        values, vectors = np.linalg.eigh(told_here)
        blocks.append((vectors * np.maximum(values, 0.0)) @ vectors.T)
    return LinkageFit(linkage, scale, np.array(blocks))


def pose_linkage(
    start: Linkage, points: Array, *, rounds: int = 20
) -> tuple[Linkage, NDArray[np.bool_]]:
    """Fit the poses of linked bodies to their markers; shapes, centres, the first body stay.

    Residuals have a soft-L1 loss. Every body is expected where it starts, ± `NEAR`: where markers
    hardly tell a turn it stays, and does not leap from one side of a fold to the other.

    Parameters
    ----------
    start
        With poses to begin with.
    points : (n_frames, n_markers, 3) m
        Markers of all bodies but the first; none is NaN.

    Returns
    -------
    linkage : Linkage
    settled : (n_frames,) of bool
    """
    held = start._replace(shapes=(np.empty((0, 3)), *start.shapes[1:]))
    seen, rotations = is_seen(points), start.rotations.copy()
    off = misfit(held, points, seen)
    turned = np.zeros((len(points), 3 * len(start.parents) - 3))
    settled = np.zeros(len(points), dtype=np.bool_)
    turning = np.arange(len(points))
    for _ in range(rounds):
        scale = scale_of(off, seen, len(start.parents))
        part = held._replace(rotations=rotations[turning], origin=start.origin[turning])
        root = (1 + (lengths(off[turning]) / scale / 2) ** 2) ** -0.25
        by_pose = by_pose_of(part, points.shape[1])[..., 3:-3]
        pose = (by_pose * root[..., None, None]).reshape(len(turning), -1, by_pose.shape[3])
        pull = np.swapaxes(pose, 1, 2) @ (off[turning] * root[..., None]).reshape(
            len(turning), -1, 1
        )
        firm = (scale / NEAR) ** 2
        square = square_of(pose) + firm * np.eye(by_pose.shape[3])
        step = -np.linalg.solve(square, pull + firm * turned[turning][..., None])[..., 0]
        step *= np.minimum(1.0, WIDEST / np.maximum(np.abs(step).max(axis=1), 1e-12))[:, None]
        turned[turning] += step
        part = moved_by(part, np.zeros(0), np.pad(step, ((0, 0), (3, 3))))
        rotations[turning] = part.rotations
        off[turning] = misfit(part, points[turning], seen[turning])
        farthest = np.abs(step).max(axis=1)
        settled[turning] = farthest < STILL
        turning = turning[farthest >= DONE]
        if not len(turning):
            break
    return start._replace(rotations=rotations), settled
