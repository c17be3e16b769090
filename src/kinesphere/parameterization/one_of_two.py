"""One axis that a joint's movement tells, and the other put across it."""

import numpy as np

from kinesphere.data import Array
from kinesphere.parameterization.anatomy import body_axes, without_side
from kinesphere.parameterization.confidence import TISSUE, AxesQuality
from kinesphere.parameterization.repeats import repeats
from kinesphere.parameterization.samples import JointSamples
from kinesphere.parameterization.second_axis import second_axis
from kinesphere.parameterization.settings import AxesSettings
from kinesphere.parameterization.view import JointView

REPEATED = 2  # times each main movement is done: once alone contradicts nothing, where others are
CLEAR = 0.8  # of the largest uncertainty: halves tell it no better than to a fifth
FARTHEST = 30.0  # deg from the body's axis: two measured axes confirm each other, one alone has
# nothing but the body's beside it; functional hips, lumbar and necks are 3-16° off
# the body has none for the joint below the ankle, whose axis rises by 42° (Isman & Inman 1969)
FARTHEST_AT = {"ankle": 45.0}


def axis_told(
    quality: AxesQuality, axes: Array, samples: JointSamples, view: JointView, s: AxesSettings
) -> int | None:
    """Return which of two axes its movement tells although the other is doubtful; None if not one.

    Beside what is asked of every axis (range, halves, uncertainty), its phases must be pure by
    themselves, its movement done more than once, and it must lie near an axis of the body. All
    that is asked of it stands clear of its limit, and the other keeps to none: or a little noise
    would turn one that is kept into the other.

    Parameters
    ----------
    quality
        Of ``axes``.
    axes : (n_found, 3)
        One or two.
    samples
        With the phases they are from.
    view
        The joint: whether anatomy says where it can have axes.
    s
        The limits.
    """
    least_ratio = np.sqrt(s.purest / (1 - s.purest)) if s.purest < 1 else np.inf
    with np.errstate(invalid="ignore"):
        passes = (
            (np.rad2deg(quality.ranges) >= s.smallest_range)
            & (np.rad2deg(quality.halves) <= 2 * s.largest_uncertainty)
            & (np.rad2deg(quality.uncertainty) <= s.largest_uncertainty)
            & (quality.conditioning >= least_ratio)
        )
    if passes.any():
        passes &= repeats(samples, axes, quality.labels) >= REPEATED
    clear = quality.uncertainty <= CLEAR * np.deg2rad(s.largest_uncertainty)
    clear &= quality.ranges >= np.deg2rad(s.smallest_range) + TISSUE
    body = body_axes(view.name)
    if view.human and body is not None:
        farthest = np.deg2rad(FARTHEST_AT.get(without_side(view.name), FARTHEST))
        off = np.arccos(np.minimum(1.0, np.abs(axes @ body[:2].T).max(axis=1)))
        passes &= off <= farthest
        clear &= off + quality.uncertainty <= farthest
    return int(passes.argmax()) if passes.sum() == 1 and clear[passes.argmax()] else None


def completed(axis: Array, name: str, limb: Array) -> tuple[Array, int]:
    """Return an axis and one across it, distal first, (2, 3), and where in them the axis is.

    The other is the body frame's as far as it lies across; flexion is proximal. Of a joint nobody
    named the axis is proximal, and the other lies across it and the limb.

    Parameters
    ----------
    axis : (3,)
        In the parent.
    name
        Of the joint.
    limb : (3,)
        Where the limb points on average, in the parent.
    """
    body = body_axes(name)
    if body is None:
        side = np.eye(3)[np.abs(limb).argmin()]
        return np.array([second_axis(axis, limb, side), axis]), 1
    mine = int(np.abs(body[:2] @ axis).argmax())
    axis = axis if body[mine] @ axis >= 0 else -axis
    other = body[1 - mine] - (body[1 - mine] @ axis) * axis
    other /= np.linalg.norm(other)
    return (np.array([other, axis]), 1) if mine == 0 else (np.array([axis, other]), 0)
