"""A mesh that somebody brings, in figures: its triangles, and the rig it rides on, if any."""

from pathlib import Path
from typing import Any

import numpy as np

from kinesphere.cli.console import print_pairs, print_title, print_warnings, stdout
from kinesphere.cli.describe_model import describe_skeleton
from kinesphere.cli.describe_motion import describe_figure, show_rig
from kinesphere.data import Surface
from kinesphere.errors import UnreadableFile
from kinesphere.io import read_rig, rig_format


def describe_mesh(surface: Surface, file: Path) -> dict[str, Any]:
    """Return the figures of a mesh, and those of the rig in the same file; lengths in its unit."""
    return {
        **_rig(file),
        "kind": "mesh",
        "n_vertices": surface.n_vertices,
        "n_triangles": len(surface.faces),
        "extent": np.ptp(surface.vertices, axis=0).tolist(),
        "body_limbs": list(surface.limbs) if surface.has_limbs else [],
        "warnings": [warning for step in surface.history for warning in step.warnings],
    }


def _rig(file: Path) -> dict[str, Any]:
    if rig_format(file) is None:
        return {}
    try:
        skeleton = read_rig(file)
    except UnreadableFile:  # a mesh alone
        return {}
    return {**describe_skeleton(skeleton), **describe_figure(skeleton)}


def show_mesh(summary: dict[str, Any]) -> None:
    """Print the mesh, then its rig."""
    sizes = " × ".join(f"{size:.4g}" for size in summary["extent"])
    print_title(
        stdout(),
        summary["file"],
        f"a mesh of {summary['n_triangles']:,} triangles, {summary['n_vertices']:,} vertices",
    )
    limbs = ", ".join(summary["body_limbs"]) or "none; found when it is attached"
    print_pairs(stdout(), [("x × y × z", f"{sizes}, in the unit of the file"), ("limbs", limbs)])
    if summary.get("figure") is not None:
        show_rig(summary)
    if summary["warnings"]:
        print_title(stdout(), "Warnings")
        print_warnings(stdout(), summary["warnings"])
