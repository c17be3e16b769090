"""Drawings of the body with its labels, coloured by how sure they are."""

from typing import Any

import numpy as np
from markupsafe import Markup, escape
from scipy.sparse.csgraph import minimum_spanning_tree

from kinesphere.data import Array, Recording, TopologicalModel
from kinesphere.errors import KinesphereError
from kinesphere.quality import orient
from kinesphere.report.label_facts import LabelFact

STILLS = 3
"""Instants drawn, spread over the recording."""
_WIDTH, _HEIGHT = 300, 380


def stills(
    recording: Recording, model: TopologicalModel, facts: list[LabelFact]
) -> list[dict[str, Any]]:
    """Return drawings of the body with its labels: ``time`` and ``svg`` of each."""
    try:
        upright = orient(recording, model)
    except KinesphereError:
        upright = recording
    borne = sorted((fact for fact in facts if fact.column >= 0), key=lambda fact: fact.column)
    if len(borne) < 4:
        return []
    seen = upright.seen[:, [fact.column for fact in borne]].sum(axis=1)
    drawn = []
    for part in np.array_split(np.arange(upright.n_frames), min(STILLS, upright.n_frames)):
        frame = int(part[seen[part].argmax()])
        if seen[frame] >= 4:
            drawn.append(
                {
                    "time": f"{frame / upright.rate:.2f} s",
                    "svg": _drawing(upright, model, borne, frame),
                }
            )
    return drawn


def _drawing(
    recording: Recording, model: TopologicalModel, facts: list[LabelFact], frame: int
) -> Markup:
    """Return one instant, seen across the widest horizontal extent of the body."""
    points = recording.markers[frame, [fact.column for fact in facts]]
    known = np.isfinite(points[:, 0])
    flat = points[known][:, [0, 2]] - points[known][:, [0, 2]].mean(axis=0)
    _, _, axes = np.linalg.svd(flat, full_matrices=False)
    x = (points[:, [0, 2]] - points[known][:, [0, 2]].mean(axis=0)) @ axes[0]
    y = points[:, 1]
    low, high = np.nanmin(y), np.nanmax(y)
    scale = min((_HEIGHT - 60) / max(high - low, 1e-3), (_WIDTH - 90) / max(np.ptp(x[known]), 1e-3))
    px = _WIDTH / 2 + scale * (x - (np.nanmin(x) + np.nanmax(x)) / 2)
    py = _HEIGHT - 30 - scale * (y - low)
    names = [fact.name for fact in facts]
    parts = [
        f'<line x1="{px[a]:.1f}" y1="{py[a]:.1f}" x2="{px[b]:.1f}" y2="{py[b]:.1f}"/>'
        for a, b in _sticks(model, names, points)
    ]
    for i, name in enumerate(names):
        if not known[i]:
            continue
        left = px[i] < _WIDTH / 2
        parts.append(
            f'<circle class="{facts[i].trust}" cx="{px[i]:.1f}" cy="{py[i]:.1f}" r="3.2"/>'
            f'<text x="{px[i] + (-6 if left else 6):.1f}" y="{py[i] + 3:.1f}" '
            f'text-anchor="{"end" if left else "start"}">{escape(name)}</text>'
        )
    return Markup(
        f'<svg class="still" viewBox="0 0 {_WIDTH} {_HEIGHT}" role="img" '
        f'aria-label="Labelled markers">{"".join(parts)}</svg>'
    )


def _sticks(model: TopologicalModel, names: list[str], points: Array) -> list[tuple[int, int]]:
    """Return which markers to join: the shortest tree within each segment."""
    at = {name: i for i, name in enumerate(names) if np.isfinite(points[i, 0])}
    found = []
    for segment in model.segments:
        own = [at[x] for x in (*segment.markers, *segment.shared) if x in at]
        if len(own) < 2:
            continue
        some = points[own]
        tree = minimum_spanning_tree(np.linalg.norm(some[:, None] - some, axis=2)).tocoo()
        found += [(own[a], own[b]) for a, b in zip(tree.row, tree.col, strict=True)]
    return found
