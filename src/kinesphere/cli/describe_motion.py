"""A motion in figures, as BVH and AMC hold it: for machines and for people."""

from typing import Any

from kinesphere.cli.console import print_pairs, print_table, print_title, print_warnings, stdout
from kinesphere.data import Motion, Skeleton
from kinesphere.data.figure import find_figure
from kinesphere.errors import BadModel
from kinesphere.report import number_in_words


def describe_motion(motion: Motion) -> dict[str, Any]:
    """Return what is in a motion: units in the names, everything JSON can hold."""
    read = motion.history[0] if motion.history else None
    return {
        "kind": "motion",
        "read": {**read.settings, **read.findings} if read else {},
        "n_frames": motion.n_frames,
        "rate_hz": motion.rate,
        "duration_s": motion.n_frames / motion.rate,
        "seen": float(motion.seen.mean()),
        **describe_figure(motion.skeleton),
        "limbs": [
            {"name": limb.name, "parent": limb.parent, "length_m": limb.length}
            for limb in motion.skeleton.limbs
        ],
        "warnings": [warning for step in motion.history for warning in step.warnings],
    }


def describe_figure(skeleton: Skeleton) -> dict[str, Any]:
    """Return which limbs are which parts of a human figure, as retargeting would take them."""
    try:
        figure = find_figure(skeleton)
    except BadModel as error:
        return {"figure": None, "figure_from": str(error)}
    names = skeleton.limb_names
    return {
        "figure": {
            "pelvis": names[figure.pelvis],
            "spine": [names[i] for i in figure.spine],
            "neck": [names[i] for i in figure.neck],
            **{part: names[i] for part, i in figure.parts.items()},
        },
        "figure_from": figure.source,
    }


def show_motion(summary: dict[str, Any]) -> None:
    """Print the motion as tables: what it is, its limbs, warnings."""
    console = stdout()
    read = summary["read"]
    print_title(
        console,
        summary["file"],
        f"{str(read.get('format', 'motion')).upper()}, {len(summary['limbs'])} limbs, "
        f"{summary['n_frames']:,} frames, {summary['duration_s']:.2f} s",
    )
    pairs = [("rate", f"{summary['rate_hz']:g} Hz"), ("seen", f"{summary['seen']:.1%}")]
    if "metres_per_unit" in read:
        pairs.append(("unit", f"{read['metres_per_unit'] * 1e3:.6g} mm"))
    if "up" in read:
        pairs.append(("up in the file", str(read["up"])))
    _show_limbs(summary, pairs)
    if summary["warnings"]:
        print_title(console, "Warnings")
        print_warnings(console, summary["warnings"])


def show_rig(summary: dict[str, Any]) -> None:
    """Print a skeleton that nobody measured: its limbs, and which parts of a figure they are."""
    print_title(stdout(), summary["file"], f"a rig of {len(summary['limbs'])} limbs")
    _show_limbs(summary, [])


def _show_limbs(summary: dict[str, Any], pairs: list[tuple[str, str]]) -> None:
    console = stdout()
    told = summary["figure_from"]
    print_pairs(console, [*pairs, ("figure", f"found by {told}" if summary["figure"] else told)])
    parts: dict[str, str] = {}
    for part, limbs in (summary["figure"] or {}).items():
        for limb in [limbs] if isinstance(limbs, str) else limbs:
            parts[limb] = part
    rows = [
        (
            limb["name"],
            number_in_words(limb["length_m"] * 1e3, "mm"),
            limb["parent"] or "root",
            parts.get(limb["name"], ""),
        )
        for limb in summary["limbs"]
    ]
    print_table(console, ("limb", "length", "hangs from", "part"), rows, "lrll")
