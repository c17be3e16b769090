"""Section 2: what of axes from free motion reaches a user who asks for them by name."""

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.axes.bars import number
from benchmarks.axes.free_motion import LIKELIEST, make
from benchmarks.axes.measures import found_at_joints, line_angles
from kinesphere.parameterization import AxesSettings, ParameterizationSettings, parameterize

MOTIONS = ("20 s, ±10° of twist", "60 s, ±10° of twist", "120 s, ±10° of twist")
JOINTS = 8
TASKS = [(motion, 4000 + seed) for motion in MOTIONS for seed in range(JOINTS)]
"""Other joints than those the estimator is measured on."""


def run(motion: str, seed: int) -> dict[str, Any]:
    """Return whether the whole stage serves the axes it found, what it says, and their error."""
    joint = make(motion, "OU 1°", seed)
    options = AxesSettings(method=LIKELIEST, counts="joint_01=2")
    solved = parameterize(joint.motion, ParameterizationSettings(axes=options))
    found = solved.skeleton.joints[0]
    told = found_at_joints(solved.history)[found.name]
    axes, rest = np.asarray(found.axes), np.asarray(found.rest)
    pairs = ((rest.T @ axes[0], joint.rest.T @ joint.axes[0]), (axes[1], joint.axes[1]))
    return {
        "motion": motion,
        "served": found.axes_source == "movement",
        "doubted": bool(told.get("remark")),
        "error_deg": float(max(line_angles(a, b) for a, b in pairs)),
    }


def section(
    run_all: Callable[[str, Callable[..., Any], Sequence[tuple[Any, ...]]], list[Any]], _: Path
) -> dict[str, Any]:
    """Return the figures."""
    rows = run_all("served in free motion", run, TASKS)
    return {
        "served": {
            motion: _summed([r for r in rows if r["motion"] == motion]) for motion in MOTIONS
        }
    }


def _summed(rows: Sequence[dict[str, Any]]) -> dict[str, Any]:
    errors = [row["error_deg"] for row in rows if row["served"]]
    return {
        "joints": len(rows),
        "served": len(errors),
        "doubted": sum(row["served"] and row["doubted"] for row in rows),
        "median_deg": float(np.median(errors)) if errors else None,
        "worst_deg": float(np.max(errors)) if errors else None,
    }


def page(found: dict[str, Any]) -> str:
    """Return the paragraph and its table."""
    if not found:
        return ""
    lines = [
        "The rows above are estimators by themselves. A user who asks for `universal-joint` gets",
        "the whole stage, which compares halves of the recording and gives the body's axes where",
        "they contradict each other. Joints with 1° of correlated noise, not those measured above:",
        "",
        "| motion | joints | axes served | of them with a doubt | worse axis, median | worst |",
        "|---|---:|---:|---:|---:|---:|",
    ]
    for motion, row in found.items():
        errors = (
            f"{number(row[key])}°" if row["served"] else "–" for key in ("median_deg", "worst_deg")
        )
        cells = [motion, str(row["joints"]), str(row["served"]), str(row["doubted"]), *errors]
        lines.append("| " + " | ".join(cells) + " |")
    return "\n".join([*lines, ""])
