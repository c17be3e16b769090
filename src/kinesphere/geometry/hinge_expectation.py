"""How tightly the centre of a joint of one axis is held where it is expected, and along what."""

import numpy as np
from numpy.typing import NDArray

from kinesphere.geometry.centre_views import View
from kinesphere.geometry.joint_turns import main_axis

Array = NDArray[np.float64]

ALIGNED = 0.8
"""Least cosine between the axis of a hinge and the direction its motion knows least."""
FIRM = 16.0
"""Information from the motion, in the expectation's units, above which a hinge is left to it."""


def tighter_along(view: View, expected: Array, tighter: float) -> Array:
    """Return how much tighter a hinge is expected, (3, 3), in the expectation's own units.

    Along the axis it turns about. As far as single rotations stray from that axis, or it points
    along the limb, what is unsure across it is unsure along it.
    """
    assert view.turning is not None
    axis, strays = main_axis(view.turning)
    points, seen, *_ = view.sightings
    arm = (points[seen] - expected).sum(axis=0) if seen.any() else np.zeros(3)
    pointing = float((axis @ arm) ** 2 / max(arm @ arm, 1e-300))
    times = 1 / (1 / tighter**2 + strays + pointing)
    more: Array = max(times - 1, 0.0) * np.outer(axis, axis)
    return more


def open_axis(information: Array, spread: float, hinge: Array) -> Array | None:
    """Return the direction in which a hinge's centre is left to its expectation, (3,)."""
    values, vectors = np.linalg.eigh(information)
    aligned = abs(vectors[:, 0] @ hinge) > ALIGNED
    return vectors[:, 0] if aligned and values[0] * spread**2 < FIRM else None
