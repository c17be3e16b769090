"""The figures as a page: what is held to a number first, then every case."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from benchmarks.accuracy.bodies.centres import centres_section
from benchmarks.accuracy.bodies.changes import changes_section
from benchmarks.accuracy.bodies.hips_page import hip_bars, hip_section
from benchmarks.accuracy.bodies.linked_limbs import linked_section
from benchmarks.accuracy.bodies.perturbed import perturbed_section
from benchmarks.accuracy.bodies.strayed import strayed_section
from benchmarks.accuracy.bodies.told_page import told_bars, told_section

SIZES = [2, 3, 4]
"""Markers of the unlabelled arm's bodies."""

INTRODUCTION = """\
# A skeleton from motion alone

Written by `python -m benchmarks.accuracy.bodies`; every figure is in
`benchmarks/results/skeleton.json`.

Labels are hidden before the run (`*0`, `*1`…); the program gets trajectories and nothing else.
*ARI* is the adjusted Rand index of the marker bodies (Hubert & Arabie 1985), 1 where the partition
is right, over the markers of all trees (`discovery.tree` solves each). A joint is *wrong* if the
two bodies it joins hold no limbs that meet, in whichever tree. Names count as
wrong if a body's name is not that of most of its markers; limbs that are only numbered are not
named.

`discovery.split_ratio` and `discovery.shared_ratio`, what becomes of bodies of one marker, the
weight of nearness in joint costs, the costs of bodies that are no limb and the limits from which
names are given were settled while looking at the real recordings below: for those rows this page is
no independent check. The actors were in view as well; their partitions and trees were right
throughout.
"""


@dataclass(frozen=True)
class Bar:
    """Something that is held to a number."""

    what: str
    found: str
    wanted: str
    met: bool


def bars(found: dict[str, Any]) -> list[Bar]:
    """Return every figure that is held to a number, by the default method."""
    rows = {row["case"]: row for row in found["partitions"] if row["method"] == "spectral"}
    clean = [row for name, row in rows.items() if name.endswith("1 mm noise")]
    spoilt = [row for name, row in rows.items() if "ghosts" in name]
    cmu = [row for name, row in rows.items() if name.startswith("cmu41")]
    creatures = [
        row
        for name, row in rows.items()
        if name.startswith(("quadruped", "hand", "person with", "two people"))
    ]
    laws = [row for row in found["changes"] if row["law"]]
    arm = found["arm"]
    worst_half = max(arm["halves_mm"].values())
    knees = [row for row in found["functional"] if row["joint"].endswith("knee")]
    hips = [row for row in found["functional"] if row["joint"].endswith("hip")]
    cost = next(row for row in found["cost"] if row["n_frames"] == 24_000)
    seconds = cost["discovery_s"] + cost["skeleton_s"]
    gait = rows["encodings/pc_real"]
    return [
        _at_least("plates: ARI over the ten plates", rows["plates/KneeltoProne01"]["rand"], 0.95),
        _at_least("pc_real: ARI", gait["rand"], 0.95),
        _right("pc_real: the anatomical tree", [gait]),
        _at_least("walkingOptiTrack: ARI", rows["rigid-bodies/walkingOptiTrack"]["rand"], 1.0),
        Bar(
            "arm: bodies of 4, 2 and 3 markers, two joints",
            f"{arm['sizes']}, {arm['joints']} joints",
            f"{SIZES}, 2 joints",
            arm["sizes"] == SIZES and arm["joints"] == 2,
        ),
        _at_most("arm: centre between halves, worst joint", worst_half, 3.0, "mm"),
        _at_least("ten actors, 1 mm noise: least ARI", min(row["rand"] for row in clean), 1.0),
        _right("ten actors, 1 mm noise: the true tree in all", clean),
        _at_least(
            "ten actors, soft tissue, gaps, ghosts: ninth best ARI",
            sorted((row["rand"] for row in spoilt), reverse=True)[8],
            0.98,
        ),
        _right("ten actors, soft tissue…: the true tree in nine", spoilt, least=9),
        _at_most("joint centres, 1 mm noise: median", _centre(clean), 1.0, "mm"),
        _at_most("joint centres, soft tissue…: median", _centre(spoilt), 6.0, "mm"),
        _at_least(
            "quadruped, hand, racket, two people: least ARI",
            min(row["rand"] for row in creatures),
            1.0,
        ),
        _right("quadruped, hand, racket, two people: the true tree", creatures),
        Bar(
            "other units, another order of markers: the same bodies and tree",
            f"{sum(row['same'] for row in laws)} of {len(laws)}",
            f"{len(laws)} of {len(laws)}",
            all(row["same"] for row in laws),
        ),
        _at_least("cmu41: least ARI", min(row["rand"] for row in cmu), 0.85),
        _at_most("cmu41: wrong joints, worst", max(len(row["wrong_edges"]) for row in cmu), 1, ""),
        _at_most("cmu41: wrong names", sum(len(row["wrong_names"]) for row in cmu), 0, ""),
        _at_most("knee axis between halves", max(row["halves_deg"] for row in knees), 1.5, "°"),
        _at_most("knee centre across, halves", max(row["halves_mm"] for row in knees), 2.0, "mm"),
        Bar(
            "knee centre along the axis is said to be open",
            ", ".join(row["observability"] for row in knees),
            "hinge",
            all(row["observability"] == "hinge" for row in knees),
        ),
        _at_most("hip centre between halves", max(row["halves_mm"] for row in hips), 10.0, "mm"),
        _at_most(
            "hip centre between halves, with landmarks",
            max(row["landmarks_mm"] for row in hips),
            10.0,
            "mm",
        ),
        *(Bar(*one) for one in hip_bars(found["hips"])),
        *(Bar(*one) for one in told_bars(found["told"])),
        _at_most("24,000 frames × 48 markers, one core", seconds, 3.0, "s"),
        _at_most("memory for that", cost["memory_mb"], 1000.0, "MB"),
    ]


def page(found: dict[str, Any]) -> str:
    """Return the results as Markdown."""
    return "\n".join(
        [
            INTRODUCTION,
            _scoreboard(bars(found)),
            _partitions(found["partitions"]),
            changes_section(found["changes"]),
            perturbed_section(found["perturbed"]),
            strayed_section(found["strayed"]),
            centres_section(found["centres"]),
            told_section(found["told"]),
            hip_section(found["hips"]),
            _functional(found["functional"], found["peer"]),
            _arm(found["arm"]),
            linked_section(found["linked"]),
            _hiding(found["hiding"]),
            _cost(found["cost"]),
        ]
    )


def _scoreboard(held: Sequence[Bar]) -> str:
    lines = ["| held to | found | wanted | |", "|---|---:|---:|---|"]
    lines += [
        f"| {bar.what} | {bar.found} | {bar.wanted} | {'ok' if bar.met else '**missed**'} |"
        for bar in held
    ]
    return "\n".join(lines) + "\n"


def _partitions(rows: Sequence[dict[str, Any]]) -> str:
    lines = [
        "## Bodies, trees and names\n",
        "Two ways of clustering by name (`discovery.method`): self-tuning spectral clustering, and "
        "average linkage cut at its largest gap. What follows is the same for both.\n",
        "| recording | method | ARI | bodies (true) | trees | wrong joints | named | wrong names "
        "| s |",
        "|---|---|---:|---:|---:|---|---:|---|---:|",
    ]
    for row in rows:
        if row["failure"]:
            lines.append(f"| {row['case']} | {row['method']} | {row['failure']} | | | | | | |")
            continue
        joints = ", ".join(row["wrong_edges"]) or ("none" if row["edges"] else "–")
        lines.append(
            f"| {row['case']} | {row['method']} | {row['rand']:.3f} | {row['bodies']} "
            f"({row['true_bodies']}) | {row['trees']} | {joints} | {row['named']} "
            f"| {', '.join(row['wrong_names']) or 'none'} | {row['seconds']:.2f} |"
        )
    centres = [row for row in rows if row["centres_mm"]]
    lines += [
        "",
        "### Joint centres of the ten actors\n",
        "Distance that stays the same over time, in the parent's frame; of elbows and knees across "
        "their axis. *rms* is with what changes from frame to frame.\n",
        "| condition | median | 90 % | worst | rms, median |",
        "|---|---:|---:|---:|---:|",
    ]
    for what in ("1 mm noise", "soft tissue, gaps, ghosts"):
        mine = [row for row in centres if row["case"].endswith(what)]
        errors = [v for row in mine for v in row["centres_mm"].values()]
        rms = [v for row in mine for v in row["centres_rms_mm"].values()]
        if errors:
            lines.append(
                f"| {what} | {np.median(errors):.2f} mm | {np.percentile(errors, 90):.2f} mm "
                f"| {max(errors):.2f} mm | {np.median(rms):.2f} mm |"
            )
    return "\n".join(lines) + "\n"


def _functional(rows: Sequence[dict[str, Any]], peer: str) -> str:
    whose = peer or "biobuddy, left out here (`--without-peer`)"
    lines = [
        "## Hips and knees of functional trials\n",
        "Skeleton, axes and centres with the layout's model but without its landmarks: everything "
        "is from the motion. *Halves* are the first and the second half of the trial, in which "
        "people make different movements (a hip 77° in one, 53° in the other); *eighths* every "
        "second eighth against the rest. *Told* is the rms difference that the uncertainties in "
        "`skeleton.json` lead to expect between the halves; they hold what is alike in both "
        "halves, too: skin that goes with a knee draws it aside in either. Centres of knees across "
        "their axis; "
        f"*along* it they are open. The peer is {whose}: SCoRE and SARA on the same poses, in "
        "the same run. "
        "*With landmarks*: each half solved as a user would solve it; there hips are weighed with "
        "where the spines of the pelvis have them, which is the same in both halves. *SCoRE* "
        "compares the peer's centre with the plain one of this project; the time ratio is the "
        "peer's processor time over that of the plain one.\n",
        "| joint | centre | halves | told | with landmarks | along | axis, halves "
        "| with landmarks | told | eighths "
        "| axis, eighths "
        "| peer, halves | peer axis, halves | to the peer | SCoRE | axis to the peer "
        "| time ratio |",
        "|---|---|" + "---:|" * 15,
    ]
    for row in rows:
        lines.append(
            f"| {row['joint'].replace('_', ' ')} | {row['observability']} "
            f"| {_n(row['halves_mm'], 'mm')} | {_n(row['told_mm'], 'mm')} "
            f"| {_n(row['landmarks_mm'], 'mm')} "
            f"| {_n(row['along_mm'], 'mm')} "
            f"| {_n(row['halves_deg'], '°')} | {_n(row['landmarks_deg'], '°')} "
            f"| {_n(row['told_deg'], '°')} "
            f"| {_n(row['blocks_mm'], 'mm')} "
            f"| {_n(row['blocks_deg'], '°')} | {_n(row['peer_halves_mm'], 'mm')} "
            f"| {_n(row['peer_halves_deg'], '°')} | {_n(row['peer_mm'], 'mm')} "
            f"| {_n(row['score_mm'], 'mm')} | {_n(row['peer_deg'], '°')} "
            f"| {_n(row['time_ratio'], '×')} |"
        )
    return "\n".join(lines) + "\n"


def _arm(arm: dict[str, Any]) -> str:
    apart = _apart(arm["halves_mm"])
    return (
        "## The unlabelled arm\n\n"
        f"Bodies of {', '.join(map(str, arm['sizes']))} markers, {arm['joints']} joints. Centres "
        f"between the halves of the trial, in the better-marked limb: {apart}. The three markers "
        "of the last body lie within 5 mm of a line, so their own pose hardly tells a turn about "
        "it.\n\n"
        f"In the limb as the whole trial has it posed they are "
        f"{_apart(arm['posed_by_whole_mm'])} apart. Limb by limb (`skeleton.link_limbs=false`), "
        f"shapes laid on each other, {_apart(arm['limb_by_limb_mm'])}. "
        f"Told are {_apart(arm['told_mm'])}.\n\n"
        "What halves can tell: twins of the arm, its own motion about known centres, with what its "
        "markers stray put back on. *turned*: every marker's strays by a rotation of its own, so "
        "that they go with the pose as skin does; *shifted*: from another time of the half "
        "besides, so that they go with nothing. The worst joint, medians of the draws, from "
        "nothing and by maximum likelihood that begins with the true shapes, centres and poses: "
        "where that leads away from the truth, the half does not tell it.\n\n"
        "| noise | from nothing: halves | error | begun with the truth: halves | error | halves "
        "within 3 mm |\n|---|---:|---:|---:|---:|---:|\n"
        + "".join(
            f"| {twin['noise']} | {_n(twin['halves_mm'], 'mm')} | {_n(twin['error_mm'], 'mm')} "
            f"| {_n(twin['begun_halves_mm'], 'mm')} | {_n(twin['begun_error_mm'], 'mm')} "
            f"| {twin['begun_within']} of {twin['draws']} |\n"
            for twin in arm["twins"]
        )
    )


def _apart(joints: dict[str, float]) -> str:
    return ", ".join(f"{name} {value:.1f} mm" for name, value in joints.items())


def _hiding(rows: Sequence[dict[str, Any]]) -> str:
    lines = [
        "## Limbs that are hidden\n",
        "A synthetic actor in free motion, one limb's markers hidden again and again; labels are "
        "hidden too, bodies and joints are found in the recording with its gaps. Errors of "
        "the marker positions that are put in (`skeleton.fill_markers`), against a cubic spline "
        "through each marker by itself.\n",
        "| limb | hidden for | placed | median | 95 % | spline, median |",
        "|---|---:|---:|---:|---:|---:|",
    ]
    for row in rows:
        lines.append(
            f"| {row['limb'].replace('_', ' ')} | {row['seconds']:g} s | {row['placed']:.0%} "
            f"| {_n(row['median_mm'], 'mm')} | {_n(row['p95_mm'], 'mm')} "
            f"| {_n(row['spline_mm'], 'mm')} |"
        )
    return "\n".join(lines) + "\n"


def _cost(rows: Sequence[dict[str, Any]]) -> str:
    lines = [
        "## Cost\n",
        "Processor time of one core after compilation; memory is the most allocated at once beside "
        "the recording.\n",
        "| frames | markers | bodies, tree, names | shapes, joints, poses | together | memory |",
        "|---:|---:|---:|---:|---:|---:|",
    ]
    for row in rows:
        both = row["discovery_s"] + row["skeleton_s"]
        lines.append(
            f"| {row['n_frames']:,} | {row['n_markers']} | {row['discovery_s']:.2f} s "
            f"| {row['skeleton_s']:.2f} s | {both:.2f} s | {row['memory_mb']:.0f} MB |"
        )
    lines += ["", "![How time grows with frames](../images/skeleton-cost.svg)"]
    return "\n".join(lines) + "\n"


def _centre(rows: Sequence[dict[str, Any]]) -> float:
    return float(np.median([v for row in rows for v in row["centres_mm"].values()]))


def _at_least(what: str, value: float, wanted: float) -> Bar:
    return Bar(what, f"{value:.3f}", f"≥ {wanted:g}", value >= wanted - 1e-9)


def _at_most(what: str, value: float, wanted: float, unit: str) -> Bar:
    gap = "" if unit in ("", "°") else " "
    return Bar(what, f"{value:.3g}{gap}{unit}", f"≤ {wanted:g}{gap}{unit}", bool(value <= wanted))


def _right(what: str, rows: Sequence[dict[str, Any]], least: int | None = None) -> Bar:
    wanted = len(rows) if least is None else least
    right = sum(not row["wrong_edges"] and bool(row["edges"]) for row in rows)
    return Bar(what, f"{right} of {len(rows)}", f"{wanted} of {len(rows)}", right >= wanted)


def _n(value: float | None, unit: str) -> str:
    if value is None or not math.isfinite(value):
        return "–"
    gap = "" if unit in ("°", "×") else " "
    if abs(value) < 0.005:
        return f"0{gap}{unit}"
    return f"{value:.0f}{gap}{unit}" if value >= 100 else f"{value:.2g}{gap}{unit}"
