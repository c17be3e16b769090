"""The page's section on what is told of joint centres."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from benchmarks.accuracy.bodies.told import EXACT_MM, IN_A_ROW, KINDS, of_conditions, told_ratio

RIGHT = 0.4, 1.2
"""Rms of errors over what is told of them, in every condition."""
SIGMAS = 4.0
"""Errors over what is told beyond which none may lie."""
SOME = ("1 mm noise", "skin 10 mm/rad", "skin 10 mm/rad, 12 s free")
"""Conditions that are shown joint by joint."""


def told_bars(rows: Sequence[dict[str, Any]]) -> list[tuple[str, str, str, bool]]:
    """Return what the section is held to: what, found, wanted, and whether it is met."""
    ratios = {name: told_ratio(mine) for name, mine in of_conditions(rows).items()}
    people = [ratio for name, ratio in ratios.items() if not name.startswith(IN_A_ROW)]
    # limbs in a row are told carefully: what is linked has no model of its skin
    least, most = float(np.nanmin(people)), float(np.nanmax(list(ratios.values())))
    far = max(r["error_mm"] / r["told_mm"] for r in rows if r["told_mm"] > EXACT_MM)
    return [
        (
            "centres: error over what is told, rms, least of people and most of all conditions",
            f"{least:.2f}, {most:.2f}",
            f"{RIGHT[0]:g} to {RIGHT[1]:g}",
            RIGHT[0] <= least and most <= RIGHT[1],
        ),
        (
            "centres: error over what is told, largest",
            f"{far:.1f}",
            f"≤ {SIGMAS:g}",
            far <= SIGMAS,
        ),
    ]


def told_section(rows: Sequence[dict[str, Any]]) -> str:
    """Return the page's section."""
    actors = sorted({row["actor"] for row in rows})
    lines = [
        "## What is told of centres\n",
        f"Actors {actors[0]} to {actors[-1]}; the formula was settled on others. Marker bodies are "
        "given, no landmarks are; 60 s of calibration movements and 10 s of free motion where "
        "nothing else is said, *most joints at rest*: the first 20 s of it. *Error*: distance that "
        "stays the same over time, of hinges across their axis. *Told*: its rms by the covariance "
        "in `skeleton.json`. *Over told*: error over told, 1 where what is told is right; the "
        "share of centres within once and twice what is told, rms and largest. *Along*: the same "
        "ratio along the axes of hinges, rms. *Determined*: how many are called so, and the "
        "largest error of those. *Missing*: samples drawn one by one, *in gaps* half a second at a "
        "time. *Limbs in a row*: chains, not people, the middle limb fitted together with both "
        "beside it; errors along hinges count.\n",
        "| condition | centres | error, median | told, median | over told, rms | largest "
        "| within 1 | within 2 | along, rms | determined | their largest error |",
        "|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|",
    ]
    lines += [_line(name, mine) for name, mine in of_conditions(rows).items()]
    lines += [
        "\nJoint by joint, rms of error over told:\n",
        f"| joint | {' | '.join(SOME)} |",
        "|---|" + "---:|" * len(SOME),
    ]
    for kind in KINDS:
        told = [
            told_ratio([r for r in rows if r["condition"] == name and r["joint"].endswith(kind)])
            for name in SOME
        ]
        lines.append(f"| {kind} | {' | '.join(f'{x:.2f}' for x in told)} |")
    return "\n".join(lines) + "\n"


def _line(name: str, rows: Sequence[Mapping[str, Any]]) -> str:
    error, told = (np.array([row[key] for row in rows]) for key in ("error_mm", "told_mm"))
    sure = error[[row["observability"] == "determined" for row in rows]]
    called = f"{len(sure)} | {sure.max():.1f} mm" if len(sure) else "0 | –"
    start = f"| {name} | {len(rows)} | {np.median(error):.2f} mm | {np.median(told):.2f} mm "
    ratio = told_ratio(rows)
    if not np.isfinite(ratio):
        return f"{start}| – | – | – | – | – | {called} |"
    over = error[told > EXACT_MM] / told[told > EXACT_MM]
    along = [r["along_mm"] / r["told_along_mm"] for r in rows if r["along_mm"] is not None]
    along = [x for x in along if np.isfinite(x)]
    beside = f"{np.sqrt(np.mean(np.square(along))):.2f}" if along else "–"
    return (
        f"{start}| {ratio:.2f} | {over.max():.1f} | {(over < 1).mean():.0%} "
        f"| {(over < 2).mean():.0%} | {beside} | {called} |"
    )
