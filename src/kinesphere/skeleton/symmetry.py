"""Hips of one person lie alike on both sides of the pelvis, more or less."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from kinesphere.data import Array, TopologicalModel
from kinesphere.geometry.centres import CentreFit
from kinesphere.skeleton.body import Body
from kinesphere.skeleton.measured import MeasuredJoint

PAIRS = (("left_hip", "right_hip"),)
"""Joints that bone holds; a shoulder goes where its clavicle does."""
FEWEST = 2
"""Pairs of markers that tell a mirror plane: one pair's middle may be anywhere."""


def evened(
    joints: Mapping[str, MeasuredJoint],
    pelvis: Body,
    model: TopologicalModel,
    spread: float,
) -> dict[str, CentreFit]:
    """Return both hips as each other's mirror images have their say.

    A hip that moves little is told by the other one, and what skin does to both alike is halved.
    Each counts by its covariance; how unlike they may be is ``spread``.

    Parameters
    ----------
    joints
        Child limb → its joint in the pelvis, or whatever limb it is that has both hips.
    spread
        m in each direction, of one hip from the other's mirror image: how unlike the sides of a
        pelvis are, and how unlike the markers that tell the mirror plane were put on.

    Returns
    -------
    child limb → centre; empty where there are no two hips or no plane.
    """
    at = {joint.model.name: child for child, joint in joints.items()}
    moved: dict[str, CentreFit] = {}
    for left, right in PAIRS:
        if left not in at or right not in at:
            continue
        one, other = joints[at[left]], joints[at[right]]
        plane = mirror_plane(pelvis, model)
        if plane is None:
            continue
        for here, there in ((one, other), (other, one)):
            moved[at[here.model.name]] = _drawn(here.fit, there.fit, *plane, spread)
    return moved


def mirror_plane(body: Body, model: TopologicalModel) -> tuple[Array, Array] | None:
    """Return the unit normal and a point of the plane that pairs of a limb's markers mirror in.

    Returns
    -------
    normal, point : (3,), (3,) m
        Or None where there are too few pairs.
    """
    places = {
        label: place
        for label, place in zip(body.labels, body.shape, strict=True)
        if np.isfinite(place).all()
    }
    pairs = [
        (places[left], places[right])
        for left, right in model.mirror
        if left in places and right in places
    ]
    if len(pairs) < FEWEST:
        return None
    across = np.sum([right - left for left, right in pairs], axis=0)
    length = float(np.linalg.norm(across))
    if length < 1e-6:
        return None
    return across / length, np.mean([(left + right) / 2 for left, right in pairs], axis=0)


def _drawn(
    here: CentreFit, there: CentreFit, normal: Array, point: Array, spread: float
) -> CentreFit:
    """Return a centre drawn towards the mirror image of another, by normal regression."""
    mirror = np.eye(3) - 2 * np.outer(normal, normal)
    image = point + mirror @ (there.centre - point)
    unlike = here.covariance + mirror @ there.covariance @ mirror + spread**2 * np.eye(3)
    gain = here.covariance @ np.linalg.inv(unlike)
    covariance = here.covariance - gain @ here.covariance
    return replace(
        here,
        centre=here.centre + gain @ (image - here.centre),
        covariance=(covariance + covariance.T) / 2,
    )
