"""One HTML page that shows which labels were given, how surely, and where to look."""

from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
from markupsafe import Markup

import kinesphere
from kinesphere.data import Recording, TopologicalModel
from kinesphere.report.assets_of import asset, environment
from kinesphere.report.label_drawing import stills
from kinesphere.report.label_facts import LabelFact, is_check, label_facts
from kinesphere.report.moments import runs
from kinesphere.report.notices import notices
from kinesphere.report.wording import counted, number_in_words

COLUMNS = 240
"""Cells of the time line."""


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
        stills=stills(recording, model, facts),
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
        ("Not judged", str(unknown), "may be right or wrong: too still, short or alike"),
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
