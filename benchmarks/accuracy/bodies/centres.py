"""Joint centres under soft tissue, joint by joint, beside plain least squares on the same poses."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from kinesphere.geometry.rigid import into_frame
from kinesphere.pipeline import solve
from kinesphere.synthetic import make_performance, spoil_with_soft_tissue

Array = NDArray[np.float64]

SEEDS = range(900, 916)
"""Actors; weights and limits of the fit were chosen on others (800 to 815)."""
STEP = 10
"""Every so many frames are compared."""
KINDS = ("ankle", "knee", "hip", "neck", "shoulder", "elbow")


@dataclass(frozen=True)
class Centre:
    """One joint of one actor; distances that stay the same over time, in the parent's frame."""

    actor: int
    joint: str
    ours_mm: float
    plain_mm: float
    """Of plain SCoRE (least squares, no weights, no expectation) on the solved poses."""


def centre_rows() -> list[Centre]:
    """Return a row a joint of every actor."""
    return [row for seed in SEEDS for row in _rows(seed)]


def _rows(seed: int) -> list[Centre]:
    performance = make_performance(
        np.random.default_rng(seed), layout="bodies", calibration_s=60, free_s=10
    )
    rng = np.random.default_rng(seed + 1)
    recording = spoil_with_soft_tissue(performance.recording, rng, performance)
    motion = solve(recording, performance.model).motion
    names = list(performance.skeleton.joint_names)
    rows = []
    for joint in motion.skeleton.joints:
        parent, child = (motion.skeleton.limb_names.index(x) for x in (joint.parent, joint.child))
        rotations, origins = motion.rotations[::STEP], motion.origins[::STEP]
        truth = performance.joint_centres[::STEP, names.index(joint.name)]
        seen = np.nanmean(into_frame(rotations[:, parent], origins[:, parent], truth[:, None]), 0)
        plain = _plain(
            np.swapaxes(rotations[:, parent], 1, 2) @ rotations[:, child],
            into_frame(rotations[:, parent], origins[:, parent], origins[:, child, None])[:, 0],
        )
        off = [1e3 * float(np.linalg.norm(x - seen[0])) for x in (joint.centre_in_parent, plain)]
        rows.append(Centre(seed, joint.name, *off))
    return rows


def _plain(rotations: Array, shifts: Array) -> Array:
    """Return the least-squares common point of two limbs in the first one's frame, (3,) m."""
    known = np.isfinite(rotations).all(axis=(1, 2)) & np.isfinite(shifts).all(axis=1)
    own = np.broadcast_to(np.eye(3), rotations[known].shape)
    columns = np.concatenate([own, -rotations[known]], axis=2).reshape(-1, 6)
    centre: Array = np.linalg.lstsq(columns, shifts[known].ravel(), rcond=None)[0][:3]
    return centre


def centres_section(rows: Sequence[dict[str, Any]]) -> str:
    """Return the page's section."""
    actors = len({row["actor"] for row in rows})
    lines = [
        "## Joint centres under soft tissue, joint by joint\n",
        f"{actors} actors with soft tissue, 60 s of calibration movements and 10 s of free motion; "
        "marker bodies are given, no landmarks are. *Plain* is least squares (SCoRE without "
        "weights, expectation or model of skin) on the same solved poses. Knees and elbows with "
        "what lies along their axis.\n",
        "| joint | centres | median | rms | worst | plain, median | rms | worst |",
        "|---|---:|---:|---:|---:|---:|---:|---:|",
    ]
    for kind in KINDS:
        mine = [row for row in rows if row["joint"].endswith(kind)]
        told = [_told([row[which] for row in mine]) for which in ("ours_mm", "plain_mm")]
        lines.append(f"| {kind} | {len(mine)} | {' | '.join(told)} |")
    return "\n".join(lines) + "\n"


def _told(off: Sequence[float]) -> str:
    x = np.array(off)
    return f"{np.median(x):.1f} mm | {np.sqrt(np.mean(x**2)):.1f} mm | {x.max():.1f} mm"
