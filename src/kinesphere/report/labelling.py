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
from kinesphere.quality import orient
from kinesphere.report.assets_of import asset, environment
from kinesphere.report.label_facts import LabelFact, is_check, label_facts
from kinesphere.report.moments import runs
from kinesphere.report.notices import notices
from kinesphere.report.wording import counted, number_in_words

STILLS = 3
"""Instants drawn, spread over the recording."""
COLUMNS = 240
"""Cells of the time line."""
_WIDTH, _HEIGHT = 300, 380


@dataclass(frozen=True)
class LabelRow:
    """One label as the table shows it."""

    name: str
    trust: str
    """As `LabelFact` has it."""
    said: str
    confidence: str
    bar: float | None
    """0…100 %; None where nobody looked."""
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
    facts = label_facts(recording)
    counts = _checked_tiles(facts, model) if is_check(recording) else _given_tiles(recording, model)
    tiles = [
        *counts,
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
        check=is_check(recording),
        kept=any(fact.said == "kept" for fact in facts),
        rows=[_row(fact, recording) for fact in facts],
        stills=_stills(recording, model, facts),
        settings=[(k, str(v)) for k, v in step.settings.items()],
        style=Markup(asset("page.css") + asset("labelling.css")),
    )


def _number(value: Any) -> float | None:
    return float(value) if isinstance(value, int | float) else None


def _given_tiles(recording: Recording, model: TopologicalModel) -> list[tuple[str, str, str]]:
    facts = label_facts(recording)
    given, kept = sum(f.trust != "" for f in facts), sum(f.said == "kept" for f in facts)
    loose = recording.n_markers - given
    tiles = [
        ("Labels given", f"{given} of {len(facts)}", f"model {model.name}"),
        (
            "To look at",
            str(sum(f.trust == "poor" for f in facts)),
            "another label fits nearly as well",
        ),
        ("Left unlabelled", str(loose), "ghosts, props, pieces nobody could tell"),
    ]
    if kept:
        tiles.insert(1, ("Kept, not checked", str(kept), "were there already; nobody looked"))
    return tiles


def _checked_tiles(facts: list[LabelFact], model: TopologicalModel) -> list[tuple[str, str, str]]:
    unknown = sum(f.trust == "none" for f in facts)
    return [
        ("Labels checked", f"{len(facts) - unknown} of {len(facts)}", f"model {model.name}"),
        ("To look at", str(sum(f.trust == "poor" for f in facts)), "another label fits better"),
        ("Not judged", str(unknown), "right or wrong, nobody knows: too still, short or alike"),
    ]


def _row(fact: LabelFact, recording: Recording) -> LabelRow:
    if fact.column < 0:
        return LabelRow(fact.name, "", fact.said, "–", None, "–", "–", Markup(""))
    seen = recording.seen[:, fact.column]
    holes = runs(~seen)
    longest = max((b - a for a, b in holes), default=0) / recording.rate
    sure = fact.confidence
    return LabelRow(
        fact.marker,
        fact.trust,
        fact.said,
        "–" if np.isnan(sure) else f"{sure:.2f}",
        None if np.isnan(sure) else 100 * sure,
        f"{seen.mean():.1%}" if seen.mean() < 1 else "all",
        f"{len(holes)}, longest {number_in_words(longest, 's')}" if holes else "none",
        _cells(seen),
    )


def _cells(seen: np.ndarray) -> Markup:
    """Return where a label is seen over time as a strip."""
    edges = np.linspace(0, len(seen), min(COLUMNS, len(seen)) + 1).astype(int)
    share = np.array([seen[a:b].mean() for a, b in pairwise(edges)])
    parts = [f'<rect x="{a}" y="0" width="{b - a}" height="8"/>' for a, b in runs(share >= 0.5)]
    return Markup(
        f'<svg class="strip" viewBox="0 0 {len(share)} 8" preserveAspectRatio="none" '
        f'aria-hidden="true">{"".join(parts)}</svg>'
    )


def _stills(
    recording: Recording, model: TopologicalModel, facts: list[LabelFact]
) -> list[dict[str, Any]]:
    """Return drawings of the body with its labels, from the front and from the side."""
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
