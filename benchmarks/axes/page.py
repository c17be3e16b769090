"""All sections as one page."""

from collections.abc import Sequence
from typing import Any

from benchmarks.axes import (
    angles,
    bends,
    doubts,
    estimators,
    filters,
    free_motion,
    free_served,
    halves_alone,
    normalization,
    one_wide,
    outlying,
    papers_metrics,
    repeatability,
    same_person,
    segments,
    third_axis,
    times,
    vendor,
)
from benchmarks.axes.bars import Bar

INTRODUCTION = """\
# Normalization and parameterization, step by step

Written by `python -m benchmarks.axes`; every figure is in `benchmarks/results/axes.json`.

Each step of Sar Dessai, Hornung & Kobbelt (2006) is measured by itself: against joints whose axes,
angles and rest are known, and on real recordings by what they cannot contradict. Rows in *italics*
are not from here: the paper's published figures, or those of an earlier prototype.

The known joints: 50 Hz, a limb that stands and sways by 0.3°, then moves four times to both sides
about one axis (±45°) and four times about the other (±40°) within a minute. Noise is a rotation
about all three axes: *iid* anew in every frame, *OU* correlated over 0.4 s as soft tissue is,
*tissue* OU 1° and a tenth of the angle coming back about a random axis 60 ms late.
"""


def all_bars(found: dict[str, Any]) -> list[Bar]:
    """Return every figure that is held to a number."""
    return [
        *filters.bars(found["filter"]),
        *estimators.bars(found["axes"]),
        *free_motion.bars(found["free"]),
        *angles.bars(found["angles"]),
        *normalization.bars(found["normalization"]),
        *papers_metrics.bars(found["paper"]),
        *repeatability.bars(found["halves"]),
        *halves_alone.bars(found.get("alone", {})),
        *vendor.bars(found["vendor"]),
    ]


def page(found: dict[str, Any]) -> str:
    """Return the results as Markdown."""
    return "\n".join(
        [
            INTRODUCTION,
            scoreboard(all_bars(found)),
            filters.page(found["filter"]),
            segments.page(found.get("segments", [])),
            estimators.page(found["axes"]),
            third_axis.page(found.get("third", {}), found["halves"]),
            outlying.page(found.get("hinges", {})),
            one_wide.page(found.get("one", {})),
            free_motion.page(found["free"], found["floor"], found.get("held", {})),
            free_served.page(found.get("served", {})),
            doubts.page(found.get("doubts", {})),
            angles.page(found["angles"]),
            normalization.page(found["normalization"]),
            same_person.page(found.get("same_person", {})),
            papers_metrics.page(found["paper"], found["skipped"]),
            repeatability.page(found["halves"]),
            halves_alone.page(found.get("alone", {})),
            bends.page(found.get("bends", {})),
            times.page(found["times"]),
            vendor.page(found["vendor"]),
        ]
    )


def scoreboard(bars: Sequence[Bar]) -> str:
    """Return what was asked for and whether it is there."""
    asked, beside = ([bar for bar in bars if bar.beside == late] for late in (False, True))
    lines = [
        f"**{sum(bar.met for bar in asked)} of {len(asked)} figures meet what is asked of them**, "
        "numbers that were set before anything was measured here. Beside them stand "
        f"{len(beside)} that were added later to tell what a figure consists of, held to the same "
        f"numbers ({sum(bar.met for bar in beside)} meet them). Free motion with twist was asked "
        "for once, without saying for how long or with how much twist, normalization without "
        "saying between which poses, cross-talk without saying whether noise is part of it: "
        "each way counts as a figure of its own.\n",
        "| | figure | measured | asked | |",
        "|---|---|---:|---:|---|",
    ]
    for bar in bars:
        what = f"*beside:* {bar.what}" if bar.beside else bar.what
        cells = (bar.section, what, bar.measured, bar.asked, bar.verdict)
        lines.append("| " + " | ".join(cells) + " |")
    return "\n".join(lines) + "\n"
