"""How far movement axes can be trusted: support, range, one axis at a time, agreement of halves."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from kinesphere.data import Array
from kinesphere.parameterization.axes.fit import Labels, phase_swing
from kinesphere.parameterization.samples import JointSamples, Phase
from kinesphere.parameterization.settings import AxesSettings

Finder = Callable[[JointSamples], Array]
"""Samples → (n_found, 3) axes: an axis method with its settings bound."""
Searcher = Callable[[JointSamples], tuple[JointSamples, Array]]
"""Samples → those with the phases that count, and (n_found, 3) axes from them."""

LEAST_SHARE = 0.2  # of an axis' frames in each half of the recording, for the halves to be compared
TISSUE = np.deg2rad(2.0)
"""rad, by which skin turns a limb over a movement: knees whose axis is 1° off over 130° say so."""
SHORTEST = 4  # frames of a phase that a cut may leave
PERCENTILES = (5.0, 95.0)  # a range of motion leaves the extremes out


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

    @property
    def uncertainty(self) -> Array:
        """(n_axes,) rad, standard deviation of each axis.

        What halves suggest (they have twice the variance of the whole, their difference four
        times), and what skin does to both halves alike: `TISSUE` over the arc.
        """
        return np.asarray(np.hypot(self.halves / 2, TISSUE / np.maximum(self.ranges, TISSUE)))

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
    ranges, heights = _arcs(samples, axes, labels)
    return AxesQuality(
        labels=labels,
        ranges=ranges,
        conditioning=np.sqrt(values[:, 2] / np.maximum(values[:, 1], 1e-12)),
        explained=explained / max(total, 1e-300),
        halves=halves_disagreement(samples, axes, labels, find, enough),
        heights=heights,
    )


def _arcs(samples: JointSamples, axes: Array, labels: Labels) -> tuple[Array, Array]:
    """Return the arc in rad and the cosine of the cone about each axis, (n_axes,) twice."""
    ranges, heights = np.zeros(len(axes)), np.full(len(axes), np.nan)
    for k, axis in enumerate(axes):
        mine = [samples.positions[a:b] for (a, b), at in _zip(samples, labels) if at == k]
        if mine:
            p = np.concatenate(mine)
            heights[k] = float(np.median(p @ axis))
            middle = p.mean(axis=0)
            azimuth = np.arctan2(
                np.cross(middle, p) @ axis, p @ middle - (p @ axis) * (middle @ axis)
            )
            # as an arc on the joint sphere: a full turn on a tiny circle is no movement
            arc = np.sqrt(max(0.0, 1 - heights[k] ** 2))
            ranges[k] = arc * float(np.diff(np.percentile(azimuth, PERCENTILES))[0])
    return ranges, heights


def contradiction(
    halves: Iterable[JointSamples], axes: Array, search: Searcher
) -> tuple[Array, Array]:
    """Return how far axes searched anew in each half of the time are apart, and the smaller arc.

    As if each half were a recording of its own.

    Parameters
    ----------
    halves
        Two, with all their phases.
    axes : (n_axes, 3)
    search
        Samples → those with the phases that count, and axes from them.

    Returns
    -------
    apart : (n_axes,) rad
        NaN where a half has no such axis.
    arcs : (n_axes,) rad
        How far the limb moves about each axis in the half where it moves less.
    """
    told, arcs = [], []
    for half in halves:
        used, found = search(half) if half.phases else (half, np.empty((0, 3)))
        found = _matched(found, axes)
        known = np.isfinite(found[:, 0])
        told.append(found)
        arcs.append(np.zeros(len(axes)))
        if known.any():
            labels = np.array(
                [phase_swing(used, p).about(found[known]).argmax() for p in used.phases]
            )
            arcs[-1][known] = _arcs(used, found[known], labels)[0]
    return _between(told[0], told[1]), np.minimum(arcs[0], arcs[1])


def _between(a: Array, b: Array) -> Array:
    """Return the angle between lines, (n, 3) each, (n,) rad; NaN where one is not there."""
    cosines = np.abs((a * b).sum(axis=1))
    return np.asarray(np.arctan2(np.linalg.norm(np.cross(a, b), axis=1), cosines))


def early_share(samples: JointSamples, labels: Labels, n_axes: int, cut: int) -> Array:
    """Return the share of each axis' moving frames that lies before a frame, (n_axes,)."""
    early, length = np.zeros(n_axes), np.zeros(n_axes)
    for (a, b), label in _zip(samples, labels):
        early[label] += max(0, min(b, cut) - a)
        length[label] += b - a
    return np.asarray(early / np.maximum(length, 1))


def halves_disagreement(
    samples: JointSamples, axes: Array, labels: Labels, find: Finder, enough: float = np.inf
) -> Array:
    """Return the largest angle between axes found from two halves, (n_axes,) rad.

    Three ways to halve: every phase cut in its middle; phases dealt out in turn; the recording cut
    in its middle, where both halves hold enough of every movement. NaN if none was possible.
    More than ``enough`` rad ends it.
    """
    worst = np.full(len(axes), np.nan)
    for first, second in _splits(samples, labels, len(axes)):
        pairs = [_matched(find(samples.with_phases(half)), axes) for half in (first, second)]
        # an axis that half of its own movement does not show is no axis: as far off as can be
        worst = np.fmax(worst, np.nan_to_num(_between(*pairs), nan=np.pi / 2))
        if worst.max() > enough:
            break
    return worst


def reasons_to_doubt(
    quality: AxesQuality, axes: Array, nominal: Array | None, positions: Array, s: AxesSettings
) -> list[str]:
    """Return why these are not the axes of main movements, each a clause; or nothing.

    Parameters
    ----------
    quality
        Of ``axes``.
    axes : (n_axes, 3)
    nominal : (n_axes, 3), optional
        Where anatomy has the axes, in the same order.
    positions : (n, 3)
        All of the calibration, at rest and moving.
    s
        The limits.
    """
    doubts: list[str] = []
    if (small := np.rad2deg(quality.ranges.min())) < s.smallest_range:
        doubts.append(
            f"the range of motion about an axis is {small:.0f}°, {s.smallest_range:.0f}° are needed"
        )
    if not np.isfinite(quality.halves).all():
        doubts.append("there is too little movement to compare two halves of it")
    elif np.rad2deg(quality.halves.max()) > 2 * s.largest_uncertainty:
        doubts.append(apart(quality.halves))
    if len(axes) > 1 and quality.explained < s.smallest_explained:
        doubts.append(
            f"rotation about one axis at a time explains only {quality.explained:.0%} "
            "of the movement"
        )
    if len(axes) == 1:
        heights = np.arccos(np.clip(positions @ axes[0], -1, 1))
        spread = float(np.rad2deg(np.sqrt(((heights - np.median(heights)) ** 2).mean())))
        if spread > s.largest_spread:
            doubts.append(f"the limb leaves the cone about its only axis by {spread:.0f}° rms")
    if nominal is not None:
        off = np.arccos(np.clip(np.abs((axes * nominal).sum(axis=1)), 0, 1))
        if (farthest := np.rad2deg(off.max())) > s.farthest:
            doubts.append(f"an axis is {farthest:.0f}° from where this joint can have one")
    for i in range(1, len(axes)):
        for j in range(i):
            angle = np.rad2deg(np.arccos(min(1.0, abs(float(axes[i] @ axes[j])))))
            if angle < s.smallest_angle:
                doubts.append(f"two axes are {angle:.0f}° apart, too close to be two")
    return doubts


def apart(halves: Array) -> str:
    """Return how far axes from two halves differ, (n_axes,) rad, as a clause."""
    return f"axes from two halves of the data differ by {np.rad2deg(halves.max()):.0f}°"


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


def _zip(samples: JointSamples, labels: Labels) -> list[tuple[Phase, int]]:
    return [(phase, int(label)) for phase, label in zip(samples.phases, labels, strict=True)]


def _splits(
    samples: JointSamples, labels: Labels, n_axes: int
) -> list[tuple[tuple[Phase, ...], tuple[Phase, ...]]]:
    phases = samples.phases
    if not phases:
        return []
    splits = [
        (
            tuple((a, (a + b) // 2) for a, b in phases if b - a >= 4),
            tuple(((a + b) // 2, b) for a, b in phases if b - a >= 4),
        )
    ]
    dealt: tuple[list[Phase], list[Phase]] = ([], [])
    turn = [0] * n_axes
    for phase, label in _zip(samples, labels):
        dealt[turn[label] % 2].append(phase)
        turn[label] += 1
    if min(turn) >= 2:
        splits.append((tuple(dealt[0]), tuple(dealt[1])))
    frames = np.concatenate([np.arange(a, b) for a, b in phases])
    cut = int(np.median(frames))
    early = tuple((a, min(b, cut)) for a, b in phases if a < cut - SHORTEST)
    late = tuple((max(a, cut), b) for a, b in phases if b > cut + SHORTEST)
    share = early_share(samples, labels, n_axes, cut)
    if (np.abs(share - 0.5) <= 0.5 - LEAST_SHARE).all():
        splits.append((early, late))
    return splits


def _matched(found: Array, axes: Array) -> Array:
    """Return for each axis the found one closest to it, each used once; NaN where none is left."""
    matched = np.full(axes.shape, np.nan)
    if len(found) == 0:
        return matched
    free = np.abs(axes @ found.T)
    for _ in range(min(free.shape)):
        i, j = np.unravel_index(int(free.argmax()), free.shape)
        matched[i] = found[j]
        free[i, :] = free[:, j] = -1
    return matched
