"""The 41 markers of the CMU recordings, where they sit on an actor.

Places follow the marker placement guide of the CMU Graphics Lab (mocap.cs.cmu.edu), a Vicon set: a
marker belongs to the limb whose bone it lies on, so the knee marker moves with the thigh (lateral
epicondyle), the ankle marker with the shank, the shoulder marker with the trunk (acromion). The
actor has no hands: wrist and finger markers move with the forearm.

Where a limb points, at the end of a chain, only its markers can tell: the finger marker and the
middle of the wrist markers lie on the forearm's long axis, the middle of the head markers on the
head's; the foot's is parallel to the line closest to the ankle and the foot markers.
"""

from itertools import chain

import numpy as np

from kinesphere.data import Array, Limb
from kinesphere.errors import BadSetting
from kinesphere.synthetic.actor import Actor
from kinesphere.synthetic.plan import Vector, other_side

_JITTER = 0.004  # share of stature, standard deviation of where the marker is really stuck

_MIDDLE: dict[str, tuple[str, float, Vector]] = {
    "C7": ("trunk", 0.98, (-0.045, 0.005, 0.0)),
    "T10": ("trunk", 0.55, (-0.060, 0.0, 0.0)),
    "CLAV": ("trunk", 0.90, (0.045, 0.0, 0.0)),
    "STRN": ("trunk", 0.62, (0.070, 0.0, 0.0)),
    "RBAC": ("trunk", 0.75, (-0.055, 0.0, 0.050)),
}
"""Label → limb, share of its length from the proximal end, then shares of stature in its frame."""

_LEFT: dict[str, tuple[str, float, Vector]] = {
    "FHD": ("head", 0.65, (0.045, 0.0, -0.040)),
    "BHD": ("head", 0.65, (-0.045, 0.005, -0.040)),
    "SHO": ("trunk", 0.93, (0.0, 0.030, -0.115)),
    "FWT": ("trunk", 0.0, (0.055, 0.040, -0.070)),
    "BWT": ("trunk", 0.0, (-0.080, 0.045, -0.030)),
    "UPA": ("left_upper_arm", 0.45, (0.005, 0.0, -0.032)),
    "ELB": ("left_upper_arm", 1.0, (-0.003, 0.0, -0.025)),
    "FRM": ("left_forearm", 0.40, (-0.005, 0.0, -0.026)),
    "WRA": ("left_forearm", 0.98, (0.020, 0.0, 0.002)),
    "WRB": ("left_forearm", 0.98, (-0.020, 0.0, -0.002)),
    "FIN": ("left_forearm", 1.40, (0.0, 0.0, 0.0)),
    "THI": ("left_thigh", 0.50, (0.020, 0.0, -0.045)),
    "KNE": ("left_thigh", 1.0, (0.0, 0.0, -0.031)),
    "SHN": ("left_shank", 0.50, (0.015, 0.0, -0.030)),
    "ANK": ("left_shank", 1.0, (0.0, 0.0, -0.022)),
    "HEE": ("left_foot", 0.0, (-0.025, -0.015, 0.0)),
    "TOE": ("left_foot", 0.90, (0.0, -0.008, 0.016)),
    "MT5": ("left_foot", 0.65, (0.0, -0.012, -0.028)),
}

_CENTRED = (
    *(((side + "FIN",), (side + "WRA", side + "WRB")) for side in "LR"),
    (("LFHD", "RFHD", "LBHD", "RBHD"),),
)
"""Markers whose middle lies on the long axis, wherever they are really stuck."""


def cmu41_markers(rng: np.random.Generator, actor: Actor) -> dict[str, tuple[list[str], Array]]:
    """Stick the 41 markers on, each a few millimetres off its place.

    Returns
    -------
    dict
        Limb → labels and (n_markers, 3) m in the limb frame.

    Raises
    ------
    BadSetting
        If the body has no such limbs.
    """
    places = dict(_MIDDLE)
    for label, (carrier, share, (x, y, z)) in _LEFT.items():
        places["L" + label] = carrier, share, (x, y, z)
        places["R" + label] = other_side(carrier), share, (x, y, -z)
    limbs = {limb.name: limb for limb in actor.skeleton.limbs}
    if missing := sorted({carrier for carrier, _, _ in places.values()} - set(limbs)):
        raise BadSetting(
            f"the layout cmu41 is for people; a {actor.plan.name} has no {', '.join(missing)}"
        )
    bodies: dict[str, tuple[list[str], Array]] = {}
    for name, limb in limbs.items():
        labels = [label for label, (carrier, _, _) in places.items() if carrier == name]
        along = np.array([places[label][1] for label in labels]) - 0.5
        aside = np.array([places[label][2] for label in labels])
        aside = aside + _JITTER * np.clip(rng.normal(size=aside.shape), -2, 2)
        across = np.eye(3) - np.outer(limb.long_axis, limb.long_axis)
        for group in chain.from_iterable(_CENTRED):
            rows = [m for m, label in enumerate(labels) if label in group]
            if rows:
                aside[rows] -= aside[rows].mean(axis=0) @ across
        points = limb.length * along[:, None] * limb.long_axis + actor.size * aside
        if name.endswith("_foot"):
            points[labels.index(name[0].upper() + "TOE")] = _toe(limb, labels, points)
        bodies[name] = labels, points
    return bodies


def _toe(limb: Limb, labels: list[str], points: Array) -> Array:
    """Return where the toe marker has to be, (3,) m, for the foot's long axis to lie lengthwise.

    Of the ankle joint and all markers the products of inertia with the long axis are zero.
    """
    toe = next(m for m, label in enumerate(labels) if label.endswith("TOE"))
    all_points = np.vstack([points, -limb.length / 2 * limb.long_axis])
    reach = all_points @ limb.long_axis
    lever = reach - reach.mean()
    others = np.arange(len(lever)) != toe
    across = np.eye(3) - np.outer(limb.long_axis, limb.long_axis)
    aside = -(lever[others] @ all_points[others] @ across) / lever[toe]
    return np.asarray(reach[toe] * limb.long_axis + aside)


def cmu41_twin(label: str) -> str:
    """Return the label of the other side, ``RKNE`` for ``LKNE``; a middle one stays itself."""
    side, place = label[0], label[1:]
    return {"L": "R", "R": "L"}.get(side, side) + place if place in _LEFT else label
