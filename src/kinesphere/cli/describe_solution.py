"""A solution in figures, for machines and for people."""

from typing import Any

import numpy as np

from kinesphere.cli.console import (
    print_table,
    print_title,
    print_warnings,
    stdout,
)
from kinesphere.cli.stages import stage_in_words
from kinesphere.data import Solution
from kinesphere.io.summary import summary_of
from kinesphere.report import JointRow, counted, joint_rows, names_of, rms, unique


def describe_solution(solution: Solution) -> dict[str, Any]:
    """Return ``summary.json`` and the figures of every joint; units are in the names."""
    motion, parameters = solution.motion, solution.parameters
    return {
        "kind": "solution",
        **summary_of(solution),
        "warnings": unique(solution.warnings),
        "limb_residual_rms_mm": rms(motion.residuals) * 1e3,
        "rebuilt_residual_rms_mm": rms(parameters.residuals) * 1e3,
        "seen": float(motion.seen.mean()),
        "joint_findings": [
            {
                "name": joint.name,
                "residual_mm": joint.residual * 1e3,
                "range_of_motion_deg": float(np.rad2deg(joint.range_of_motion)),
                "observability": joint.observability,
                "n_axes": joint.n_axes,
                "axes_from": joint.axes_source,
                "axes_sources": list(joint.axes_sources),
                "axes_reused_from": [name or None for name in joint.axes_reused_from],
                "note": joint.note,
            }
            for joint in solution.skeleton.joints
        ],
    }


def show_solution(summary: dict[str, Any], solution: Solution) -> None:
    """Print the summary as tables: stages, joints, warnings."""
    console = stdout()
    seconds = summary["n_frames"] / summary["rate_hz"]
    print_title(
        console,
        summary["file"],
        f"model {summary['model']}, {counted(len(summary['limbs']), 'limb')}, "
        f"{counted(summary['n_frames'], 'frame')}, {seconds:.2f} s",
    )
    rows = [
        (
            stage["name"],
            stage_in_words(stage, summary),
            "" if stage["seconds"] is None else f"{stage['seconds']:.2f} s",
        )
        for stage in summary["stages"]
    ]
    print_table(console, ("stage", "what was found", "took"), rows, "llr")
    if solution.skeleton.joints:
        print_title(console, "Joints")
        print_table(
            console,
            ("joint", "residual", "range", "centre", "axes", "angles 5–95 %", "twist"),
            [_joint_cells(row) for row in joint_rows(solution)],
            "lrrllrr",
            doubtful=("undetermined",),
        )
    if summary["warnings"]:
        print_title(console, "Warnings")
        print_warnings(console, summary["warnings"], names_of(solution.skeleton))


def _joint_cells(row: JointRow) -> tuple[str, ...]:
    angles = ", ".join(_short(angle) for angle in row.angles[: row.n_axes])
    return (
        row.name,
        row.residual,
        row.range_of_motion,
        row.observability,
        row.axes,
        angles,
        _short(row.angles[-1]),
    )


def _short(span: str) -> str:
    return span.replace("° … ", "…")
