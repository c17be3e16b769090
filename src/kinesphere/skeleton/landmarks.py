"""Where a joint centre is expected before the motion has its say."""

from typing import NamedTuple

import numpy as np

from kinesphere.data import Array, JointModel, Landmark
from kinesphere.geometry.rigid import into_frame
from kinesphere.skeleton.anatomy import in_plane
from kinesphere.skeleton.averages import mean_seen, median_seen
from kinesphere.skeleton.body import Body
from kinesphere.skeleton.body_axes import beside

BETWEEN = "between the markers of both limbs"
"""Source of a centre that no landmark is known of."""
STEADY = "markers that are steady in both limbs"
"""Source of a landmark that the motion itself gave."""
NO_LANDMARK_SHARE = 0.5
"""Without a landmark the centre is expected midway between the limbs, to this share of the way: as
far as the markers themselves, for a foot's lie all but at the ankle."""
NO_LANDMARK_FIRM = 0.25
"""The same where there is little else that tells: of a joint with one axis (knees and elbows lie
about midway), and where a limb has too few markers for a pose of its own."""
MIDWAY_OFF = 3**-0.5
"""Spreads in each direction by which it is off, for the share is of how far off it is in all; but
of limbs with few markers it is as wrong as in each direction."""
OWN_POSE = 3
"""Markers that give a pose."""


class Expected(NamedTuple):
    """Where a joint centre is expected."""

    centre: Array
    """(3,) m, in the parent's frame."""
    spread: float
    """m, how far off it may be."""
    source: str
    """Where it comes from, for a person."""
    anatomy: bool = False
    """Whether it is a point of bone whose spread was measured on people: to be weighed with what
    the motion tells, not only to hold what that leaves open."""


def expected_centre(
    joint: JointModel, parent: Body, sample: dict[str, Array], child_labels: tuple[str, ...]
) -> Expected:
    """Return the expected joint centre in the parent's frame.

    Parameters
    ----------
    sample
        Label → (n_sample, 3) m, every marker of the recording in the sampled frames.
    child_labels
        The child's own markers.
    """
    for landmark in joint.landmarks:
        if found := _landmark(landmark, joint, parent, sample):
            return Expected(*found, landmark.source or "landmark", bool(landmark.plane))
    cloud = np.stack([sample[label] for label in child_labels], axis=1)
    child = median_seen(mean_seen(into_frame(parent.rotations, parent.shifts, cloud), axis=1))
    own = np.nan_to_num(mean_seen(parent.shape))
    if not np.isfinite(child).all():
        child = own
    few = _few(parent, child_labels)
    share = NO_LANDMARK_FIRM if joint.n_axes == 1 or few else NO_LANDMARK_SHARE
    spread = max(share * float(np.linalg.norm(child - own)), 0.02)
    return Expected((child + own) / 2, spread, BETWEEN)


def expected_off(source: str, parent: Body, child_labels: tuple[str, ...]) -> float:
    """Return how far off an expectation is in each direction, in its spreads."""
    return MIDWAY_OFF if source == BETWEEN and not _few(parent, child_labels) else 1.0


def _few(parent: Body, child_labels: tuple[str, ...]) -> bool:
    return min(len(parent.labels), len(child_labels)) < OWN_POSE


def _landmark(
    landmark: Landmark, joint: JointModel, parent: Body, sample: dict[str, Array]
) -> tuple[Array, float] | None:
    needed = {*landmark.weights, *(landmark.scale or ()), *landmark.plane}
    if not needed <= sample.keys():
        return None
    if landmark.plane:
        point = in_plane(landmark, parent, sample, _inward_by_name(joint))
        return None if point is None else (point, landmark.spread)
    world = np.sum([w * sample[label] for label, w in landmark.weights.items()], axis=0)
    local = into_frame(parent.rotations, parent.shifts, world[:, None])[:, 0]
    if not np.isfinite(local).all(axis=1).any():
        return None
    centre = median_seen(local)
    if landmark.scale is None or not (landmark.inward or landmark.down or landmark.forward):
        return centre, landmark.spread
    a, b = landmark.scale
    apart = np.linalg.norm(sample[a] - sample[b], axis=1)
    if not np.isfinite(apart).any() or parent.up is None:
        return None
    size = float(median_seen(apart))
    up = parent.up
    spread = landmark.spread
    if parent.right is None:
        # nobody knows which way is in: stay, and say how far off that may be
        spread = float(np.hypot(spread, size * max(abs(landmark.inward), abs(landmark.forward))))
        return centre - landmark.down * size * up, spread
    right = beside(parent.right, up)
    forward = np.cross(up, right)
    inward = inward_sign(joint, centre, parent, right) * right
    moved = landmark.inward * inward - landmark.down * up + landmark.forward * forward
    return centre + size * moved, spread


def inward_sign(joint: JointModel, point: Array, parent: Body, right: Array) -> float:
    """Return +1 where the middle of the body lies to the right of a point, −1 to its left."""
    return _inward_by_name(joint) or (
        -1.0 if (point - mean_seen(parent.shape)) @ right > 0 else 1.0
    )


def _inward_by_name(joint: JointModel) -> float:
    """Return +1 on the left, −1 on the right, 0 where the joint's names tell no side."""
    for name in (joint.child, joint.name):
        if name.startswith(("left_", "right_")):
            return 1.0 if name.startswith("left_") else -1.0
    return 0.0
