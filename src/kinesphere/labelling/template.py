"""What a layout's statistics look like on a person nobody has seen yet."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Self

import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Array, MarkerStatistics, TopologicalModel
from kinesphere.errors import BadModel
from kinesphere.geometry.signature import scale_of

DISTANCE_SHARE = 0.12
"""Spread between people of a mean distance, as a share of it."""
DISTANCE_FLOOR = 0.02
"""And at least, in scales of the body: 12 cm on a full layout."""
DEVIATION_SHARE = 0.6
"""How much of a distance's variance over time its mean may be off by: another motion."""
DEVIATION_SPREAD = 0.5
"""Spread between recordings of the logarithm of a deviation."""
DEVIATION_FLOOR = 0.01
"""Added to a deviation before its logarithm is taken, in scales of the body."""
PRIOR = 2
"""Recordings that these spreads count as, beside those that the template is learnt from."""
QUADRUPLES = 2000
"""Most quadruples looked at: the tightest."""
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
    looking at 41-marker recordings of six people).

    Parameters
    ----------
    labels
        Only these; every label the statistics know, if None.

    Raises
    ------
    BadModel
        If the model has no statistics, or of fewer than four labels.
    """
    if not model.statistics:
        raise BadModel(
            f"model {model.name} has no statistics to recognise markers by; learn them from a "
            "labelled recording: 'kinesphere model LABELLED -o MODEL.json'"
        )
    known = _known_labels(model, labels)
    if len(known) < LEAST_LABELS:
        raise BadModel(
            f"model {model.name} has statistics of {len(known)} markers; {LEAST_LABELS} at least "
            "are needed to recognise a layout"
        )
    parts = [_taken(statistics, known) for statistics in model.statistics]
    scales = _scales([mean for mean, _ in parts])
    mean = np.stack([m / scale for (m, _), scale in zip(parts, scales, strict=True)])
    std = np.stack([s / scale for (_, s), scale in zip(parts, scales, strict=True)])
    logs = np.log(std + DEVIATION_FLOOR)
    n = np.isfinite(mean).sum(axis=0)
    middle, log_middle = _mean(mean), _mean(logs)
    prior = (DISTANCE_SHARE * middle) ** 2 + DISTANCE_FLOOR**2 + DEVIATION_SHARE * _mean(std**2)
    weight = np.maximum(n + PRIOR - 1, 1)
    variance = (PRIOR * prior + np.nansum((mean - middle) ** 2, axis=0)) / weight
    log_variance = (
        PRIOR * DEVIATION_SPREAD**2 + np.nansum((logs - log_middle) ** 2, axis=0)
    ) / weight
    quadruples, handed = _quadruples(model.statistics, known, middle)
    return Template(
        labels=known,
        mean=middle,
        variance=variance,
        log_std=log_middle,
        log_variance=log_variance,
        quadruples=quadruples,
        handedness=handed,
        size=float(np.mean(scales)),
        n_recordings=len(parts),
    )


def usual_deviations(model: TopologicalModel) -> Array:
    """Return how much every distance usually varies over time, m; (n, n) in the model's order.

    NaN where the statistics know nothing.
    """
    template = template_of(model)
    at = [model.labels.index(label) for label in template.labels]
    usual = np.full((len(model.labels), len(model.labels)), np.nan)
    std = np.maximum(np.exp(template.log_std) - DEVIATION_FLOOR, 0.0)
    usual[np.ix_(at, at)] = template.size * np.where(np.isnan(template.mean), np.nan, std)
    return usual


def of_one_segment(model: TopologicalModel, labels: tuple[str, ...]) -> NDArray[np.bool_]:
    """Return which labels share a segment, as its own or shared ones, (n, n)."""
    together = np.eye(len(labels), dtype=bool)
    for segment in model.segments:
        own = np.isin(labels, (*segment.markers, *segment.shared))
        together |= own[:, None] & own
    return together


def _known_labels(model: TopologicalModel, labels: Sequence[str] | None) -> tuple[str, ...]:
    wanted = model.labels if labels is None else tuple(labels)
    seen = {
        label
        for statistics in model.statistics
        for label, row in zip(statistics.labels, statistics.mean, strict=True)
        if np.isfinite(row).sum() > 1
    }
    return tuple(label for label in wanted if label in seen)


def _taken(statistics: MarkerStatistics, labels: tuple[str, ...]) -> tuple[Array, Array]:
    """Return mean and deviation of these labels, NaN where the recording has none."""
    at = {label: i for i, label in enumerate(statistics.labels)}
    here = [i for i, label in enumerate(labels) if label in at]
    there = [at[labels[i]] for i in here]
    found = np.full((2, len(labels), len(labels)), np.nan)
    found[0][np.ix_(here, here)] = statistics.mean[np.ix_(there, there)]
    found[1][np.ix_(here, here)] = statistics.deviation[np.ix_(there, there)]
    return found[0], found[1]


def _scales(means: Sequence[Array]) -> list[float]:
    """Return each recording's scale; one that lacks markers is measured by those it shares."""
    whole = [bool(np.isfinite(mean).all()) for mean in means]
    full = max(range(len(means)), key=lambda k: (np.isfinite(means[k]).sum(), -k))
    base = scale_of(means[full])
    scales = []
    for k, mean in enumerate(means):
        if whole[k] or k == full:
            scales.append(scale_of(mean))
            continue
        both = np.isfinite(mean) & np.isfinite(means[full]) & (means[full] > 0)
        ratio = float(np.median(mean[both] / means[full][both])) if both.any() else 1.0
        scales.append(base * ratio)
    return scales


def _mean(values: Array) -> Array:
    """Return the mean over recordings, NaN where none knows anything."""
    known = np.isfinite(values)
    n = known.sum(axis=0)
    total = np.where(known, values, 0.0).sum(axis=0)
    return np.where(n > 0, total / np.maximum(n, 1), np.nan)


def _quadruples(
    statistics: Sequence[MarkerStatistics], labels: tuple[str, ...], mean: Array
) -> tuple[NDArray[np.int64], Array]:
    """Return the quadruples that every recording which has the four labels finds stable."""
    at = {label: i for i, label in enumerate(labels)}
    signs: dict[tuple[int, ...], list[float]] = {}
    able: list[set[int]] = []
    for one in statistics:
        number = np.array([at.get(label, -1) for label in one.labels], dtype=np.int64)
        seen = np.isfinite(one.mean).sum(axis=1) > 1
        able.append({int(number[i]) for i in np.flatnonzero(seen) if number[i] >= 0})
        if not len(one.quadruples):
            continue
        fours = number[one.quadruples]
        order = np.argsort(fours, axis=1, kind="stable")
        turned = one.handedness * _parity(order)
        for four, sign, raw in zip(np.sort(fours, axis=1), turned, fours, strict=True):
            if (raw >= 0).all():
                signs.setdefault(tuple(int(x) for x in four), []).append(float(sign))
    kept = []
    for four, found in signs.items():
        could = sum(set(four) <= some for some in able)
        if len(found) == could and abs(sum(found)) > 0.9 * len(found):
            around = sum(mean[a, b] for i, a in enumerate(four) for b in four[i + 1 :])
            kept.append((around, four, sum(found) / len(found)))
    kept = sorted(kept)[:QUADRUPLES]
    fours = np.array([four for _, four, _ in kept], dtype=np.int64).reshape(-1, 4)
    return fours, np.array([sign for _, _, sign in kept], dtype=np.float64)


def _parity(order: NDArray[np.intp]) -> Array:
    """Return +1 or −1 for each row's permutation of four."""
    inversions = sum(
        (order[:, i] > order[:, j]).astype(int) for i in range(4) for j in range(i + 1, 4)
    )
    return np.where(np.asarray(inversions) % 2 == 0, 1.0, -1.0)
