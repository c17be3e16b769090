"""How feet stand: which way is up in the frame of a foot while it is on the ground."""

import numpy as np

from kinesphere.data import Array, Motion

_STILL = 0.15  # m/s, a foot that moves less stands
_LOW = 0.03  # m above where the foot is at its lowest, as a standing foot is
_STEEP = np.cos(np.radians(50.0))  # a foot that leans more does not stand


def ups_while_standing(motion: Motion) -> Array:
    """Return the world's up in each limb's frame while it stands still and low, (n_limbs, 3).

    The long axis of a foot goes from its joint to its markers and so down to the toes, by an angle
    that depends on where the markers sit; the ground does not. Where no foot ever stands, and for
    limbs that are no feet, up is the frame's own y.
    """
    ups = np.tile(np.array([0.0, 1.0, 0.0]), (len(motion.skeleton.limbs), 1))
    for limb, name in enumerate(motion.skeleton.limb_names):
        if not name.endswith("_foot") or motion.n_frames < 3:
            continue
        place = motion.origins[:, limb]
        speed = np.linalg.norm(np.gradient(place, axis=0), axis=1) * motion.rate
        up = motion.rotations[:, limb, 1, :]  # world's y in the limb's frame
        still = (speed < _STILL) & (up[:, 1] > _STEEP)
        if not still.any():
            continue
        still &= place[:, 1] < np.nanmin(place[still, 1]) + _LOW
        mean = np.median(up[still], axis=0)
        ups[limb] = mean / np.linalg.norm(mean)
    return ups
