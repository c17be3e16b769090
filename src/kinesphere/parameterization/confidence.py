"""How far movement axes can be trusted: support, range, one axis at a time, agreement of halves."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from kinesphere.data import Array
from kinesphere.parameterization.arcs import arcs_about
from kinesphere.parameterization.axes.fit import Labels, phase_swing
from kinesphere.parameterization.coupling import SHARE
from kinesphere.parameterization.halves import Finder, halves_disagreement
from kinesphere.parameterization.samples import JointSamples

TISSUE = np.deg2rad(3.0)
"""rad, by which skin turns a limb over a movement, short or long: two knees of one person were 1 to
14° off in arcs of 58 to 12°, 3.2° rms over the arc beside what their halves say."""


def with_tissue(uncertainty: Array, ranges: Array) -> Array:
    """Return standard deviations of axes with what skin adds over the arc, all in rad."""
    return np.asarray(np.hypot(uncertainty, TISSUE / np.maximum(ranges, TISSUE)))


def with_skin(uncertainty: Array, ranges: Array) -> Array:
    """Return standard deviations of axes that move a limb with all that skin adds, in rad."""
    return np.hypot(with_tissue(uncertainty, ranges), SHARE)


@dataclass(frozen=True, eq=False)
class AxesQuality:
    """What speaks for and against a set of axes."""

    labels: Labels
    """(n_phases,) which axis a phase moves about."""
    ranges: Array
    """(n_axes,) rad, arc that the limb's direction covers about each axis in its phases."""
    conditioning: Array
    """(n_axes,) how many times larger the rotation about an axis was than about any other, rms: the
    root of the ratio of the two largest eigenvalues of the pooled rotation scatter."""
    explained: float
    """Share of the limb's movement that is rotation about the phase's own axis."""
    halves: Array
    """(n_axes,) rad, largest disagreement of axes found from two halves; NaN where untested."""
    heights: Array
    """(n_axes,) cosine of the cone on which the limb moves about each axis; NaN without phases."""
    readings: Array
    """(n_axes,) rad, how far another reading of the same movement is off, rms by its probability:
    `kinesphere.parameterization.axes.hinge.other_reading`; 0 where there is none."""
    coupled: Array
    """(n_axes,) rad, how far movement about other axes that goes with an axis' own may put it off,
    standard deviation: `kinesphere.parameterization.coupling`; 0 where none does."""

    @property
    def alike(self) -> Array:
        """(n_axes,) rad, what no halving shows, for it goes with the movement: twist and others."""
        return np.hypot(self.readings, self.coupled)

    @property
    def uncertainty(self) -> Array:
        """(n_axes,) rad, standard deviation of each axis.

        What halves suggest (they have twice the variance of the whole, their difference four
        times), and what is alike in both: skin, by `TISSUE` over the arc and by `SHARE`, twist
        that goes with a hinge's angle, and other movement that goes with an axis' own.
        """
        return with_skin(np.hypot(self.halves / 2, self.alike), self.ranges)

    def ordered(self, order: Sequence[int]) -> "AxesQuality":
        """Return the same for axes in another order."""
        at = list(order)
        return AxesQuality(
            labels=np.argsort(at)[self.labels],
            ranges=self.ranges[at],
            conditioning=self.conditioning[at],
            explained=self.explained,
            halves=self.halves[at],
            heights=self.heights[at],
            readings=self.readings[at],
            coupled=self.coupled[at],
        )

    def only(self, told: int, at: int) -> "AxesQuality":
        """Return the same for two axes of which only the one at ``told`` is known, now ``at``.

        The other's figures are NaN, and so is its uncertainty.
        """

        def placed(values: Array) -> Array:
            both = np.full(2, np.nan)
            both[at] = values[told]
            return both

        return AxesQuality(
            labels=np.where(self.labels == told, at, -1),
            ranges=placed(self.ranges),
            conditioning=placed(self.conditioning),
            explained=self.explained,
            halves=placed(self.halves),
            heights=placed(self.heights),
            readings=placed(self.readings),
            coupled=placed(self.coupled),
        )


def assess_axes(
    samples: JointSamples, axes: Array, find: Finder, enough: float = np.inf
) -> AxesQuality:
    """Measure how well phases support axes, (n_axes, 3), that ``find`` got from them.

    Halves that differ by more than ``enough`` rad end the comparing: for methods that take long.
    """
    n_axes = len(axes)
    labels = np.zeros(len(samples.phases), dtype=np.intp)
    pooled = np.zeros((n_axes, 3, 3))
    explained = total = 0.0
    for i, phase in enumerate(samples.phases):
        swing = phase_swing(samples, phase)
        about = swing.about(axes)
        labels[i] = int(about.argmax())
        explained += float(about.max())
        total += float((swing.vectors**2).sum())
        pooled[labels[i]] += swing.vectors.T @ swing.vectors
    values = np.linalg.eigvalsh(pooled)
    ranges, heights = arcs_about(samples, axes, labels)
    return AxesQuality(
        labels=labels,
        ranges=ranges,
        conditioning=np.sqrt(values[:, 2] / np.maximum(values[:, 1], 1e-12)),
        explained=explained / max(total, 1e-300),
        halves=halves_disagreement(samples, axes, labels, find, enough),
        heights=heights,
        readings=np.zeros(n_axes),
        coupled=np.zeros(n_axes),
    )


def observed_n_axes(samples: JointSamples) -> int | None:
    """Return how many axes the swing of the limb shows, 1 or 2; None without movement.

    One if the second eigenvalue of the rotation scatter, pooled over phases and without the
    rotation about the limb, is below 5 % of the first.
    """
    pooled = np.zeros((3, 3))
    for phase in samples.phases:
        w = phase_swing(samples, phase).vectors
        pooled += w.T @ w
    values = np.linalg.eigvalsh(pooled)
    if not values[2] > 0:
        return None
    return 1 if values[1] < 0.05 * values[2] else 2
