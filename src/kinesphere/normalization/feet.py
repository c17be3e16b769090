"""Where feet point: by their own markers, by the floor they rest on, by the other foot."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from kinesphere.data import Array
from kinesphere.normalization.anatomy import Anatomy
from kinesphere.normalization.limb_lines import lacks_heel
from kinesphere.normalization.other_foot import lent_line
from kinesphere.normalization.samples import Samples
from kinesphere.normalization.soles import levelling, turned_by


@dataclass(frozen=True, eq=False)
class Foot:
    """What tells where a foot points in the default position."""

    points: Array
    """(3,) unit vector in the body frame."""
    length: float
    """m from the ankle to the toes, or to what markers there are; NaN where unknown."""
    on: tuple[str, ...]
    """Its markers."""
    bare: bool = False
    """Whether none of its markers, of which it has some, is at the heel."""
    pitch: float | None = None
    """rad, taken out of the line because the foot rests flat somewhere; None where nothing was."""
    lender: str = ""
    """The other foot, where that tells the line."""
    missing: tuple[str, ...] = ()
    """Markers of the lender that this foot has none like."""
    backward: bool = False
    """Whether its markers are at the heel alone, so that it points away from them."""


def feet_of(samples: Samples, poses: Mapping[int, Array]) -> dict[int, Foot]:
    """Return where feet point.

    By their own line; where the other foot has the same markers and more, as that one's, mirrored
    onto those that both have; level where they rest flat on the floor, if no marker is behind the
    ankle; away from the heel, where there are no other markers.

    Parameters
    ----------
    samples
    poses
        Index of each foot → mean ``body_from_limb`` of the default position, (3, 3).
    """
    anatomy = samples.anatomy
    own = {limb: _own(anatomy, limb, pose) for limb, pose in poses.items()}
    lent = {}
    for limb in poses:
        for other in poses:
            found = lent_line(anatomy, limb, poses[limb], other, poses[other])
            if found is not None and not own[other].backward:
                lent[limb] = other, found
    bare = [limb for limb, foot in own.items() if foot.bare and limb not in lent]
    heeled = [i for i, foot in own.items() if foot.on and not foot.bare and i not in lent]
    level = levelling(samples, [i for i in bare if not own[i].backward], heeled)
    feet = dict(own)
    for limb, pitch in level.items():
        feet[limb] = replace(own[limb], points=turned_by(own[limb].points, pitch), pitch=pitch)
    for limb, (other, (points, missing)) in lent.items():
        by = feet[other]
        feet[limb] = replace(
            own[limb],
            points=points if by.pitch is None else turned_by(points, by.pitch),
            length=by.length,
            bare=by.bare,
            pitch=by.pitch,
            lender=anatomy.skeleton.limb_names[other],
            missing=missing,
            backward=False,
        )
    return feet


def _own(anatomy: Anatomy, limb: int, pose: Array) -> Foot:
    """Return a foot by the line of its own markers; away from these, if they are behind it."""
    foot, begin = anatomy.skeleton.limbs[limb], anatomy.proximal_ends[limb]
    line, end = anatomy.directions[limb], anatomy.distal_ends[limb]
    seen = np.isfinite(foot.marker_positions).all(axis=1)
    on = tuple(np.array(foot.markers)[seen].tolist())
    points = pose @ line
    own = Foot(points, float(np.linalg.norm(end - begin)), on, lacks_heel(foot, begin, line))
    ahead = -points * [1.0, 0.0, 1.0]
    if not own.bare or ahead[0] <= 0:
        return own
    return replace(own, points=ahead / np.linalg.norm(ahead), backward=True)
