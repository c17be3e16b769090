"""Which points of a body keypoints are."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Array
from kinesphere.data.keypoints import KEYPOINTS
from kinesphere.markerless.body import Body
from kinesphere.markerless.pose import Pose, posed

_JOINTS = {
    "shoulder": "upper_arm",
    "elbow": "forearm",
    "wrist": "hand",
    "hip": "thigh",
    "knee": "shank",
    "ankle": "foot",
}
_SPREAD, _VAGUE = 0.015, 0.04
"""m by which joints, and points of head and feet, are usually off."""


@dataclass(frozen=True, eq=False)
class Marks:
    """Keypoints as points of a body."""

    limbs: NDArray[np.intp]
    """(n_keypoints,) the chain's limb each rides on."""
    places: Array
    """(n_keypoints, 3) m in the bind pose."""
    spread: Array
    """(n_keypoints,) m."""

    def at(self, body: Body, pose: Pose) -> Array:
        """Return where a pose puts them, (n_keypoints, 3) m."""
        now = posed(body.chain, pose)
        out = self.places - body.chain.centres[self.limbs]
        turned = np.einsum("kij,kj->ki", now.rotations[self.limbs], out)
        return np.asarray(turned + now.centres[self.limbs])


def marks_of(body: Body) -> Marks:
    """Return where on a full body keypoints are: joint centres, nose, ears, toes and heels."""
    names = body.chain.limb_names
    limbs, places, spread = [], [], []
    for keypoint in KEYPOINTS:
        side, _, what = ("", "", keypoint) if keypoint == "nose" else keypoint.partition("_")
        if what in _JOINTS:
            limb = names.index(f"{side}_{_JOINTS[what]}")
            place = body.chain.centres[limb]
        else:
            limb = names.index(f"{side}_foot" if what in ("big_toe", "heel") else "head")
            skin = body.bind[body.limb_of_vertex == limb]
            ahead = skin[:, 0] if what in ("nose", "big_toe") else -skin[:, 0]
            if what == "ear":
                ahead = skin[:, 2] if side == "right" else -skin[:, 2]
            place = skin[ahead.argmax()]
        limbs.append(limb)
        places.append(place)
        spread.append(_SPREAD if what in _JOINTS else _VAGUE)
    return Marks(np.array(limbs), np.array(places), np.array(spread))
