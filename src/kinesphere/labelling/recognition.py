"""The body recognised in windows that show most of it, and again with what has been labelled."""

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from kinesphere.data import Array, TopologicalModel
from kinesphere.labelling.labelled import Labelled, give, length_of, take
from kinesphere.labelling.matching import Labeller, Match, nothing
from kinesphere.labelling.pair_statistics import match_pair_statistics
from kinesphere.labelling.runs import Track, points_of

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
LASTING = 0.15
"""Share of the recording that a track without label must last to be looked at then: pieces of one
marker that are never seen together look like two."""


def recognised(
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
    stretches = [] if whole and long.all() else windows_of(state.tracks, n_frames, rate, n_labels)
    if whole:
        stretches.append((0, n_frames, list(range(len(state.tracks)))))
    found: list[_Seen] = []
    refusal = ""
    for start, end, columns in stretches:
        points = points_of(markers, [state.tracks[k] for k in columns])[start:end]
        match = labeller(points, model)
        sure = (match.labels >= 0) & (match.confidence >= least_confidence)
        worth = float(sure.sum()) * (match.fit if np.isfinite(match.fit) else 1.0)
        if len(stretches) == 1 or not match.note:
            found.append(_Seen(worth, match, columns, (start / rate, end / rate)))
        else:
            refusal = refusal or match.note
    if not found:
        return nothing(0, refusal or "at no time can enough of the body be seen at once"), []
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
        told, labels = np.array(one.columns, dtype=np.intp)[given], one.match.labels[given]
        held = evidence[told].max(axis=1) > 0
        same = evidence[told].argmax(axis=1) == labels
        if one is not best and (not held.any() or same[held].mean() < AGREEING):
            continue
        evidence[told, labels] -= np.log1p(-np.minimum(one.match.confidence[given], SUREST))
        used.append(one)
    state.windows_s += sorted(one.window_s for one in used)
    columns = sorted({k for one in used for k in one.columns})
    ranked = np.sort(evidence[columns], axis=1)
    lead = ranked[:, -1] - (ranked[:, -2] if n_labels > 1 else 0.0)
    lead[~np.isin(columns, best.columns) & (lead < ALONE)] = 0.0
    labels = np.where(lead > 0, evidence[columns].argmax(axis=1), -1)
    return replace(best.match, labels=labels, confidence=1 - np.exp(-lead)), columns


def windows_of(
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


def recognise_again(
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
    loose = [k for k, of in enumerate(state.labels) if of < 0 and length_of(state, k) >= least]
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
        take(state, k)
    # the longest first: where two claim a label, the longer one is the safer
    claims = [(k, into[before[k][0]], before[k][1]) for k in moved] + [
        (k, int(new[len(held) + i]), float(match.confidence[len(held) + i]))
        for i, k in enumerate(loose)
    ]
    for k, label, c in sorted(claims, key=lambda claim: (-length_of(state, claim[0]), claim[0])):
        if label >= 0:
            give(state, markers, k, label, c)
    return bool(changed)
