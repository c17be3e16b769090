"""Section 2d: two axes, about one of which the limb moves far and about the other little."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from benchmarks.axes.bars import number
from benchmarks.axes.generator import JITTER, NOISES, RATE, SWAY, TrueJoint, poses, spoil, wander
from benchmarks.axes.measures import line_angles
from kinesphere.data import Motion
from kinesphere.parameterization import parameterize
from kinesphere.parameterization.anatomy import body_axes

SEEDS = 30
FIRST_SEED = 9500
JOINT, LIMBS = "left_hip", ("pelvis", "left_thigh")
LIMB = np.array([0.0, -1.0, 0.0])
OFF = 8.0  # deg rms about each axis, by which a person's axes are turned from the body frame's
SECONDS, LASTS = 60.0, 2.0
WIDE, SWINGS = 40.0, 4  # deg to both sides
LITTLE = (0.0, 5.0, 8.0, 12.0, 40.0)  # deg to both sides about the other


def make_joint(rng: np.random.Generator, noise: str, little: float, wide: int) -> TrueJoint:
    """Return a hip that swings far about one axis and ``little`` deg about the other.

    ``wide`` is 0 for flexion, 1 for abduction.
    """
    body = body_axes(JOINT)
    assert body is not None
    turned = Rotation.from_rotvec(np.deg2rad(OFF) * rng.normal(size=3)).apply(body[:2])
    axes = turned[::-1]  # distal first
    n = round(RATE * SECONDS)
    t = np.arange(n) / RATE
    angles = np.column_stack([np.deg2rad(SWAY) * wander(rng, n, 2), np.zeros(n)])
    about = np.zeros((n, 2), dtype=bool)
    for i, start in enumerate(np.linspace(2, SECONDS - 4, 2 * SWINGS)):
        axis = 1 - i // SWINGS  # flexion, the proximal one, first
        reach = WIDE if axis == 1 - wide else little
        during = (t >= start) & (t < start + LASTS)
        swing = np.deg2rad(reach) * rng.uniform(1 - JITTER, 1 + JITTER)
        angles[during, axis] += swing * np.sin(2 * np.pi * (t[during] - start) / LASTS)
        about[during, axis] = reach > 0
    clean = poses(axes, np.eye(3), LIMB, angles)
    return TrueJoint(spoil(rng, clean, angles, NOISES[noise]), LIMB, axes, np.eye(3), angles, about)


def named(joint: TrueJoint) -> Motion:
    """Return the joint as the motion of a thigh against its pelvis."""
    plain = joint.skeleton
    base, limb = (replace(one, name=name) for one, name in zip(plain.limbs, LIMBS, strict=True))
    hip = replace(plain.joints[0].without_axes, name=JOINT, parent=LIMBS[0], child=LIMBS[1])
    limbs = (base, replace(limb, parent=LIMBS[0]))
    return replace(joint.motion, skeleton=replace(plain, limbs=limbs, joints=(hip,)))


def run(noise: str, little: float, wide: int, seed: int) -> dict[str, Any]:
    """Return where each axis is from, its error and the body's in deg, and what is said of it."""
    rng = np.random.default_rng(seed)
    joint = make_joint(rng, noise, little, wide)
    solved = parameterize(named(joint)).skeleton.joints[0]
    body = body_axes(JOINT)
    assert body is not None
    said = np.rad2deg(np.asarray(solved.axes_uncertainty))[::-1]
    return {
        "sources": list(solved.axes_sources[::-1]),
        "error_deg": line_angles(np.asarray(solved.axes), joint.axes)[::-1].tolist(),
        "body_deg": line_angles(body[:2], joint.axes[::-1]).tolist(),
        "said_deg": [float(s) if np.isfinite(s) else None for s in said],
    }


TASKS = [
    (noise, little, wide, FIRST_SEED + seed)
    for noise in ("clean", "OU 1°", "OU 3°", "tissue")
    for little in LITTLE
    for wide in (0, 1)
    for seed in range(SEEDS)
]


def summary(results: Sequence[Mapping[str, Any]]) -> dict[str, Any]:
    """Return noise → little → what serves, and errors of the axis moved far and of the other."""
    table: dict[str, Any] = {}
    for noise in dict.fromkeys(task[0] for task in TASKS):
        for little in LITTLE:
            rows = [
                (wide, r)
                for (a, b, wide, _), r in zip(TASKS, results, strict=True)
                if (a, b) == (noise, little)
            ]
            told = [(w, r) for w, r in rows if r["sources"][w] == "movement"]
            both = [r for _, r in told if "body" not in r["sources"]]
            wrong = [r for w, r in rows if r["sources"][1 - w] == "movement" and r not in both]
            one = [(w, r) for w, r in told if "body" in r["sources"]]
            table.setdefault(noise, {})[f"{little:g}"] = {
                "one_percent": 100 * len(one) / len(rows),
                "both_percent": 100 * len(both) / len(rows),
                "wrong_percent": 100 * len(wrong) / len(rows),
                "error_deg": _rms(r["error_deg"][w] for w, r in told),
                "said_deg": _rms(r["said_deg"][w] for w, r in told),
                "body_deg": _rms(r["body_deg"][w] for w, r in rows),
                "other_deg": _rms(r["error_deg"][1 - w] for w, r in one),
                "other_body_deg": _rms(r["body_deg"][1 - w] for w, r in one),
            }
    return table


def _rms(values: Any) -> float | None:
    some = np.array(list(values))
    return float(np.sqrt(np.mean(some**2))) if len(some) else None


_BEFORE = """\
### 2d Two axes, about one of which the limb hardly moves

Hips whose axes are turned by {off:.0f}° (rms about each axis of the body) from the body's. They
swing four times by ±{wide:.0f}° about one axis, flexion or abduction, and four times by a *little*
about the other; {seeds} for each row. Percent of them in which only the wide one is told and the
other put across it, in which both are, and in which the wrong one is; rms errors in degrees, of the
wide axis where it is told, what is said of it, and the body frame's in its place; then of the other
where it was put across, and the body frame's.

| noise | little, ° | one | both | wrong | wide axis | said | *body's* | other | *body's* |
|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|"""
_AFTER = """
An axis that is put across another is a little nearer than the body frame's: of the turn between a
person's axes and the body's it still lacks what is about the axis that is told.
"""


def page(table: Mapping[str, Any]) -> str:
    """Return the section."""
    if not table:
        return ""
    lines = [_BEFORE.format(off=OFF, wide=WIDE, seeds=2 * SEEDS)]
    for noise, rows in table.items():
        for little, cell in rows.items():
            shares = (f"{cell[f'{name}_percent']:.0f}" for name in ("one", "both", "wrong"))
            names = ("error", "said", "body", "other", "other_body")
            figures = (number(cell[f"{name}_deg"]) for name in names)
            lines.append("| " + " | ".join((noise, f"±{little}", *shares, *figures)) + " |")
    return "\n".join([*lines, _AFTER])
