"""A topological model or a measured skeleton in figures, for machines and for people."""

from typing import Any

import numpy as np

from kinesphere.cli.console import print_pairs, print_table, print_title, stdout
from kinesphere.data import Skeleton, TopologicalModel
from kinesphere.report import number_in_words, origins_in_words


def describe_model(model: TopologicalModel) -> dict[str, Any]:
    """Return what a topological model holds."""
    return {
        "kind": "model",
        "name": model.name,
        "description": model.description,
        "root": model.root,
        "segments": [
            {"name": s.name, "markers": list(s.markers), "shared": list(s.shared)}
            for s in model.segments
        ],
        "joints": [
            {"name": j.name, "parent": j.parent, "child": j.child, "n_axes": j.n_axes}
            for j in model.joints
        ],
        "required": list(model.required),
        "learnt_from": [statistics.recording for statistics in model.statistics],
    }


def show_model(summary: dict[str, Any]) -> None:
    """Print the model as a table."""
    console = stdout()
    n_markers = sum(len(segment["markers"]) for segment in summary["segments"])
    print_title(
        console,
        summary["name"],
        f"{len(summary['segments'])} segments, {n_markers} markers, root {summary['root']}",
    )
    if summary["description"]:
        print_pairs(console, [("", summary["description"])])
    joints = {joint["child"]: joint for joint in summary["joints"]}
    rows = []
    for segment in summary["segments"]:
        joint = joints.get(segment["name"])
        rows.append(
            (
                segment["name"],
                f"{joint['name']} to {joint['parent']}" if joint else "root",
                ", ".join(segment["markers"]) or "–",
                ", ".join(segment["shared"]),
            )
        )
    print_table(console, ("segment", "joint", "markers", "shared"), rows)


def describe_skeleton(skeleton: Skeleton) -> dict[str, Any]:
    """Return what a measured skeleton holds."""
    return {
        "kind": "skeleton",
        "limbs": [
            {
                "name": limb.name,
                "parent": limb.parent,
                "length_m": limb.length,
                "markers": list(limb.markers),
            }
            for limb in skeleton.limbs
        ],
        "joints": [
            {
                "name": joint.name,
                "parent": joint.parent,
                "child": joint.child,
                "residual_mm": joint.residual * 1e3,
                "range_of_motion_deg": float(np.rad2deg(joint.range_of_motion)),
                "observability": joint.observability,
                "n_axes": joint.n_axes,
                "axes_from": joint.axes_source,
                "axes_sources": list(joint.axes_sources),
                "axes_reused_from": [name or None for name in joint.axes_reused_from],
            }
            for joint in skeleton.joints
        ],
    }


def show_skeleton(summary: dict[str, Any]) -> None:
    """Print the skeleton as a table: a limb and the joint it hangs from in one line."""
    console = stdout()
    print_title(console, summary["file"], f"a skeleton of {len(summary['limbs'])} limbs")
    joints = {joint["child"]: joint for joint in summary["joints"]}
    rows = []
    for limb in summary["limbs"]:
        length = number_in_words(limb["length_m"] * 1e3, "mm")
        joint = joints.get(limb["name"])
        if joint is None:
            rows.append((limb["name"], length, "root", "", "", ""))
            continue
        rows.append(
            (
                limb["name"],
                length,
                f"{joint['name']} to {joint['parent']}",
                number_in_words(joint["residual_mm"], "mm"),
                joint["observability"],
                origins_in_words(joint["axes_sources"], joint["axes_reused_from"]),
            )
        )
    print_table(console, ("limb", "length", "joint", "residual", "centre", "axes"), rows, "lrlrll")
