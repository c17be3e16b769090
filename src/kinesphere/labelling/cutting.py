"""Tracks cut where they stop fitting their label: two markers were exchanged there."""

from itertools import pairwise

import numpy as np

from kinesphere.data import Array
from kinesphere.labelling.labelled import Labelled, take
from kinesphere.labelling.own_distances import OwnDistances, costs_of
from kinesphere.labelling.runs import Run, Track, runs_of

USUAL = 3.0
"""Mean square deviation up to which a block fits another label."""
BLOCK_S = 0.1
"""s, length of the blocks in which a labelled track is checked."""
FOREIGN = 6.0
"""Mean square deviation from which on a block does not belong to its label, if it fits another:
a movement not made before is as far from a label's own distances, but fits no other ones."""


def cut_foreign(
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
                better = others.min(initial=np.inf) <= USUAL
                foreign.append(bool(cost[label] > FOREIGN and better))
            bad += [
                Run(run.column, int(edges[r.start]), int(edges[r.end]))
                for r in runs_of(np.array(foreign)[:, None])
            ]
        if not bad:
            continue
        if sum(r.end - r.start for r in bad) > 0.5 * sum(r.end - r.start for r in track):
            take(state, k)
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
