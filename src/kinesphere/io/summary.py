"""``summary.json``: per stage what was found, how good it is, how long it took."""

import json
from pathlib import Path
from typing import Any

import numpy as np

from kinesphere import __version__
from kinesphere.data import Solution
from kinesphere.data.conventions import CONVENTIONS
from kinesphere.data.isb import GIMBAL_MARGIN_DEG, isb_angles
from kinesphere.io.json_files import write_json

SUMMARY_FORMAT = "kinesphere-summary-1"


def summary_of(solution: Solution) -> dict[str, Any]:
    """Return what ``summary.json`` holds; names end in their unit."""
    motion = solution.motion
    return {
        "format": SUMMARY_FORMAT,
        "version": __version__,
        "conventions": CONVENTIONS,
        "model": solution.model_name,
        "n_frames": motion.n_frames,
        "rate_hz": motion.rate,
        "duration_s": motion.n_frames / motion.rate,
        "first_frame": motion.first_frame,
        "n_markers": solution.recording.n_markers,
        "limbs": solution.skeleton.limb_names,
        "joints": solution.skeleton.joint_names,
        "warnings": solution.warnings,
        "stages": [
            {
                "name": step.name,
                "version": step.version,
                "seconds": solution.seconds.get(step.name),
                "settings": step.settings,
                "findings": step.findings,
                "warnings": step.warnings,
            }
            for step in solution.history
        ],
        "seconds": solution.seconds,
        "isb_angles": _clinical(solution),
    }


def _clinical(solution: Solution) -> dict[str, Any]:
    """Return how the clinical angles of each joint are read, and how often they are in doubt."""
    found = isb_angles(solution.motion, solution.skeleton)
    seen = np.isfinite(found.margins)
    return {
        "gimbal_margin_deg": GIMBAL_MARGIN_DEG,
        "joints": {
            joint.name: {
                "sequence": joint.convention.sequence,
                "angles": joint.angle_names,
                "source": joint.convention.source,
                "turned_deg": float(np.rad2deg(joint.turn)),
                "turned_by": joint.turn_from,
                "near_gimbal": float(found.gimbal[seen[:, j], j].mean())
                if seen[:, j].any()
                else None,
            }
            for j, joint in enumerate(found.joints)
        },
    }


def write_summary(solution: Solution, path: str | Path) -> None:
    """Write ``summary.json``; what is not known is null."""
    write_json(summary_of(solution), path)


def read_seconds(path: Path) -> dict[str, float]:
    """Return how long each stage took; nothing where the file does not tell."""
    try:
        told = json.loads(path.read_text(encoding="utf-8"))["seconds"]
        return {str(name): float(seconds) for name, seconds in told.items()}
    except (OSError, ValueError, KeyError, TypeError, AttributeError, RecursionError):
        return {}
