"""How far halves of a trial have a joint's centre apart, in its better-marked limb."""

import numpy as np

from kinesphere.data import Array, Joint, Motion, Skeleton

Parts = tuple[slice, slice]


def apart(first: Skeleton, second: Skeleton) -> dict[str, float]:
    """Return joint → how far apart its centres are, mm; NaN if halves share too few markers.

    Each half has shapes of its own, laid on each other by the better-marked limb's markers: a body
    of two markers has no frame of its own.
    """
    found = {}
    for joint in first.joints:
        better = better_marked(first, joint)
        limbs = [half.limb(better) for half in (first, second)]
        both = [m for m in limbs[0].markers if m in limbs[1].markers]
        shapes = [limb.marker_positions[[limb.markers.index(m) for m in both]] for limb in limbs]
        known = np.isfinite(shapes).all(axis=(0, 2))
        one, other = (_centre(half.joint(joint.name), better) for half in (first, second))
        off = laid_on((shapes[0][known], one), (shapes[1][known], other))
        found[joint.name] = 1e3 * float(np.linalg.norm(off)) if known.sum() > 2 else np.nan
    return found


def apart_in_whole(halves: tuple[Motion, Motion], whole: Motion, parts: Parts) -> dict[str, float]:
    """Return the same, where the limb is as the whole trial's solution poses it in each half.

    A half tells where its joint is in the world; medians of its frames.
    """
    names, found = whole.skeleton.limb_names, {}
    for joint in whole.skeleton.joints:
        at = names.index(better_marked(whole.skeleton, joint))
        centres = []
        for half, part in zip(halves, parts, strict=True):
            parent = names.index(joint.parent)
            centre = half.skeleton.joint(joint.name).centre_in_parent
            world = half.origins[:, parent] + half.rotations[:, parent] @ centre
            off = world - whole.origins[part, at]
            local = np.einsum("nji,nj->ni", whole.rotations[part, at], off)
            centres.append(np.nanmedian(local, axis=0))
        found[joint.name] = 1e3 * float(np.linalg.norm(centres[1] - centres[0]))
    return found


def told(first: Skeleton, second: Skeleton) -> dict[str, float]:
    """Return joint → what the uncertainties of both lead to expect between them, rms, mm."""
    return {
        one.name: 1e3 * float(np.sqrt(np.trace(one.covariance + other.covariance)))
        for one, other in zip(first.joints, second.joints, strict=True)
    }


def better_marked(skeleton: Skeleton, joint: Joint) -> str:
    """Return which of the limbs that meet at a joint has more markers, the parent if both have."""
    return max((joint.parent, joint.child), key=lambda name: len(skeleton.limb(name).markers))


def laid_on(first: tuple[Array, Array], second: tuple[Array, Array]) -> Array:
    """Return the second centre minus the first, shapes laid on each other by their markers."""
    (a, centre_a), (b, centre_b) = first, second
    middle_a, middle_b = a.mean(axis=0), b.mean(axis=0)
    u, _, vt = np.linalg.svd((b - middle_b).T @ (a - middle_a))
    turn = u @ np.diag([1, 1, np.sign(np.linalg.det(u @ vt))]) @ vt
    off: Array = (centre_b - middle_b) @ turn - (centre_a - middle_a)
    return off


def _centre(joint: Joint, limb: str) -> Array:
    return joint.centre_in_parent if limb == joint.parent else joint.centre_in_child
