"""The axis of a hinge in free motion, where no main movement tells it: all of it together does."""

from dataclasses import dataclass, replace

import numpy as np

from kinesphere.data import Array
from kinesphere.parameterization.anatomy import joint_kind, substitute_axes
from kinesphere.parameterization.arcs import PERCENTILES
from kinesphere.parameterization.axes.hinge import hinge_axis, other_reading
from kinesphere.parameterization.axes.registry import BY_ORIENTATION
from kinesphere.parameterization.confidence import with_skin
from kinesphere.parameterization.coupling import coupling
from kinesphere.parameterization.samples import JointSamples, Phase
from kinesphere.parameterization.settings import AxesSettings
from kinesphere.parameterization.view import JointView

FOLDS = 4  # parts of the movement, each left out once
SHORTEST = 1.0  # s of movement in a fold; less says nothing
LOOSE = 3.0  # times the largest uncertainty: an axis of free motion less certain is none,
# however well it foretells; 4-22° where it does on real elbows and knees, 45° where by accident
CLEARLY = 0.8  # times what the body's axis leaves: from there on a measured axis is better


@dataclass(frozen=True, eq=False)
class FreeHinge:
    """An axis found from everything a hinge did, beside the body's."""

    axis: Array
    """(3,)"""
    uncertainty: float
    """rad, standard deviation of the direction of the axis: jackknife over the folds, skin,
    ``reading``, and other movement that goes with it."""
    reading: float
    """rad, how far the axis is off if the limb twists with the angle: `other_reading`."""
    error: float
    """rad, mean out-of-cone angle in parts that the axis and its cone were not found from."""
    body_error: float
    """rad, the same of the body's axis, its cone found as that of the other."""
    moved: float
    """rad, arc that the limb's direction covers about the axis."""
    coupled: float = 0.0
    """rad, how far other movement that goes with it may put the axis off: `coupling`."""

    @property
    def clearly_better(self) -> bool:
        """Whether it foretells where the limb goes clearly better than the body's axis does."""
        return self.error < CLEARLY * self.body_error


def hinge_worth_having(view: JointView, options: AxesSettings) -> FreeHinge | None:
    """Return the axis of a hinge in free motion; None where it is not clearly worth having."""
    if options.method not in BY_ORIENTATION or options.on_doubt != "body":
        return None
    body_axis = substitute_axes(view.name, 1, view.gravity)[0]
    found = free_hinge(view.samples, body_axis)
    if found is None or not found.clearly_better:
        return None
    axis, moved = found.axis[None], np.array([found.moved])
    coupled = float(coupling(view.samples, axis, moved, view.neighbours)[0])
    uncertainty = float(np.hypot(found.uncertainty, coupled))
    found = replace(found, uncertainty=uncertainty, coupled=coupled)
    far = np.arccos(min(1.0, abs(float(found.axis @ body_axis)))) > np.deg2rad(options.farthest)
    small = found.moved < np.deg2rad(options.smallest_range)
    loose = found.uncertainty > np.deg2rad(LOOSE * options.largest_uncertainty)
    anatomical = view.human and joint_kind(view.name) is not None
    return None if small or loose or (far and anatomical) else found


def free_hinge(samples: JointSamples, body_axis: Array) -> FreeHinge | None:
    """Return the axis of a hinge from all its movement, judged by what it was not found from.

    Leave-one-part-out prediction and the jackknife: Efron & Tibshirani 1993, chapters 11 and 17.
    The limb's directions draw a circle about the axis, whatever it twists.

    Parameters
    ----------
    samples
        With all movement phases of the calibration.
    body_axis : (3,)
        What would serve instead.

    Returns
    -------
    FreeHinge or None
        None where there is less than four seconds of movement.
    """
    folds = _folds(samples)
    if folds is None:
        return None
    everything = np.concatenate([np.arange(a, b) for a, b in samples.phases])
    axis = hinge_axis(samples, body_axis[None])[0]
    errors, body_errors, turns = [], [], []
    for left_out, kept in folds:
        found = hinge_axis(samples.with_phases(kept), axis[None])[0]
        known = np.concatenate([samples.positions[a:b] for a, b in kept])
        new = np.concatenate([samples.positions[a:b] for a, b in left_out])
        errors.append(_out_of_cone(found, known, new))
        body_errors.append(_out_of_cone(body_axis, known, new))
        turns.append(np.arctan2(np.linalg.norm(np.cross(found, axis)), abs(found @ axis)))
    p = samples.positions[everything]
    across = p - np.outer(p @ axis, axis)
    middle = across.mean(axis=0)
    azimuth = np.arctan2(np.cross(middle, across) @ axis, across @ middle)
    arc = float(np.diff(np.percentile(azimuth, PERCENTILES))[0])
    moved = arc * float(np.median(np.linalg.norm(across, axis=1)))
    jackknife = np.sqrt((FOLDS - 1) / FOLDS * np.sum(np.square(turns)))
    reading = other_reading(samples, axis)  # alike in all folds: the jackknife does not see it
    return FreeHinge(
        axis=axis,
        uncertainty=float(with_skin(np.hypot(jackknife, reading), np.array(moved))),
        reading=reading,
        error=float(np.concatenate(errors).mean()),
        body_error=float(np.concatenate(body_errors).mean()),
        moved=moved,
    )


def worse_than_body(axis: Array, body_axis: Array, positions: Array) -> bool:
    """Return whether directions, (n, 3), leave the cone about an axis much more than the body's."""
    own, body = (_out_of_cone(a, positions, positions).mean() for a in (axis, body_axis))
    return bool(CLEARLY * own > body)


def _folds(
    samples: JointSamples,
) -> list[tuple[tuple[Phase, ...], tuple[Phase, ...]]] | None:
    """Return (left out, kept) phases of each contiguous part of the movement."""
    lengths = [b - a for a, b in samples.phases]
    total = sum(lengths)
    if total < FOLDS * SHORTEST * samples.rate:
        return None
    frames = np.concatenate([np.arange(a, b) for a, b in samples.phases])
    folds = []
    for k in range(FOLDS):
        # what is too little to be shared out is left out nowhere, whichever way time runs
        low = int(frames[-(-total * k // FOLDS)])
        high = int(frames[total * (k + 1) // FOLDS - 1]) + 1
        spans = ((low, high),), ((0, low), (high, len(samples.positions)))
        left_out, kept = (
            tuple(
                (max(a, start), min(b, stop))
                for start, stop in span
                for a, b in samples.phases
                if min(b, stop) > max(a, start)
            )
            for span in spans
        )
        folds.append((left_out, kept))
    return folds


def _out_of_cone(axis: Array, known: Array, new: Array) -> Array:
    """Return how far new directions are from the cone of known ones about an axis, in rad."""

    def colatitudes(p: Array) -> Array:
        return np.asarray(np.arctan2(np.linalg.norm(np.cross(axis, p), axis=1), p @ axis))

    return np.abs(colatitudes(new) - float(np.median(colatitudes(known))))
