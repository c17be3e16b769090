"""Labels as a quadratic assignment: what it costs that these points bear these labels.

Every two points cost how unlike their distance, and its spread over time, are to those of their two
labels; every four that turn the way the layout's do are rewarded. A point without a label costs
nothing, so labels that fit worse than nothing are not given.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Array
from kinesphere.geometry.signature import Signature
from kinesphere.labelling import kernels
from kinesphere.labelling.template import DEVIATION_FLOOR, DEVIATION_SHARE, Template

HANDED = 0.5
"""Nats between a quadruple that turns the right way and one whose side is even, if it does so in
every posture; .3 to .8 measure alike."""
UNKNOWN = 3.0
"""Nats from which on a pair fits its labels worse than nothing does: right pairs have 1 on average,
a point at a random place with a random spread 4 to 5."""
INTO_FREE = 0.075
"""What a nat counts that keeps a point from a label nobody bears. An exchange of two points must
fit both of them worse; one that slides into the place of a missing neighbour is held by its own
distances alone, and those differ between people."""
STILLER = 0.25
"""Least that a deviation below the template's counts, beside one above it: a limb that rests while
it is recorded is steady with everything, forty pairs at once that tell one thing. What a single
recording rested in is not known, so it counts one over the number of recordings."""
THINNED = 500
"""Quadruples that are enough while labels change at random."""
FEWEST_FRAMES = 5
"""Frames together that make a pair count in full; one alone says nothing of a spread."""

Labels = NDArray[np.int64]
"""(n_points,) index of the label each point bears, −1 for none."""


@dataclass(frozen=True)
class Problem:
    """Costs of one set of points and one template, ready for the kernels."""

    costs: NDArray[np.float32]
    """(n_points, n_labels, n_points, n_labels)"""
    quadruples: NDArray[np.int64]
    wanted: Array
    """(n_quads,) handedness times reward."""
    table: NDArray[np.int8]
    of_label: NDArray[np.int64]
    """(n_labels, n) quadruples that hold each label."""
    n_of_label: NDArray[np.int64]

    @property
    def n_points(self) -> int:
        """Number of points."""
        return int(self.costs.shape[0])

    @property
    def n_labels(self) -> int:
        """Number of labels."""
        return int(self.costs.shape[1])

    @property
    def handed(self) -> tuple[NDArray[np.int64], Array, NDArray[np.int8]]:
        """What kernels need to know of handedness."""
        return self.quadruples, self.wanted, self.table

    def energy(self, labels: Labels) -> float:
        """Return the cost of these labels in nats; the lower, the likelier."""
        every = np.arange(len(self.quadruples))
        holder = self.holders(labels)
        return kernels.pair_energy(labels, self.costs) + kernels.handed_energy(
            holder, *self.handed, every
        )

    def agreement(self, labels: Labels) -> float:
        """Return how far the quadruples that are all labelled turn the right way, −1…1."""
        holder = self.holders(labels)
        held = np.flatnonzero((holder[self.quadruples] >= 0).all(axis=1))
        total = np.abs(self.wanted[held]).sum()
        energy = kernels.handed_energy(holder, *self.handed, held)
        return kernels.BASE - energy / total if total else np.nan

    def holders(self, labels: Labels) -> Labels:
        """Return the point that bears each label, (n_labels,), −1 for none."""
        holder = np.full(self.n_labels, -1, dtype=np.int64)
        labelled = np.flatnonzero(labels >= 0)
        holder[labels[labelled]] = labelled
        return holder

    def descend(
        self,
        labels: Labels,
        *,
        nullable: bool,
        points: Labels | None = None,
        targets: Labels | None = None,
    ) -> Labels:
        """Return labels after the steepest exchanges, among some points and labels if given."""
        changed = labels.copy()
        kernels.descend(
            changed,
            self.holders(changed),
            self.costs,
            *self.handed,
            self.of_label,
            self.n_of_label,
            np.arange(self.n_points) if points is None else points,
            np.arange(self.n_labels) if targets is None else targets,
            nullable,
        )
        return changed

    def anneal(
        self,
        labels: Labels,
        draws: Array,
        hot: float,
        cold: float,
        *,
        points: Labels | None = None,
        targets: Labels | None = None,
    ) -> Labels:
        """Return labels after random exchanges, among some points and labels if given.

        They grow less willing to go upward. A share of the quadruples stands for all of them.
        Without points or without labels to exchange nothing changes.
        """
        changed = labels.copy()
        if 0 in (len(labels) if points is None else len(points), self.n_labels):
            return changed
        if targets is not None and not len(targets):
            return changed
        some, weights = self.thinned
        kernels.anneal(
            changed,
            self.holders(changed),
            self.costs,
            some,
            weights,
            self.table,
            *holding(some, self.n_labels),
            np.arange(self.n_points) if points is None else points,
            np.arange(self.n_labels) if targets is None else targets,
            draws,
            hot,
            cold,
        )
        return changed

    @cached_property
    def thinned(self) -> tuple[NDArray[np.int64], Array]:
        """Every so many of the quadruples, and what each then wants."""
        step = max(1, len(self.quadruples) // THINNED)
        return np.ascontiguousarray(self.quadruples[::step]), step * self.wanted[::step]

    def energies(self, labels: Labels) -> Array:
        """Return the energy each point takes part in, (n_points,)."""
        energies = np.empty(self.n_points)
        kernels.point_energies(labels, self.holders(labels), self.costs, *self.handed, energies)
        return energies

    def least_changes(self, labels: Labels) -> tuple[Array, Labels]:
        """Return the least rise of energy that changes each point's label, and to which."""
        least = np.full(self.n_points, np.inf)
        rival = np.full(self.n_points, -1, dtype=np.int64)
        kernels.least_changes(
            labels.copy(),
            self.holders(labels),
            self.costs,
            *self.handed,
            self.of_label,
            self.n_of_label,
            INTO_FREE,
            least,
            rival,
        )
        return least, rival


def problem_of(
    found: Signature, scale: float, template: Template, like: tuple[Problem, int] | None = None
) -> Problem:
    """Return the costs of points with this signature, ``scale`` being theirs.

    Parameters
    ----------
    like
        A problem of the same points whose template differs by one label only, and that label:
        the other costs are taken over.
    """
    n = found.n
    mean = np.nan_to_num(found.mean / scale)
    std = np.nan_to_num(found.std / scale)
    weight = np.minimum(found.frames / FEWEST_FRAMES, 1.0)
    if like is None:
        costs, only = np.zeros((n, template.n, n, template.n), dtype=np.float32), -1
    else:
        costs, only = like[0].costs.copy(), like[1]
        costs[:, only] = costs[:, :, :, only] = 0.0
    kernels.pair_costs(
        mean,
        np.log(std + DEVIATION_FLOOR),
        DEVIATION_SHARE * std**2,
        weight,
        template.mean,
        template.variance,
        template.log_std,
        template.log_variance,
        max(STILLER, 1 / template.n_recordings),
        UNKNOWN,
        only,
        costs,
    )
    return Problem(
        costs,
        template.quadruples,
        HANDED * template.handedness,
        found.handedness,
        *holding(template.quadruples, template.n),
    )


def holding(
    quadruples: NDArray[np.int64], n_labels: int
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Return which quadruples hold each label, (n_labels, most), and how many, (n_labels,)."""
    found = [np.flatnonzero((quadruples == i).any(axis=1)) for i in range(n_labels)]
    count = np.array([len(some) for some in found], dtype=np.int64)
    of_label = np.zeros((n_labels, max(1, int(count.max(initial=0)))), dtype=np.int64)
    for i, some in enumerate(found):
        of_label[i, : len(some)] = some
    return of_label, count
