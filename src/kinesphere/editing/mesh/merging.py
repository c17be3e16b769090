"""The body's limbs as a skeleton has them: what it lacks rides on what carries it."""

from dataclasses import replace

import numpy as np

from kinesphere.data import Skeleton, Surface
from kinesphere.errors import BadSurface

_ROOTS = ("pelvis", "trunk")
_PAIRS = ("thigh", "upper_arm")


def on_limbs_of(body: Surface, skeleton: Skeleton) -> Surface:
    """Return the body with the limbs of a skeleton, in its order.

    A limb that the skeleton lacks gives its share to the nearest limb towards the root that is
    there; a missing pelvis to the trunk, which then begins between the hips. Limbs that the body
    lacks carry nothing.

    Raises
    ------
    BadSurface
        If the skeleton has no trunk or pelvis as its root, or neither a pair of thighs nor one of
        upper arms: nobody knows which limb is which.
    """
    names = skeleton.limb_names
    if names[0] not in _ROOTS:
        raise BadSurface(
            f"the root is called {names[0]}; a body needs pelvis or trunk as its root, that is "
            "limbs that are known by name"
        )
    if not any({f"left_{limb}", f"right_{limb}"} <= set(names) for limb in _PAIRS):
        raise BadSurface(
            "a body needs both thighs or both upper arms by name; the limbs are called "
            f"{', '.join(names)}"
        )
    to = np.zeros((len(body.limbs), len(names)))
    for old in range(len(body.limbs)):
        at = old
        while at >= 0 and body.limbs[at] not in names:
            at = int(body.parents[at])
        to[old, names.index(body.limbs[at]) if at >= 0 else 0] = 1.0
    centres = np.tile(body.joint_centres[0], (len(names), 1))
    ends, moves = centres.copy(), np.zeros((2, len(body.shapes), len(names), 3))
    for new, name in enumerate(names):
        if name in body.limbs:
            old = body.limbs.index(name)
            # the root begins between the hips, whatever it is called
            begin = 0 if new == 0 else old
            centres[new], ends[new] = body.joint_centres[begin], body.ends[old]
            moves[0, :, new] = body.shape_joint_centres[:, begin]
            moves[1, :, new] = body.shape_ends[:, old]
    return replace(
        body,
        limbs=names,
        parents=skeleton.parents,
        joint_centres=centres,
        ends=ends,
        weights=body.weights @ to,
        shape_joint_centres=moves[0],
        shape_ends=moves[1],
    )
