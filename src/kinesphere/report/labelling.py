"""One HTML page that shows which labels were given, how surely, and where to look."""

from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
from markupsafe import Markup, escape
from scipy.sparse.csgraph import minimum_spanning_tree

import kinesphere
from kinesphere.data import Array, Recording, TopologicalModel
from kinesphere.errors import KinesphereError
from kinesphere.labelling.findings import said_of
from kinesphere.quality import orient
from kinesphere.report.assets_of import asset, environment
from kinesphere.report.moments import runs
from kinesphere.report.notices import notices
from kinesphere.report.wording import counted, number_in_words

STILLS = 3
"""Instants drawn, spread over the recording."""
COLUMNS = 240
"""Cells of the time line."""
_TRUST = {"sure": "good", "likely": "fair", "look": "poor"}
_WIDTH, _HEIGHT = 300, 380


@dataclass(frozen=True)
class LabelRow:
    """One label as the table shows it."""

    name: str
    trust: str
    """``good``, ``fair``, ``poor``, or empty where it was not given."""
    said: str
    confidence: str
    bar: float
    """0…100 %."""
    share: str
    gaps: str
    cells: Markup
    """Its line of the time line, an SVG."""


def labelling_html(recording: Recording, model: TopologicalModel, title: str = "") -> str:
    """Return the report of a labelled recording as one self-contained HTML page.

    Parameters
    ----------
    recording
        As ``kinesphere.label`` returns it: its last step says what was found.
    model
        The one it was labelled by.
    title
        A name for the recording.
    """
    step = recording.history[-1]
    found = step.findings
    rows = _rows(recording, model)
    loose = sum(
        not np.isfinite(c)
        for c in (recording.confidence if recording.confidence is not None else [])
    )
    given = sum(row.trust != "" for row in rows)
    tiles = [
        ("Labels given", f"{given} of {len(rows)}", f"model {model.name}"),
        (
            "To look at",
            str(sum(row.trust == "poor" for row in rows)),
            "another label fits nearly as well",
        ),
        ("Left unlabelled", str(loose), "ghosts, props, pieces nobody could tell"),
        (
            "Fit",
            number_in_words(_number(found.get("fit_nats_a_pair"))),
            "nats a pair better than chance; 1 and more is usual",
        ),
        (
            "Recording",
            f"{recording.n_frames / recording.rate:.1f} s",
            f"{counted(recording.n_frames, 'frame')} at {recording.rate:g} Hz",
        ),
    ]
    page = environment().from_string(asset("labelling.html.j2"))
    return page.render(
        title=title or "Labelled recording",
        version=kinesphere.__version__,
        tiles=tiles,
        warnings=notices(step.warnings),
        rows=rows,
        stills=_stills(recording, model),
        settings=[(k, str(v)) for k, v in step.settings.items()],
        style=Markup(asset("page.css") + asset("labelling.css")),
    )


def _number(value: Any) -> float | None:
    return float(value) if isinstance(value, int | float) else None


def _rows(recording: Recording, model: TopologicalModel) -> list[LabelRow]:
    """Return a row a label, those to look at first."""
    at = {name: i for i, name in enumerate(recording.labels)}
    table = recording.history[-1].findings.get("labels")
    known = list(table) if isinstance(table, dict) else [x for x in model.labels if x in at]
    rows = []
    for name in known:
        column = at.get(name)
        if column is None or not recording.seen[:, column].any():
            rows.append((-1.0, LabelRow(name, "", "not given", "–", 0.0, "–", "–", Markup(""))))
            continue
        sure = np.nan if recording.confidence is None else float(recording.confidence[column])
        seen = recording.seen[:, column]
        kept = np.isnan(sure)
        said = "kept" if kept else said_of(sure)
        trust = _TRUST.get(said, "good")
        holes = runs(~seen)
        longest = max((b - a for a, b in holes), default=0) / recording.rate
        rows.append(
            (
                1.0 if kept else sure,
                LabelRow(
                    name,
                    trust,
                    said,
                    "–" if kept else f"{sure:.2f}",
                    100.0 if kept else 100 * sure,
                    f"{seen.mean():.1%}" if seen.mean() < 1 else "all",
                    f"{len(holes)}, longest {number_in_words(longest, 's')}" if holes else "none",
                    _cells(seen),
                ),
            )
        )
    return [row for _, row in sorted(rows, key=lambda item: item[0])]


def _cells(seen: np.ndarray) -> Markup:
    """Return where a label is seen over time as a strip."""
    edges = np.linspace(0, len(seen), min(COLUMNS, len(seen)) + 1).astype(int)
    share = np.array([seen[a:b].mean() for a, b in pairwise(edges)])
    parts = [f'<rect x="{a}" y="0" width="{b - a}" height="8"/>' for a, b in runs(share >= 0.5)]
    return Markup(
        f'<svg class="strip" viewBox="0 0 {len(share)} 8" preserveAspectRatio="none" '
        f'aria-hidden="true">{"".join(parts)}</svg>'
    )


def _stills(recording: Recording, model: TopologicalModel) -> list[dict[str, Any]]:
    """Return drawings of the body with its labels, from the front and from the side."""
    try:
        upright = orient(recording, model)
    except KinesphereError:
        upright = recording
    columns = [i for i, name in enumerate(upright.labels) if name in set(model.labels)]
    if len(columns) < 4:
        return []
    seen = upright.seen[:, columns].sum(axis=1)
    drawn = []
    for part in np.array_split(np.arange(upright.n_frames), min(STILLS, upright.n_frames)):
        frame = int(part[seen[part].argmax()])
        if seen[frame] >= 4:
            drawn.append(
                {
                    "time": f"{frame / upright.rate:.2f} s",
                    "svg": _drawing(upright, model, columns, frame),
                }
            )
    return drawn


def _drawing(
    recording: Recording, model: TopologicalModel, columns: list[int], frame: int
) -> Markup:
    """Return one instant, seen across the widest horizontal extent of the body."""
    points = recording.markers[frame, columns]
    known = np.isfinite(points[:, 0])
    flat = points[known][:, [0, 2]] - points[known][:, [0, 2]].mean(axis=0)
    _, _, axes = np.linalg.svd(flat, full_matrices=False)
    x = (points[:, [0, 2]] - points[known][:, [0, 2]].mean(axis=0)) @ axes[0]
    y = points[:, 1]
    low, high = np.nanmin(y), np.nanmax(y)
    scale = min((_HEIGHT - 60) / max(high - low, 1e-3), (_WIDTH - 90) / max(np.ptp(x[known]), 1e-3))
    px = _WIDTH / 2 + scale * (x - (np.nanmin(x) + np.nanmax(x)) / 2)
    py = _HEIGHT - 30 - scale * (y - low)
    names = [recording.labels[c] for c in columns]
    parts = [
        f'<line x1="{px[a]:.1f}" y1="{py[a]:.1f}" x2="{px[b]:.1f}" y2="{py[b]:.1f}"/>'
        for a, b in _sticks(model, names, points)
    ]
    sure = recording.confidence
    for i, name in enumerate(names):
        if not known[i]:
            continue
        c = np.nan if sure is None else sure[columns[i]]
        trust = "good" if np.isnan(c) else _TRUST[said_of(c)]
        left = px[i] < _WIDTH / 2
        parts.append(
            f'<circle class="{trust}" cx="{px[i]:.1f}" cy="{py[i]:.1f}" r="3.2"/>'
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
