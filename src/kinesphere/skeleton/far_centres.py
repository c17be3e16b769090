"""Joint centres that lie where no joint can be."""

from collections.abc import Mapping

import numpy as np

from kinesphere.data import Array
from kinesphere.skeleton.body import Body
from kinesphere.skeleton.landmarks import BETWEEN
from kinesphere.skeleton.measured import MeasuredJoint

LEAST_LENGTH = 0.2
"""m, what a limb is taken for whose markers are few: a forearm's are all at the wrist."""
STRAYED = 3.0
"""Spreads off the middle between two limbs beyond which a centre is at neither: the ends are 2."""


def far_centres(joints: Mapping[str, MeasuredJoint], bodies: Mapping[str, Body]) -> tuple[str, ...]:
    """Return the warning that names centres which no joint of these limbs can have.

    Those further from the nearest marker of either limb than that limb is long, and those without
    a landmark that lie well outside of both limbs.
    """
    far = []
    for child, joint in joints.items():
        off = float(np.linalg.norm(joint.fit.centre - joint.expected))
        strayed = joint.source == BETWEEN and off > STRAYED * joint.spread
        parent, limb = bodies[joint.model.parent], bodies[child]
        seen = ((parent.shape, joint.fit.centre, parent.centre), (limb.shape, limb.centre, None))
        if strayed or all(_beyond(*limb) for limb in seen):
            far.append(f"{joint.model.name} ({off * 1e3:.0f} mm from where it was expected)")
    if not far:
        return ()
    return (
        f"no joint can be where the motion puts {', '.join(far)}: far from the markers of both "
        "limbs; centre, axes and angles there are not to be believed",
    )


def _beyond(markers: Array, centre: Array | None, other: Array | None) -> bool:
    """Return whether a centre is further from a limb's markers than the limb is long."""
    points = markers if other is None else np.concatenate([markers, other[None]])
    points = points[np.isfinite(points).all(axis=1)]
    if centre is None or not len(points) or not np.isfinite(centre).all():
        return False
    length = np.linalg.norm(points[:, None] - points, axis=2).max()
    return bool(np.linalg.norm(points - centre, axis=1).min() > max(length, LEAST_LENGTH))
