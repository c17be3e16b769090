"""Axes from one half of the movement beside those from the other."""

from collections.abc import Callable, Iterable

import numpy as np

from kinesphere.data import Array
from kinesphere.geometry.even_frames import parted
from kinesphere.parameterization.arcs import arcs_about, labelled
from kinesphere.parameterization.axes.fit import Labels, phase_swing
from kinesphere.parameterization.samples import JointSamples, Phase

Finder = Callable[[JointSamples], Array]
"""Samples → (n_found, 3) axes: an axis method with its settings bound."""
Searcher = Callable[[JointSamples], tuple[JointSamples, Array]]
"""Samples → those with the phases that count, and (n_found, 3) axes from them."""

LEAST_SHARE = 0.2  # of an axis' frames in each half of the recording, for the halves to be compared
SHORTEST = 4  # frames of a phase that a cut may leave


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


def contradiction(
    halves: Iterable[JointSamples], axes: Array, search: Searcher
) -> tuple[Array, Array, Array]:
    """Return how far axes searched anew in each half of the time are apart, arcs, and purity.

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
    pure : (n_axes,)
        Share of the phases' movement about each axis that is about it, in the half where that is
        less: one in which the limb does all at once tells no axis.
    """
    told, arcs, pure = [], [], []
    for half in halves:
        used, found = search(half) if half.phases else (half, np.empty((0, 3)))
        found = _matched(found, axes)
        known = np.isfinite(found[:, 0])
        told.append(found)
        arcs.append(np.zeros(len(axes)))
        pure.append(np.zeros(len(axes)))
        if known.any():
            swings = [phase_swing(used, phase) for phase in used.phases]
            about = np.array([swing.about(found[known]) for swing in swings])
            labels = about.argmax(axis=1)
            arcs[-1][known] = arcs_about(used, found[known], labels)[0]
            mine = labels[:, None] == np.arange(known.sum())
            total = mine.T @ np.array([(swing.vectors**2).sum() for swing in swings])
            pure[-1][known] = (about * mine).sum(axis=0) / np.maximum(total, 1e-300)
    return _between(told[0], told[1]), np.minimum(arcs[0], arcs[1]), np.minimum(pure[0], pure[1])


def early_share(samples: JointSamples, labels: Labels, n_axes: int, early: int, late: int) -> Array:
    """Return which share of each axis' moving frames in two halves is in the first, (n_axes,).

    The first half ends before the frame ``early``, the second begins with ``late``.
    """
    before, after = np.zeros(n_axes), np.zeros(n_axes)
    for (a, b), label in labelled(samples, labels):
        before[label] += max(0, min(b, early) - a)
        after[label] += max(0, b - max(a, late))
    return np.asarray(before / np.maximum(before + after, 1))


def _splits(
    samples: JointSamples, labels: Labels, n_axes: int
) -> list[tuple[tuple[Phase, ...], tuple[Phase, ...]]]:
    phases = samples.phases
    if not phases:
        return []
    splits = [
        (
            tuple((a, a + parted(b - a)[0]) for a, b in phases if b - a >= 4),
            tuple((a + parted(b - a)[1], b) for a, b in phases if b - a >= 4),
        )
    ]
    if dealt := _dealt(samples, labels, n_axes):
        splits.append(dealt)
    frames = np.concatenate([np.arange(a, b) for a, b in phases])
    if len(frames) <= 2 * SHORTEST:
        return splits
    n_early, first_late = parted(len(frames))
    stop, start = int(frames[n_early - 1]) + 1, int(frames[first_late])
    early = tuple((a, min(b, stop)) for a, b in phases if a < stop - SHORTEST)
    late = tuple((max(a, start), b) for a, b in phases if b > start + SHORTEST)
    share = early_share(samples, labels, n_axes, stop, start)
    if (np.abs(share - 0.5) <= 0.5 - LEAST_SHARE).all():
        splits.append((early, late))
    return splits


def _dealt(
    samples: JointSamples, labels: Labels, n_axes: int
) -> tuple[tuple[Phase, ...], tuple[Phase, ...]] | None:
    """Return the phases of each axis dealt out in turn; None where an axis has but one.

    Of each axis the longer hand goes first: which one starts depends on the direction of time.
    """
    first: list[Phase] = []
    second: list[Phase] = []
    for k in range(n_axes):
        mine = [phase for phase, label in labelled(samples, labels) if label == k]
        if len(mine) < 2:
            return None
        hands = sorted((mine[::2], mine[1::2]), key=_frames_in, reverse=True)
        first += hands[0]
        second += hands[1]
    return tuple(sorted(first)), tuple(sorted(second))


def _frames_in(phases: list[Phase]) -> int:
    return sum(b - a for a, b in phases)


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


def _between(a: Array, b: Array) -> Array:
    """Return the angle between lines, (n, 3) each, (n,) rad; NaN where one is not there."""
    cosines = np.abs((a * b).sum(axis=1))
    return np.asarray(np.arctan2(np.linalg.norm(np.cross(a, b), axis=1), cosines))
