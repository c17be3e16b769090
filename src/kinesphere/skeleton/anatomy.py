"""Where anatomy expects a joint in a plane of bone, however its person stands.

A regression knows the hip from the spines of the pelvis alone: along them, in their plane and
across it. Taken along the vertical instead, a pelvis that tilts takes its hips along: between the
halves of a trial, in one of which the person leaned, they were expected 20 mm apart.
"""

from collections.abc import Mapping

import numpy as np

from kinesphere.data import Array, Landmark
from kinesphere.geometry.rigid import into_frame
from kinesphere.skeleton.averages import median_seen
from kinesphere.skeleton.body import Body
from kinesphere.skeleton.body_axes import beside, unit

LINE = 0.01
"""m, least distance of what is behind from the line through the pair: nearer, no plane is told."""


def in_plane(
    landmark: Landmark, parent: Body, sample: Mapping[str, Array], sign: float
) -> Array | None:
    """Return the point that a landmark tells in the plane of its markers, in the parent's frame.

    Parameters
    ----------
    landmark
        With a ``plane`` of labels that are in the sample, and a ``scale``.
    sample
        Label → (n_sample, 3) m, in the world.
    sign
        +1 where inward is to the right, −1 where to the left, 0 where no name tells it: then
        inward is towards the pair's middle.

    Returns
    -------
    (3,) m
        Or None where a marker never shows or they tell no plane.
    """
    at = {
        label: _usual(label, parent, sample)
        for label in {*landmark.weights, *landmark.plane, *(landmark.scale or ())}
    }
    axes = plane_axes(landmark.plane, at)
    point: Array = np.sum([w * at[label] for label, w in landmark.weights.items()], axis=0)
    if axes is None or not np.isfinite(point).all():
        return None
    right, forward, up = axes
    size = 0.0
    if landmark.scale is not None:
        a, b = landmark.scale
        size = float(np.linalg.norm(at[a] - at[b]))
    if not sign:
        middle = (at[landmark.plane[0]] + at[landmark.plane[1]]) / 2
        sign = -1.0 if (point - middle) @ right > 0 else 1.0
    shares = size * np.array([landmark.inward, landmark.down, landmark.forward])
    moved = shares + np.array(landmark.offset)
    found: Array = point + moved @ np.stack([sign * right, -up, forward])
    return found if np.isfinite(found).all() else None


def plane_axes(
    labels: tuple[str, ...], at: Mapping[str, Array]
) -> tuple[Array, Array, Array] | None:
    """Return right, forward and up of a plane of markers, (3,) each; None where they tell none.

    As Harrington et al. 2007 have the pelvis, doi:10.1016/j.jbiomech.2006.02.003: right along the
    pair, forward from the middle of those behind to the pair's.

    Parameters
    ----------
    labels
        Left and right one of the pair, then those behind.
    at
        Label → (3,) m.
    """
    left, right, *behind = labels
    across = unit(at[right] - at[left])
    ahead = (at[left] + at[right]) / 2 - np.mean([at[label] for label in behind], axis=0)
    # of one marker, or of markers on the pair's line, no direction is left
    if not np.linalg.norm(ahead - (ahead @ across) * across) > LINE:
        return None
    forward = beside(ahead, across)
    return across, forward, np.cross(across, forward)


def _usual(label: str, parent: Body, sample: Mapping[str, Array]) -> Array:
    """Return where a marker usually is in a limb, (3,) m."""
    local = into_frame(parent.rotations, parent.shifts, sample[label][:, None])[:, 0]
    return median_seen(local)
