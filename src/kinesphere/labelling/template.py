"""What a layout's statistics look like on a person nobody has seen yet."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Self

import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Array, TopologicalModel
from kinesphere.errors import BadModel
from kinesphere.labelling.pooling import DEVIATION_FLOOR as DEVIATION_FLOOR
from kinesphere.labelling.pooling import pooled
from kinesphere.labelling.postures import postures_of, spread_of_distances, steadiness
from kinesphere.labelling.quadruples import stable_quadruples

DISTANCE_SHARE = 0.12
"""Spread between people of a mean distance, as a share of it, beside that between postures."""
DISTANCE_FLOOR = 0.011
"""And at least, in scales of the body: 7 cm on a full layout."""
DEVIATION_SHARE = 0.6
"""How much of a distance's variance over time its mean may be off by: another motion."""
DEVIATION_SPREAD = 0.3
"""Spread between recordings of the logarithm of a deviation within a segment."""
POSTURE_DEVIATION = 0.5
"""Deviation over time of a distance that postures change, as a share of its spread between them:
what counts as one recording more."""
POSTURE_DEVIATION_SPREAD = 0.8
"""Spread between recordings of the logarithm of such a deviation: what one rests another moves."""
STIFF = 1e-6
"""Spread between postures below which a distance is within a segment, in scales of the body."""
STEADY = 0.5
"""Steadiness of a quadruple in other postures from which on it tells left from right; what is more
counts in proportion."""
FAINTEST = 0.05
"""Least that a quadruple must count to be looked at."""
UNJOINTED = (0.02, 0.5, 0.3)
"""Where nobody has told what moves with what: the floor of distances, which stands for other
postures then, the spread of logarithms of deviations, and what a quadruple counts."""
PRIOR = 2
"""Recordings that these spreads count as, beside those that the template is learnt from."""
LEAST_LABELS = 4
"""Labels a template needs: fewer have no handedness, and three distances fit anything."""


@dataclass(frozen=True)
class Template:
    """Expected statistics of a layout, in scales of the body (``scale_of``)."""

    labels: tuple[str, ...]
    mean: Array
    """(n, n) mean distance; NaN where nothing is known."""
    variance: Array
    """(n, n) of the mean, between people and motions."""
    log_std: Array
    """(n, n) mean logarithm of the deviation over time."""
    log_variance: Array
    """(n, n)"""
    quadruples: NDArray[np.int64]
    """(n_quads, 4) labels whose handedness is stable, the tightest first."""
    handedness: Array
    """(n_quads,) −1…1"""
    size: float
    """m, mean scale of the people it was learnt from: only told, never used to recognise."""
    n_recordings: int

    @property
    def n(self) -> int:
        """Number of labels."""
        return len(self.labels)

    def with_other_side(self, label: int, twin: NDArray[np.int64]) -> Self:
        """Return the template of a person who wears one unpaired marker on the other side.

        Parameters
        ----------
        twin : (n,)
            The label of the other side; unpaired ones are their own.
        """
        columns = {}
        for name in ("mean", "variance", "log_std", "log_variance"):
            changed = getattr(self, name).copy()
            changed[label, :] = getattr(self, name)[label, twin]
            changed[:, label] = getattr(self, name)[twin, label]
            columns[name] = changed
        holds = (self.quadruples == label).any(axis=1)
        quadruples = np.where(holds[:, None], twin[self.quadruples], self.quadruples)
        handed = np.where(holds, -self.handedness, self.handedness)
        return replace(self, **columns, quadruples=quadruples, handedness=handed)


def template_of(model: TopologicalModel, labels: Sequence[str] | None = None) -> Template:
    """Return the template that a model's statistics add up to.

    Means and spreads are pooled over its recordings; what few recordings cannot tell about a
    spread, spreads between people in general do (``DISTANCE_SHARE`` and the others; set while
    looking at 41-marker recordings of six people), and those between postures that the layout
    might be in (``labelling.postures``).

    Parameters
    ----------
    labels
        Only these; every label the statistics know, if None.

    Raises
    ------
    BadModel
        If the model has no statistics, or of fewer than four labels.
    """
    known = _known_labels(model, labels)
    pool = pooled(model.statistics, known)
    quadruples, handed = stable_quadruples(model.statistics, known, pool.mean)
    bent, told = _told_by_joints(model, known, pool.mean, quadruples)
    floor, log_spread = (DISTANCE_FLOOR, DEVIATION_SPREAD) if model.joints else UNJOINTED[:2]
    prior = (
        (DISTANCE_SHARE * pool.mean) ** 2 + floor**2 + bent**2 + DEVIATION_SHARE * pool.mean_square
    )
    weight = np.maximum(pool.n + PRIOR - 1, 1)
    likely = np.log(POSTURE_DEVIATION * bent + DEVIATION_FLOOR)
    log_std = np.where(bent > 0, (pool.n * pool.log_std + likely) / (pool.n + 1), pool.log_std)
    log_spreads = np.where(bent > 0, POSTURE_DEVIATION_SPREAD, log_spread)
    kept = np.abs(handed * told) > FAINTEST
    return Template(
        labels=known,
        mean=pool.mean,
        variance=(PRIOR * prior + pool.squares) / weight,
        log_std=log_std,
        log_variance=(PRIOR * log_spreads**2 + pool.log_squares) / weight,
        quadruples=np.ascontiguousarray(quadruples[kept]),
        handedness=(handed * told)[kept],
        size=pool.size,
        n_recordings=len(model.statistics),
    )


def _told_by_joints(
    model: TopologicalModel, labels: tuple[str, ...], mean: Array, quadruples: NDArray[np.int64]
) -> tuple[Array, Array]:
    """Return how much postures change each distance, and what each quadruple counts, 0…1."""
    if not model.joints:
        return np.zeros_like(mean), np.full(len(quadruples), UNJOINTED[2])
    postures = postures_of(model, labels, mean)
    bent = spread_of_distances(postures)
    bent[bent < STIFF] = 0.0
    steady = (steadiness(postures, quadruples) - STEADY) / (1 - STEADY)
    return bent, np.clip(steady, 0.0, 1.0)


def usual_deviations(model: TopologicalModel) -> Array:
    """Return how much every distance usually varies over time, m; (n, n) in the model's order.

    NaN where the statistics know nothing.
    """
    known = _known_labels(model, None)
    pool = pooled(model.statistics, known)
    at = [model.labels.index(label) for label in known]
    usual = np.full((len(model.labels), len(model.labels)), np.nan)
    std = np.maximum(np.exp(pool.log_std) - DEVIATION_FLOOR, 0.0)
    usual[np.ix_(at, at)] = pool.size * np.where(np.isnan(pool.mean), np.nan, std)
    return usual


def of_one_segment(model: TopologicalModel, labels: tuple[str, ...]) -> NDArray[np.bool_]:
    """Return which labels share a segment, as its own or shared ones, (n, n)."""
    together = np.eye(len(labels), dtype=bool)
    for segment in model.segments:
        own = np.isin(labels, (*segment.markers, *segment.shared))
        together |= own[:, None] & own
    return together


def _known_labels(model: TopologicalModel, labels: Sequence[str] | None) -> tuple[str, ...]:
    """Return the labels with statistics, of those wanted; BadModel if they are too few."""
    if not model.statistics:
        raise BadModel(
            f"model {model.name} has no statistics to recognise markers by; learn them from a "
            "labelled recording: 'kinesphere model LABELLED -o MODEL.json'"
        )
    wanted = model.labels if labels is None else tuple(labels)
    seen = {
        label
        for statistics in model.statistics
        for label, row in zip(statistics.labels, statistics.mean, strict=True)
        if np.isfinite(row).sum() > 1
    }
    known = tuple(label for label in wanted if label in seen)
    if len(known) < LEAST_LABELS:
        raise BadModel(
            f"model {model.name} has statistics of {len(known)} markers; {LEAST_LABELS} at least "
            "are needed to recognise a layout"
        )
    return known
