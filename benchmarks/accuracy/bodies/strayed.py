"""Single sightings far off: what a few of them do to bodies, tree, names and centres."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from benchmarks.accuracy.bodies.cases import synthetic_case
from benchmarks.accuracy.bodies.partitions import rows
from kinesphere.synthetic import make_performance, spoil_with_noise

ACTORS = 3
SHARES = (0.0005, 0.002, 0.01, 0.02)
FAR = (0.3, 1.0)
"""m"""
SIZE = {"rate": 50.0, "calibration_s": 30.0, "free_s": 10.0}


@dataclass(frozen=True)
class Strayed:
    """One actor with so many sightings moved so far."""

    actor: int
    share: float
    far_m: float
    sightings: int
    rand: float
    wrong_edges: int
    named: int
    wrong_names: int
    median_mm: float
    worst_mm: float


def strayed_rows() -> Iterator[Strayed]:
    """Yield a row for every actor and spoiling; clean ones first."""
    for share, far in ((0.0, 0.0), *((share, far) for share in SHARES for far in FAR)):
        for actor in range(ACTORS):
            performance = make_performance(np.random.default_rng([actor, 7]), **SIZE)
            rng = np.random.default_rng([actor, 8])
            recording = spoil_with_noise(performance.recording, rng, deviation=0.001)
            markers = recording.markers.copy()
            moved = rng.random(markers.shape[:2]) < share
            way = rng.normal(size=(int(moved.sum()), 3))
            markers[moved] += far * way / np.linalg.norm(way, axis=1)[:, None]
            spoilt = replace(recording, markers=markers)
            case = synthetic_case(f"actor {actor}", spoilt, performance)
            row = next(rows([case], centres=True))
            off = list(row.centres_mm.values())
            yield Strayed(
                *(actor, share, far, int(moved.sum()), row.rand),
                *(len(row.wrong_edges), row.named, len(row.wrong_names)),
                *((float(np.median(off)), float(max(off))) if off else (np.nan, np.nan)),
            )


def strayed_section(found: Sequence[dict[str, Any]]) -> str:
    """Return the figures as Markdown."""
    lines = [
        "## Single sightings far off\n",
        f"{ACTORS} actors, 1 mm noise, 40 s at 50 Hz; a share of all sightings is moved in any "
        "direction. Worst of the actors; centres as above.\n",
        "| share | by | ARI, least | wrong joints | named, least | wrong names | centres, median "
        "| worst |",
        "|---:|---:|---:|---:|---:|---:|---:|---:|",
    ]
    for share, far in dict.fromkeys((row["share"], row["far_m"]) for row in found):
        mine = [row for row in found if (row["share"], row["far_m"]) == (share, far)]
        medians = [row["median_mm"] for row in mine if row["median_mm"] is not None]
        worst = [row["worst_mm"] for row in mine if row["worst_mm"] is not None]
        by = f"{far:g} m" if share else "–"
        lines.append(
            f"| {share:.2%} | {by} | {min(row['rand'] or 0.0 for row in mine):.3f} "
            f"| {max(row['wrong_edges'] for row in mine)} | {min(row['named'] for row in mine)} "
            f"| {max(row['wrong_names'] for row in mine)} "
            + (f"| {max(medians):.1f} mm | {max(worst):.1f} mm |" if medians else "| – | – |")
        )
    return "\n".join(lines) + "\n"
