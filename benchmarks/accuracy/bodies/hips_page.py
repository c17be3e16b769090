"""The page's section on hips that anatomy and motion tell together."""

from collections.abc import Sequence
from typing import Any

import numpy as np

WON = 1.05
"""Most that a well moved hip may be worse off for anatomy as published."""
RIGHT = 0.4, 1.2
"""Rms of errors over what is told, for people as published."""


def hip_bars(rows: Sequence[dict[str, Any]]) -> list[tuple[str, str, str, bool]]:
    """Return what the section is held to: what, found, wanted, and whether it is met."""
    groups = _groups(rows)
    usual = [mine for (_, people), mine in groups.items() if not people.startswith("three")]
    moved = [mine for (motion, _), mine in groups.items() if motion != "hips at rest"]
    lost = max(
        _rms(mine, "both_mm") / _rms(mine, "alone_mm")
        for (motion, people), mine in groups.items()
        if motion.startswith("hips well moved") and people == "as published"
    )
    more = max(
        (_rms(mine, "both_mm") - _rms(mine, "alone_mm")) / _rms(mine, "both_told_mm")
        for mine in moved
    )
    single = max((r["both_mm"] - r["alone_mm"]) / r["both_told_mm"] for m in moved for r in m)
    ratios = [_ratio(mine) for mine in usual]
    least, most = min(ratios), max(ratios)
    return [
        (
            "hips well moved, anatomy as published: rms error over that by motion alone",
            f"{lost:.2f}",
            f"≤ {WON:g}",
            lost <= WON,
        ),
        (
            "hips that move, worse than by motion alone, over what is told: rms, most of the "
            "conditions (of single hips)",
            f"{more:.2f} ({single:.2f})",
            "≤ 1",
            more <= 1,
        ),
        (
            "hips with anatomy: error over what is told, rms, least and most",
            f"{least:.2f}, {most:.2f}",
            f"{RIGHT[0]:g} to {RIGHT[1]:g}",
            RIGHT[0] <= least and most <= RIGHT[1],
        ),
    ]


def hip_section(rows: Sequence[dict[str, Any]]) -> str:
    """Return the page's section."""
    actors = sorted({row["actor"] for row in rows})
    lines = [
        "## Hips by motion and anatomy\n",
        f"Actors {actors[0]} to {actors[-1]} with markers on the spines of the pelvis, which tell "
        "their hips by the regression of Harrington et al. 2007 as far as people follow it "
        "(4.0, 3.8 and 5.2 mm off inward, down and forward); three times as far; or as far, with "
        "every marker 10 mm off its spine. Skin 10 mm a radian but for the first. *Anatomy*: how "
        "far off the regression is. *Alone*: by motion, without landmarks. *Both*: weighed "
        "(`skeleton.weigh_anatomy`). Rms, and the largest; *over told*: error over what is told, "
        "rms.\n",
        "| motion | range | people | anatomy | alone | both | largest alone | both | told, alone "
        "| both | over told, alone | both | determined |",
        "|---|---:|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|",
    ]
    for (motion, people), mine in _groups(rows).items():
        sure = sum(row["observability"] == "determined" for row in mine)
        rms = [
            f"{_rms(mine, key):.1f} mm"
            for key in ("expected_mm", "alone_mm", "both_mm", "alone_told_mm", "both_told_mm")
        ]
        largest = [f"{max(r[key] for r in mine):.1f} mm" for key in ("alone_mm", "both_mm")]
        moved = np.mean([row["range_deg"] for row in mine])
        lines.append(
            f"| {motion} | {moved:.0f}° | {people} | {' | '.join((*rms[:3], *largest, *rms[3:]))} "
            f"| {_ratio(mine, 'alone'):.2f} | {_ratio(mine):.2f} | {sure} of {len(mine)} |"
        )
    return "\n".join(lines) + "\n"


def _groups(rows: Sequence[dict[str, Any]]) -> dict[tuple[str, str], list[dict[str, Any]]]:
    groups: dict[tuple[str, str], list[dict[str, Any]]] = {}
    for row in rows:
        groups.setdefault((row["motion"], row["people"]), []).append(row)
    return groups


def _rms(rows: Sequence[dict[str, Any]], key: str) -> float:
    return float(np.sqrt(np.mean([row[key] ** 2 for row in rows])))


def _ratio(rows: Sequence[dict[str, Any]], way: str = "both") -> float:
    """Return the rms of errors over what is told of them."""
    over = [row[f"{way}_mm"] / row[f"{way}_told_mm"] for row in rows]
    return float(np.sqrt(np.mean(np.square(over))))
