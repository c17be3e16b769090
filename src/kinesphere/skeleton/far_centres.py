"""Joint centres that lie where no joint can be."""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from kinesphere.data import Array
from kinesphere.geometry.in_words import in_millimetres
from kinesphere.skeleton.body import Body
from kinesphere.skeleton.landmarks import BETWEEN
from kinesphere.skeleton.measured import MeasuredJoint

LEAST_LENGTH = 0.2
"""m, what a limb is taken for whose markers are few: a forearm's are all at the wrist."""
STRAYED = 3.0
"""Spreads off the middle between two limbs beyond which a centre is at neither: the ends are 2."""


TOLD_MM = 5.0
"""mm, uncertainty by the motion alone, and noise, up to which it tells a centre well: then it is
there, however the markers lie. Centres right to 1 mm had up to 4 and 2.3, wrong ones 36 and 15, of
uncertainties that were two to three times too large."""


class FarCentres(NamedTuple):
    """Centres that are not where limbs meet as a rule."""

    limbs: frozenset[str]
    """Child limbs of their joints."""
    warnings: tuple[str, ...]


def far_centres(joints: Mapping[str, MeasuredJoint], bodies: Mapping[str, Body]) -> FarCentres:
    """Return centres which no joint of these limbs can have, and those that hardly one has.

    None can be further from the nearest marker of either limb than that limb is long. Hardly any
    without a landmark lies well outside of both limbs. Without a landmark neither says anything of
    a centre that the motion tells well, nor the first of one about midway between the limbs:
    markers may all be at a limb's far end.
    """
    away, astray = {}, {}
    for child, joint in joints.items():
        said = f"{joint.model.name} ({in_millimetres(joint.off)} from where it was expected)"
        parent, limb = bodies[joint.model.parent], bodies[child]
        seen = ((parent.shape, joint.fit.centre, parent.centre), (limb.shape, limb.centre, None))
        beyond = all(_beyond(*one) for one in seen)
        if joint.source == BETWEEN and _told_well(joint):
            continue
        if beyond and not (joint.source == BETWEEN and joint.off <= joint.spread):
            away[child] = said
        elif joint.source == BETWEEN and joint.off > STRAYED * joint.spread:
            astray[child] = said
    warnings = []
    if away:
        warnings.append(
            f"no joint can be where the motion puts {', '.join(away.values())}: far from the "
            "markers of both limbs; centre, axes and angles there are not to be believed"
        )
    if astray:
        warnings.append(
            f"the motion hardly tells the centre of {', '.join(astray.values())}, and it is "
            "outside of both limbs: it, axes and angles there may be wrong"
        )
    return FarCentres(frozenset({*away, *astray}), tuple(warnings))


def _told_well(joint: MeasuredJoint) -> bool:
    unsure = np.sqrt(np.linalg.eigvalsh(joint.fit.data_covariance)[-1])
    return bool(max(unsure, joint.fit.noise) <= TOLD_MM * 1e-3)


def _beyond(markers: Array, centre: Array | None, other: Array | None) -> bool:
    """Return whether a centre is further from a limb's markers than the limb is long."""
    points = markers if other is None else np.concatenate([markers, other[None]])
    points = points[np.isfinite(points).all(axis=1)]
    if centre is None or not len(points) or not np.isfinite(centre).all():
        return False
    length = np.linalg.norm(points[:, None] - points, axis=2).max()
    return bool(np.linalg.norm(points - centre, axis=1).min() > max(length, LEAST_LENGTH))
