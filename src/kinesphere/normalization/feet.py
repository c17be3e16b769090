"""Where feet point: by their own markers, by the floor they rest on, by the other foot."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from kinesphere.data import Array
from kinesphere.data.label_sides import lies_at_the_edge
from kinesphere.normalization.anatomy import Anatomy
from kinesphere.normalization.limb_lines import lacks_heel
from kinesphere.normalization.other_foot import lent_line
from kinesphere.normalization.samples import Samples
from kinesphere.normalization.soles import find_rest, levelling, turned_by

_LENT, _RESTS_ALIKE = np.deg2rad(2.4), np.deg2rad(1.6)
"""rad rms by which the pitch of 87 real feet that lacked a marker was off, lent by the other foot,
and by which two feet of one person lie unlike where they rest flat (one has 6°, left out)."""
_UNLIKE = 3.0  # standard deviations between the two from which on they are no errors


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
    aside: bool = False
    """Whether its foremost markers are at its outer edge, by their labels, and none at the toes."""


def feet_of(samples: Samples, poses: Mapping[int, Array]) -> dict[int, Foot]:
    """Return where feet point.

    By their own line; where the other foot has the same markers and more, as that one's, mirrored
    onto those that both have and, of its two ends, pitched as that one's where both rest flat;
    level where they rest flat on the floor, if no marker is behind the ankle; away from the heel,
    where there are no other markers.

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
    for limb, (other, line) in lent.items():
        by, points = feet[other], line.points
        if line.open_end:
            in_foot, told = poses[limb].T @ points, len(own[limb].on) > 1
            too_high = _too_high(samples, limb, in_foot, other, foot_is_told=told)
            points = turned_by(points, too_high)
        feet[limb] = replace(
            own[limb],
            points=points if by.pitch is None else turned_by(points, by.pitch),
            length=by.length,
            bare=by.bare,
            pitch=by.pitch,
            lender=anatomy.skeleton.limb_names[other],
            missing=line.missing,
            backward=False,
            aside=by.aside,
        )
    return feet


def _too_high(
    samples: Samples, limb: int, line: Array, lender: int, *, foot_is_told: bool
) -> float:
    """Return by how much the line that another foot lends is to be lowered, rad of pitch.

    Two feet of one person lie alike where they rest flat, nearly. That tells a pitch as the mirror
    image does, and between the two stands their mean, each weighed by its variance.

    Parameters
    ----------
    samples
    limb
        The foot's index.
    line : (3,)
        What is lent, a unit vector in the foot's own frame.
    lender
        The other foot's index.
    foot_is_told
        Whether several markers tell how the foot stands beside the other one.

    Returns
    -------
    float
        0 where one of them never rests, or rests now like this and now like that; and where
        markers say that the two do rest unlike each other, as feet with a contracture do.
    """
    rests = find_rest(samples, limb, line), find_rest(samples, lender)
    if not all(rest.tells for rest in rests):
        return 0.0
    apart = rests[0].pitch - rests[1].pitch
    variance = _LENT**2 + _RESTS_ALIKE**2 + sum(rest.scatter**2 for rest in rests)
    if foot_is_told and apart**2 > _UNLIKE**2 * variance:
        return 0.0
    return float(apart * _LENT**2 / variance)


def _own(anatomy: Anatomy, limb: int, pose: Array) -> Foot:
    """Return a foot by the line of its own markers; away from these, if they are behind it."""
    foot, begin = anatomy.skeleton.limbs[limb], anatomy.proximal_ends[limb]
    line, end = anatomy.directions[limb], anatomy.distal_ends[limb]
    seen = np.isfinite(foot.marker_positions).all(axis=1)
    on = tuple(np.array(foot.markers)[seen].tolist())
    points = pose @ line
    bare, length = lacks_heel(foot, begin, line), float(np.linalg.norm(end - begin))
    ahead_of_ankle = seen & ((foot.marker_positions - begin) @ line > 0)
    aside = not bare and lies_at_the_edge(np.array(foot.markers)[ahead_of_ankle].tolist())
    own = Foot(points, length, on, bare, aside=aside)
    ahead = -points * [1.0, 0.0, 1.0]
    if not own.bare or ahead[0] <= 0:
        return own
    return replace(own, points=ahead / np.linalg.norm(ahead), backward=True)
