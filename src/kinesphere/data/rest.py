"""The default position of a normalized skeleton: every limb frame as the body's own."""

import numpy as np

from kinesphere.data.arrays import Array
from kinesphere.data.skeleton import Skeleton

_THIGHS = ("left_thigh", "right_thigh")


def default_origins(skeleton: Skeleton) -> Array:
    """Return where the limb frames begin in the default position, (n_limbs, 3) m.

    There all limb frames are turned alike (Sar Dessai et al. 2006, section 3.3): the person stands,
    arms hanging, x to the front, y up, z to the right. The root frame lies in the origin.
    """
    origins = np.zeros((len(skeleton.limbs), 3))
    for limb, joint in enumerate(skeleton.joints, start=1):
        parent = skeleton.parents[limb]
        origins[limb] = origins[parent] + joint.centre_in_parent - joint.centre_in_child
    return origins


def pivots(skeleton: Skeleton) -> Array:
    """Return the point each limb turns about, (n_limbs, 3) m in its own frame.

    The joint towards its parent; of the root, the middle between the hips it carries, or else its
    frame's origin.
    """
    root = skeleton.limbs[0].name
    # told by the limbs, for a layout may call its joints what it likes
    hips = [j for j in skeleton.joints if j.child in _THIGHS and j.parent == root]
    middle = np.mean([j.centre_in_parent for j in hips], axis=0) if len(hips) == 2 else np.zeros(3)
    return np.array([middle, *(joint.centre_in_child for joint in skeleton.joints)])
