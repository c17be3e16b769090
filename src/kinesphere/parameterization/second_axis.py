"""A second axis for a hinge that is none: so that the parameters still rebuild every pose."""

import numpy as np

from kinesphere.data import Array


def cone_spread(positions: Array, axis: Array) -> float:
    """Return how far a limb leaves the cone about an axis, rms in rad.

    Parameters
    ----------
    positions : (n, 3)
        Unit directions of the limb in the parent.
    axis : (3,)
        Unit vector in the parent.

    Returns
    -------
    float
        About the median cone; 0 where there are no positions.
    """
    if len(positions) == 0:
        return 0.0
    along = positions @ axis
    across = np.linalg.norm(np.cross(positions, axis), axis=1)
    heights = np.arctan2(across, along)
    return float(np.sqrt(((heights - np.median(heights)) ** 2).mean()))


def second_axis(hinge: Array, limb: Array, positive: Array) -> Array:
    """Return the axis across a hinge and its limb, about which the limb leaves the cone.

    Together with the hinge, which stays proximal, it reaches every direction of the limb.

    Parameters
    ----------
    hinge : (3,)
        Unit vector in the parent.
    limb : (3,)
        Unit direction of the limb at rest, in the parent.
    positive : (3,)
        The side to which the axis shall point.
    """
    across = np.cross(hinge, limb)
    across /= np.linalg.norm(across)
    return across if across @ positive >= 0 else -across
