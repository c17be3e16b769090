"""Motion without gaps: what a rig plays cannot pause."""

from dataclasses import replace

import numpy as np
from scipy.spatial.transform import Rotation, Slerp

from kinesphere.data import Array, Mask, Motion, PoseFlag
from kinesphere.errors import DegenerateMotion


def without_gaps(motion: Motion) -> tuple[Motion, tuple[str, ...]]:
    """Return the motion with every limb seen in every frame, and what was bridged.

    Against its parent a limb turns evenly from the last pose before a gap to the first one after;
    at the ends it keeps the nearest one, and a limb never seen hangs as at rest. The root's way is
    bridged straight. Joints of bridged limbs do not come apart.

    Raises
    ------
    DegenerateMotion
        If the root is never seen.
    """
    placed = np.isfinite(motion.origins).all(axis=2)
    seen: Mask = np.asarray(np.isfinite(motion.rotations).all(axis=(2, 3)) & placed)
    if seen.all():
        return motion, ()
    if not seen[:, 0].any():
        raise DegenerateMotion(f"{motion.skeleton.limb_names[0]}, the root, is never seen")
    rotations, origins = np.array(motion.rotations), np.array(motion.origins)
    flags = np.where(seen, motion.flags, PoseFlag.FILLED).astype(np.uint8)
    rotations[:, 0] = _bridged(rotations[:, 0], seen[:, 0])
    frames = np.arange(motion.n_frames)
    known = np.flatnonzero(seen[:, 0])
    for k in range(3):
        origins[:, 0, k] = np.interp(frames, known, origins[known, 0, k])
    for i, joint in enumerate(motion.skeleton.joints, start=1):
        gap = ~seen[:, i]
        if not gap.any():
            continue
        p = int(motion.skeleton.parents[i])
        relative = np.swapaxes(rotations[:, p], -1, -2) @ rotations[:, i]
        bridged = _bridged(relative, seen[:, i] & seen[:, p])
        rotations[gap, i] = rotations[gap, p] @ bridged[gap]
        centre = origins[gap, p] + rotations[gap, p] @ joint.centre_in_parent
        origins[gap, i] = centre - rotations[gap, i] @ joint.centre_in_child
    share = 1 - seen.mean(axis=0)
    worst = [
        motion.skeleton.limb_names[i] for i in np.argsort(-share, kind="stable")[:3] if share[i]
    ]
    said = f"gaps were bridged ({1 - seen.mean():.1%} of all poses; most at {', '.join(worst)})"
    return replace(motion, rotations=rotations, origins=origins, flags=flags), (said,)


def _bridged(rotations: Array, known: Mask) -> Array:
    """Return rotations over time with gaps bridged by even turns, (n_frames, 3, 3)."""
    if not known.any():
        return np.broadcast_to(np.eye(3), rotations.shape)
    at = np.flatnonzero(known)
    if len(at) == 1:
        return np.broadcast_to(rotations[at[0]], rotations.shape)
    frames = np.clip(np.arange(len(rotations)), at[0], at[-1])
    bridged = Slerp(at, Rotation.from_matrix(rotations[at]))(frames).as_matrix()
    bridged[known] = rotations[known]
    return np.asarray(bridged)
