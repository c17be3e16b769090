"""Labels for raw captures: broken trajectories, hidden markers, ghosts, swapped identities.

Pieces are joined into tracks, a window that shows most of the body at once is labelled by the
statistics of other people, and from there on the person's own distances label the rest, backwards
and forwards in time. A track that stops fitting its label is cut.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Array, TopologicalModel
from kinesphere.labelling.matching import Labeller, Match, nothing
from kinesphere.labelling.own_distances import OwnDistances, costs_of, own_distances
from kinesphere.labelling.pair_statistics import match_pair_statistics
from kinesphere.labelling.runs import Run, Track, points_of, runs_of, tracks_of

WINDOWS_S = (16.0, 8.0, 4.0)
"""s, lengths of the windows tried: the longer, the more motion; the shorter, the more is whole."""
LONGER = 0.75
"""Tracks that a window twice as long is worth."""
COVERED = 0.5
"""Share of a window that a track must fill to be looked at there."""
TRIED = 5
"""Windows labelled; the one whose labels fit best, and most, counts."""
AGREEING = 0.8
"""Share of the tracks that two windows share whose labels must agree for both to count."""
ALONE = 0.7
"""Evidence that a track needs which the best window does not show: its labels are checked least."""
SUREST = 0.999
"""Confidence that one window counts at most."""
WHOLE = 1.5
"""Tracks a label up to which a recording counts as whole, and is labelled in one piece."""
FITS = (2.0, 5.5)
"""Mean square deviation up to which a piece keeps a label's distances: 1 is usual, strangers have
6 to 9. The second is for the end, when the distances are known from all movement."""
USUAL = 3.0
"""Mean square deviation up to which a block fits another label."""
CLEAR = (2.0, 1.5)
"""How much worse the next label must fit, in the same terms."""
BLOCK_S = 0.1
"""s, length of the blocks in which a labelled track is checked."""
FOREIGN = 6.0
"""Mean square deviation from which on a block does not belong to its label, if it fits another:
a movement not made before is as far from a label's own distances, but fits no other ones."""
ROUNDS = 4
"""Most times the body is recognised anew with what has been labelled so far."""
LASTING = 0.15
"""Share of the recording that a track without label must last to be looked at then: pieces of one
marker that are never seen together look like two."""
SWEEPS = 40
"""Most rounds of labelling what has become decidable."""


@dataclass
class Labelled:
    """Tracks with their labels: work in progress."""

    points: Array
    """(n_frames, n_labels, 3) m, what is labelled so far."""
    tracks: list[Track]
    labels: list[int]
    """Of each track, −1 for none."""
    confidence: list[float]
    fit: float = float("nan")
    cut: int = 0
    """Tracks cut because they stopped fitting."""
    windows_s: list[tuple[float, float]] = field(default_factory=list)
    """Start and end of the windows in which the body was recognised."""
    notes: list[str] = field(default_factory=list)


def label_through_time(
    markers: Array,
    rate: float,
    model: TopologicalModel,
    labeller: Labeller,
    *,
    keep_columns: bool,
    least_confidence: float,
    seeds: Mapping[int, int] | None = None,
) -> Labelled:
    """Label every piece of trajectory that can be told.

    Parameters
    ----------
    markers : (n_frames, n_columns, 3) m
        NaN where not seen.
    rate
        Hz.
    labeller
        What recognises the body in a window.
    keep_columns
        Whether a column is one marker wherever it is seen.
    least_confidence
        Labels of the window that are less sure are not given.
    seeds
        Column → label of those that are known already, and stay.
    """
    n_labels = len(model.labels)
    seeds = {} if seeds is None else seeds
    tracks = _tracks(markers, rate, seeds, keep_columns)
    state = Labelled(
        np.full((len(markers), n_labels, 3), np.nan),
        tracks,
        [-1] * len(tracks),
        [0.0] * len(tracks),
    )
    for k, track in enumerate(tracks):
        if track and track[0].column in seeds:
            _give(state, markers, k, seeds[track[0].column], 1.0)
    match, columns = _recognised(markers, rate, state, model, labeller, least_confidence)
    state.fit = match.fit
    if match.note:
        state.notes.append(match.note)
    order = np.argsort(-match.confidence, kind="stable")
    for k, label, sure in zip(
        np.array(columns, dtype=np.intp)[order],
        match.labels[order],
        match.confidence[order],
        strict=True,
    ):
        if label >= 0 and sure >= least_confidence and state.labels[k] < 0:
            _give(state, markers, int(k), int(label), float(sure))
    fixed = {k for k, track in enumerate(tracks) if track[0].column in seeds}
    for _ in range(ROUNDS):
        before = sum(label >= 0 for label in state.labels)
        if not before:
            return state
        _propagate(state, markers, rate, fixed, late=False)
        if not _recognise_again(state, markers, model, least_confidence, fixed):
            break
    _propagate(state, markers, rate, fixed, late=True)
    return state


def _tracks(
    markers: Array, rate: float, seeds: Mapping[int, int], keep_columns: bool
) -> list[Track]:
    """Return the tracks; a column whose label is known is one track."""
    if keep_columns or not seeds:
        return tracks_of(markers, rate, keep_columns=keep_columns)
    hidden = markers.copy()
    hidden[:, list(seeds)] = np.nan
    known = np.full_like(markers, np.nan)
    known[:, list(seeds)] = markers[:, list(seeds)]
    return [
        *tracks_of(known, rate, keep_columns=True),
        *tracks_of(hidden, rate, keep_columns=False),
    ]


def _propagate(
    state: Labelled, markers: Array, rate: float, fixed: set[int], *, late: bool
) -> None:
    """Label by the person's own distances whatever can be, cutting what stops fitting."""
    own = own_distances(state.points)
    _cut_foreign(state, markers, rate, own, fixed)
    for sweep in range(SWEEPS):
        if not _sweep(state, markers, own, fixed, late=late):
            break
        if sweep % 3 == 2:
            own = own_distances(state.points)
    own = own_distances(state.points)
    if _cut_foreign(state, markers, rate, own, fixed):
        for _ in range(SWEEPS):
            if not _sweep(state, markers, own, fixed, late=late):
                break


def _recognise_again(
    state: Labelled,
    markers: Array,
    model: TopologicalModel,
    least_confidence: float,
    fixed: set[int],
) -> bool:
    """Recognise the body once more: what has a label as one point each, beside long tracks.

    They start from the labels they have. A label may go to another point as a whole, and markers
    that the first window did not show come in. Return whether anything changed.
    """
    held = sorted({label for label in state.labels if label >= 0})
    least = LASTING * len(markers)
    loose = [k for k, of in enumerate(state.labels) if of < 0 and _length(state, k) >= least]
    points = np.concatenate(
        [state.points[:, held], points_of(markers, [state.tracks[k] for k in loose])], axis=1
    )
    start = np.array([*held, *([-1] * len(loose))], dtype=np.int64)
    match = match_pair_statistics(points, model, start)
    if match.note:
        return False
    state.fit = match.fit
    sure = match.confidence >= least_confidence
    new = np.where(sure, match.labels, -1)
    into = dict(zip(held, new[: len(held)].tolist(), strict=True))
    before = list(zip(state.labels, state.confidence, strict=True))
    changed = any(old != label for old, label in into.items()) or (new[len(held) :] >= 0).any()
    moved = [k for k, (of, _) in enumerate(before) if of >= 0 and into[of] != of and k not in fixed]
    for k in moved:
        _take(state, k)
    # the longest first: where two claim a label, the longer one is the safer
    claims = [(k, into[before[k][0]], before[k][1]) for k in moved] + [
        (k, int(new[len(held) + i]), float(match.confidence[len(held) + i]))
        for i, k in enumerate(loose)
    ]
    for k, label, c in sorted(claims, key=lambda claim: (-_length(state, claim[0]), claim[0])):
        if label >= 0:
            _give(state, markers, k, label, c)
    return bool(changed)


def _recognised(
    markers: Array,
    rate: float,
    state: Labelled,
    model: TopologicalModel,
    labeller: Labeller,
    least_confidence: float,
) -> tuple[Match, list[int]]:
    """Return the best match, and the tracks it is about."""
    n_frames, n_labels = len(markers), len(model.labels)
    lengths = np.array([sum(r.end - r.start for r in track) for track in state.tracks])
    if not len(lengths):
        return nothing(0, "no marker is ever seen"), []
    long = lengths >= COVERED * n_frames
    whole = len(lengths) <= WHOLE * n_labels + 4 and 2 * long.sum() >= min(n_labels, len(lengths))
    stretches = [] if long.all() else _windows(state.tracks, n_frames, rate, n_labels)
    if whole:
        stretches.append((0, n_frames, list(range(len(state.tracks)))))
    found: list[_Seen] = []
    for start, end, columns in stretches:
        points = points_of(markers, [state.tracks[k] for k in columns])[start:end]
        match = labeller(points, model)
        sure = (match.labels >= 0) & (match.confidence >= least_confidence)
        worth = float(sure.sum()) * (match.fit if np.isfinite(match.fit) else 1.0)
        if len(stretches) == 1 or not match.note:
            found.append(_Seen(worth, match, columns, (start / rate, end / rate)))
    if not found:
        return nothing(0, "at no time can enough of the body be seen at once"), []
    return _agreed(found, state, n_labels)


class _Seen(NamedTuple):
    """The body, as one window shows it."""

    worth: float
    match: Match
    columns: list[int]
    """The tracks it is about."""
    window_s: tuple[float, float]


def _agreed(found: list[_Seen], state: Labelled, n_labels: int) -> tuple[Match, list[int]]:
    """Return what the best window says, and those that agree with it on the tracks they share."""
    found = sorted(found, key=lambda one: -one.worth)
    best = found[0]
    evidence = np.zeros((len(state.tracks), n_labels))
    used = []
    for one in found:
        given = one.match.labels >= 0
        columns, labels = np.array(one.columns, dtype=np.intp)[given], one.match.labels[given]
        held = evidence[columns].max(axis=1) > 0
        same = evidence[columns].argmax(axis=1) == labels
        if one is not best and (not held.any() or same[held].mean() < AGREEING):
            continue
        evidence[columns, labels] -= np.log1p(-np.minimum(one.match.confidence[given], SUREST))
        used.append(one)
    state.windows_s += sorted(one.window_s for one in used)
    columns = sorted({k for one in used for k in one.columns})
    ranked = np.sort(evidence[columns], axis=1)
    lead = ranked[:, -1] - (ranked[:, -2] if n_labels > 1 else 0.0)
    lead[~np.isin(columns, best.columns) & (lead < ALONE)] = 0.0
    labels = np.where(lead > 0, evidence[columns].argmax(axis=1), -1)
    return replace(best.match, labels=labels, confidence=1 - np.exp(-lead)), columns


def _windows(
    tracks: list[Track], n_frames: int, rate: float, n_labels: int
) -> list[tuple[int, int, list[int]]]:
    """Return the windows that show most of a body, the best first."""
    seen = np.zeros((len(tracks), n_frames + 1), dtype=np.int32)
    for k, track in enumerate(tracks):
        for run in track:
            seen[k, run.start + 1 : run.end + 1] = 1
    total = np.cumsum(seen, axis=1)
    found = []
    lengths = {min(n_frames, max(2, round(length_s * rate))) for length_s in WINDOWS_S}
    for n in sorted(lengths, reverse=True):
        step = max(1, n // 4)
        for start in range(0, n_frames - n + 1, step):
            share = (total[:, start + n] - total[:, start]) / n
            columns = np.flatnonzero(share >= COVERED).tolist()
            count = min(len(columns), n_labels)
            worth = count + LONGER * np.log2(n / rate)
            if len(columns) >= 4:
                found.append((-worth, start, start + n, columns))
    chosen: list[tuple[int, int, list[int]]] = []
    for _, start, end, columns in sorted(found):
        clash = sum(min(end, b) - max(start, a) > (end - start) // 2 for a, b, _ in chosen)
        if not clash:
            chosen.append((start, end, columns))
        if len(chosen) == TRIED:
            break
    return chosen


def _give(state: Labelled, markers: Array, track: int, label: int, sure: float) -> None:
    """Let a track bear a label, where nobody else does."""
    kept = []
    for run in state.tracks[track]:
        place = state.points[run.start : run.end, label]
        if np.isfinite(place[:, 0]).any():
            continue
        place[:] = markers[run.start : run.end, run.column]
        kept.append(run)
    rest = tuple(run for run in state.tracks[track] if run not in kept)
    if not kept:
        return
    if rest:
        state.tracks.append(rest)
        state.labels.append(-1)
        state.confidence.append(0.0)
    state.tracks[track] = tuple(kept)
    state.labels[track] = label
    state.confidence[track] = sure


def _take(state: Labelled, track: int) -> None:
    """Take a track's label away."""
    for run in state.tracks[track]:
        state.points[run.start : run.end, state.labels[track]] = np.nan
    state.labels[track] = -1
    state.confidence[track] = 0.0


def _frames(track: Track) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Return frames and columns of a track, sampled where it is long."""
    frames = np.concatenate([np.arange(r.start, r.end) for r in track])
    columns = np.concatenate([np.full(r.end - r.start, r.column) for r in track])
    return frames, columns


def _sweep(
    state: Labelled, markers: Array, own: OwnDistances, fixed: set[int], *, late: bool
) -> bool:
    """Label all tracks that have become decidable; return whether there were any."""
    offers: list[tuple[float, float, int, int]] = []
    for k, track in enumerate(state.tracks):
        if state.labels[k] >= 0:
            continue
        frames, columns = _frames(track)
        cost, width = costs_of(markers[frames, columns], frames, state.points, own)
        taken = _blocked(state, k, frames, fixed)
        known = np.isfinite(cost)
        if not known.any():
            continue
        cost = np.where(known, cost, np.inf)
        score = np.where(known, cost + width, np.inf)
        free = np.where(taken | (cost > FITS[late]), np.inf, score)
        label = int(free.argmin())
        if not np.isfinite(free[label]):
            continue
        # a taken label still competes: what fits it best is a copy of it, no other marker
        lead = np.where(taken & late, score + CLEAR[late], score)
        second = float(np.delete(lead, label).min(initial=np.inf))
        if second < free[label] + CLEAR[late]:
            continue
        offers.append((float(free[label]), second, k, label))
    given = False
    for cost_, second, k, label in sorted(offers):
        before = state.labels[k]
        for other in _overlapping(state, k, label):
            if other not in fixed and _length(state, other) < _length(state, k):
                _take(state, other)
        _give(state, markers, k, label, 1 - float(np.exp(-(second - cost_) / 2)))
        given = given or state.labels[k] != before
    return given


def _length(state: Labelled, k: int) -> int:
    return sum(run.end - run.start for run in state.tracks[k])


def _overlapping(state: Labelled, k: int, label: int) -> list[int]:
    """Return the tracks with this label that are there while track k is."""
    return [
        other
        for other, of in enumerate(state.labels)
        if of == label
        and any(
            a.start < b.end and b.start < a.end
            for a in state.tracks[other]
            for b in state.tracks[k]
        )
    ]


def _blocked(
    state: Labelled, k: int, frames: NDArray[np.intp], fixed: set[int]
) -> NDArray[np.bool_]:
    """Return which labels track k cannot have: something longer has them at the same time."""
    blocked = np.array(np.isfinite(state.points[frames, :, 0]).any(axis=0))
    for label in np.flatnonzero(blocked):
        rivals = _overlapping(state, k, int(label))
        longer = [o in fixed or _length(state, o) >= _length(state, k) for o in rivals]
        blocked[label] = not rivals or any(longer)
    return blocked


def _cut_foreign(
    state: Labelled, markers: Array, rate: float, own: OwnDistances, fixed: set[int]
) -> bool:
    """Cut labelled tracks where they stop fitting; return whether any was cut."""
    block = max(2, round(BLOCK_S * rate))
    cut = False
    for k in range(len(state.tracks)):
        label = state.labels[k]
        if label < 0 or k in fixed:
            continue
        track = state.tracks[k]
        bad: list[Run] = []
        for run in track:
            edges = np.r_[np.arange(run.start, run.end, block), run.end]
            foreign = []
            for a, b in pairwise(edges):
                frames = np.arange(a, b)
                cost, _ = costs_of(markers[frames, run.column], frames, state.points, own)
                others = np.delete(np.where(np.isnan(cost), np.inf, cost), label)
                better = others.min(initial=np.inf) <= 3.0
                foreign.append(bool(cost[label] > FOREIGN and better))
            bad += [
                Run(run.column, int(edges[r.start]), int(edges[r.end]))
                for r in runs_of(np.array(foreign)[:, None])
            ]
        if not bad:
            continue
        if sum(r.end - r.start for r in bad) > 0.5 * sum(r.end - r.start for r in track):
            _take(state, k)
            continue
        cut = True
        state.cut += 1
        state.tracks[k] = tuple(_without(track, bad))
        for run in bad:
            state.points[run.start : run.end, label] = np.nan
            state.tracks.append((run,))
            state.labels.append(-1)
            state.confidence.append(0.0)
    return cut


def _without(track: Track, bad: list[Run]) -> list[Run]:
    """Return what is left of a track."""
    kept = []
    for run in track:
        edge = run.start
        for hole in sorted(
            (r for r in bad if run.start <= r.start < run.end and r.column == run.column),
            key=lambda r: r.start,
        ):
            if hole.start > edge:
                kept.append(Run(run.column, edge, hole.start))
            edge = hole.end
        if run.end > edge:
            kept.append(Run(run.column, edge, run.end))
    return kept
