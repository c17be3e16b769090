"""Where something must be shown or written although it was not seen: what stands in for a gap."""

import numpy as np

from kinesphere.data.arrays import Array
from kinesphere.data.motion import Motion
from kinesphere.data.rest import default_origins


def held(values: Array, instead: Array) -> Array:
    """Return ``values`` with every gap filled by the last known value.

    Before the first known value, that one; where nothing is known, ``instead``.

    Parameters
    ----------
    values : (n_frames, ...)
        A frame with any NaN is a gap.
    instead : (...)
    """
    known = np.isfinite(values).reshape(len(values), -1).all(axis=1)
    if known.all():
        return values
    if not known.any():
        return np.broadcast_to(instead, values.shape)
    last = np.maximum.accumulate(np.where(known, np.arange(len(values)), 0))
    last[: int(known.argmax())] = known.argmax()
    return np.asarray(values[last])


def poses_without_gaps(motion: Motion) -> tuple[Array, Array]:
    """Return rotations and origins of every limb in every frame, for those who must show some.

    An unseen limb keeps its last known place in its parent (before the first, that one; never
    seen, the one of the default position). What was measured stays as it is, to the bit.

    Returns
    -------
    rotations, origins : (n_frames, n_limbs, 3, 3), (n_frames, n_limbs, 3) m
    """
    if motion.seen.all():
        return motion.rotations, motion.origins
    rotations, origins = np.array(motion.rotations), np.array(motion.origins)
    rest = default_origins(motion.skeleton)
    for limb, parent in enumerate(motion.skeleton.parents):
        unseen = ~motion.seen[:, limb]
        if not unseen.any():
            continue
        if parent < 0:
            rotations[:, limb] = held(rotations[:, limb], np.eye(3))
            origins[:, limb] = held(origins[:, limb], np.zeros(3))
            continue
        carrier, place = rotations[:, parent], origins[:, parent]
        back = np.swapaxes(carrier, -1, -2)
        turn = held(back @ motion.rotations[:, limb], np.eye(3))
        way = (back @ (motion.origins[:, limb] - place)[..., None])[..., 0]
        way = held(way, rest[limb] - rest[parent])
        rotations[unseen, limb] = (carrier @ turn)[unseen]
        origins[unseen, limb] = ((carrier @ way[..., None])[..., 0] + place)[unseen]
    return rotations, origins
