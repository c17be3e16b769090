"""How feet stand: which way is up in the frame of a foot on the ground, and how high its ankle."""

from collections.abc import Iterator

import numpy as np

from kinesphere.data import Array, Mask, Motion, pivots

_STILL = 0.15  # m/s, a foot that moves less stands
_LOW = 0.03  # m above where the foot is at its lowest, as a standing foot is
_ANKLE = (0.035, 0.15)  # m, between bare feet and boots
_STEEP = np.cos(np.radians(50.0))  # a foot that leans more does not stand


def ups_while_standing(motion: Motion) -> Array:
    """Return the world's up in each limb's frame while it stands still and low, (n_limbs, 3).

    The long axis of a foot goes from its joint to its markers and so down to the toes, by an angle
    that depends on where the markers sit; the ground does not. Where no foot ever stands, and for
    limbs that are no feet, up is the frame's own y.
    """
    ups = np.tile(np.array([0.0, 1.0, 0.0]), (len(motion.skeleton.limbs), 1))
    for limb, still in _standing(motion):
        mean = np.median(motion.rotations[still, limb, 1, :], axis=0)  # world's y in the frame
        ups[limb] = mean / np.linalg.norm(mean)
    return ups


def ankle_heights(motion: Motion) -> Array:
    """Return how high each ankle is above y = 0 while its foot stands, (n_limbs,) m; else NaN.

    NaN as well where that is no height of an ankle: then the floor is not at y = 0.
    """
    heights = np.full(len(motion.skeleton.limbs), np.nan)
    ankles = pivots(motion.skeleton)
    for limb, still in _standing(motion):
        turned = motion.rotations[still, limb] @ ankles[limb]
        height = float(np.median((motion.origins[still, limb] + turned)[:, 1]))
        if _ANKLE[0] < height < _ANKLE[1]:
            heights[limb] = height
    return heights


def _standing(motion: Motion) -> Iterator[tuple[int, Mask]]:
    """Yield each foot that stands, and when."""
    for limb, name in enumerate(motion.skeleton.limb_names):
        if not name.endswith("_foot") or motion.n_frames < 3:
            continue
        place = motion.origins[:, limb]
        speed = np.linalg.norm(np.gradient(place, axis=0), axis=1) * motion.rate
        still = (speed < _STILL) & (motion.rotations[:, limb, 1, 1] > _STEEP)
        if still.any():
            yield limb, still & (place[:, 1] < np.nanmin(place[still, 1]) + _LOW)
