"""Axes from one half of the movement beside those from the other."""

from collections.abc import Callable, Iterable

import numpy as np

from kinesphere.data import Array
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
            arcs[-1][known] = arcs_about(used, found[known], labels)[0]
    return _between(told[0], told[1]), np.minimum(arcs[0], arcs[1])


def early_share(samples: JointSamples, labels: Labels, n_axes: int, cut: int) -> Array:
    """Return the share of each axis' moving frames that lies before a frame, (n_axes,)."""
    early, length = np.zeros(n_axes), np.zeros(n_axes)
    for (a, b), label in labelled(samples, labels):
        early[label] += max(0, min(b, cut) - a)
        length[label] += b - a
    return np.asarray(early / np.maximum(length, 1))


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
    for phase, label in labelled(samples, labels):
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


def _between(a: Array, b: Array) -> Array:
    """Return the angle between lines, (n, 3) each, (n,) rad; NaN where one is not there."""
    cosines = np.abs((a * b).sum(axis=1))
    return np.asarray(np.arctan2(np.linalg.norm(np.cross(a, b), axis=1), cosines))
