"""Section 2e: whether axes that are wrong are said to be, and right ones left in peace."""

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.axes.bars import number
from benchmarks.axes.generator import (
    CONES,
    NOISES,
    RATE,
    SWAY,
    Array,
    TrueJoint,
    drift,
    joint_of,
    make_calibration,
    make_free_motion,
    wander,
)
from benchmarks.axes.measures import found_at_joints, line_angles
from kinesphere.parameterization import AxesSettings, ParameterizationSettings, parameterize

FIRST_SEED = 20_000
FREE_JOINTS, JOINTS = 12, 40
WRONG, RIGHT = 10.0, 5.0  # deg
CADENCE, UNSTEADY = 0.9, 0.05  # Hz, and share by which it wanders
FREE = ParameterizationSettings(axes=AxesSettings(method="universal-joint", counts="joint_01=2"))
TWO = ParameterizationSettings(axes=AxesSettings(counts="joint_01=2"))
USUAL = ParameterizationSettings()


def one_rhythm(
    rng: np.random.Generator, reaches: tuple[float, float, float], drifting: float = 0.0
) -> TrueJoint:
    """Return 20 s of a gait: both angles and the twist, so many deg, share one rhythm."""
    n = round(RATE * 20.0)
    phase = 2 * np.pi * np.cumsum(CADENCE * (1 + UNSTEADY * wander(rng, n, 1)[:, 0])) / RATE
    angles = np.empty((n, 3))
    for k, reach in enumerate(reaches):
        first, second = rng.uniform(0, 2 * np.pi, 2)
        wave = np.sin(phase + first) + (0.3 * np.sin(2 * phase + second) if k < 2 else 0.0)
        angles[:, k] = np.deg2rad(reach) * wave / np.abs(wave).max()
        if drifting:
            angles[:, k] += np.deg2rad(drifting) * drift(rng, n)
    return joint_of(rng, CONES["60–120°"], NOISES["OU 1°"], angles)


def swings(rng: np.random.Generator, noise: str, across: float, twisting: float) -> TrueJoint:
    """Return eight swings of ±45° about the distal axis.

    Up to ``across`` deg about the other go with it, a third of a quarter to a quarter of a turn
    ahead, and ``twisting`` rad a rad of twist.
    """
    n = round(RATE * 60.0)
    t = np.arange(n) / RATE
    angles = np.deg2rad(SWAY) * wander(rng, n, 3)
    reach = rng.uniform(across / 3, across)
    for start in np.linspace(2, 54, 8):
        during = (t >= start) & (t < start + 2)
        turn = np.pi * (t[during] - start)
        swing = np.deg2rad(45.0) * np.sin(turn)
        angles[during, 0] += swing
        angles[during, 1] += np.deg2rad(reach) * np.sin(turn + rng.uniform(0.6, 1.2))
        angles[during, 2] += twisting * swing
    return joint_of(rng, CONES["60–120°"], NOISES[noise], angles)


Made = tuple[Callable[[np.random.Generator], TrueJoint], ParameterizationSettings, int]
CONDITIONS: Mapping[str, Made] = {
    "free, 20 s, one rhythm, ±30° and ±8°": (
        lambda rng: one_rhythm(rng, (30.0, 8.0, 8.0)),
        FREE,
        FREE_JOINTS,
    ),
    "free, 20 s, one rhythm, ±40° and ±25°": (
        lambda rng: one_rhythm(rng, (40.0, 25.0, 10.0)),
        FREE,
        FREE_JOINTS,
    ),
    "free, 20 s, one rhythm and drift of ±15°": (
        lambda rng: one_rhythm(rng, (40.0, 25.0, 10.0), 15.0),
        FREE,
        FREE_JOINTS,
    ),
    "free, 20 s, rhythms": (
        lambda rng: make_free_motion(rng, CONES["60–120°"], NOISES["OU 1°"], twist=10.0),
        FREE,
        FREE_JOINTS,
    ),
    "free, 20 s, no rhythm": (
        lambda rng: make_free_motion(
            rng, CONES["60–120°"], NOISES["OU 1°"], twist=10.0, rhythm=False
        ),
        FREE,
        FREE_JOINTS,
    ),
    "swings on an ellipse": (lambda rng: swings(rng, "tissue", 25.0, 0.0), USUAL, JOINTS),
    "swings about one of two axes": (lambda rng: swings(rng, "OU 1°", 0.0, 0.0), TWO, JOINTS),
    "the same, twisting with the angle": (lambda rng: swings(rng, "OU 1°", 0.0, 0.4), TWO, JOINTS),
    "calibration, 1° correlated": (
        lambda rng: make_calibration(rng, CONES["60–120°"], NOISES["OU 1°"]),
        USUAL,
        JOINTS,
    ),
    "calibration, soft tissue": (
        lambda rng: make_calibration(rng, CONES["60–120°"], NOISES["tissue"]),
        USUAL,
        JOINTS,
    ),
}
TASKS = [
    (name, FIRST_SEED + seed) for name, (_, _, count) in CONDITIONS.items() for seed in range(count)
]


def run(condition: str, seed: int) -> dict[str, Any]:
    """Return the error of the worst axis the movement told, and whether anything was said."""
    make, settings, _ = CONDITIONS[condition]
    joint = make(np.random.default_rng([seed, list(CONDITIONS).index(condition)]))
    solved = parameterize(joint.motion, settings)
    found = solved.skeleton.joints[0]
    told = found_at_joints(solved.history)[found.name]
    mine = [k for k, source in enumerate(found.axes_sources) if source == "movement"]
    half = 0 < len(mine) < len(found.axes_sources)
    said = told["remark"] if half else told["doubts"]
    uncertainty = np.rad2deg(np.asarray(found.axes_uncertainty))[mine]
    return {
        "condition": condition,
        "served": bool(mine),
        "said": bool(said),
        "error_deg": _worst(np.asarray(found.axes)[mine], np.asarray(found.rest), joint)
        if mine
        else None,
        "told_deg": float(uncertainty.max()) if mine else None,
    }


def _worst(axes: Array, rest: Array, joint: TrueJoint) -> float:
    """Return the largest error, deg; of two axes in either order, which small turns hardly tell."""
    if len(axes) == 1:
        return float(min(line_angles(axes[0], true) for true in joint.axes))
    same = np.array([rest.T @ axes[0], axes[1]])
    return float(min(line_angles(pair, joint.axes).max() for pair in (same, axes[::-1])))


def section(
    run_all: Callable[[str, Callable[..., Any], Sequence[tuple[Any, ...]]], list[Any]], _: Path
) -> dict[str, Any]:
    """Return the figures."""
    rows = run_all("doubts", run, TASKS)
    return {
        "doubts": {
            name: _summed([row for row in rows if row["condition"] == name]) for name in CONDITIONS
        }
    }


def _summed(rows: Sequence[dict[str, Any]]) -> dict[str, Any]:
    served = [row for row in rows if row["served"]]
    wrong = [row for row in served if row["error_deg"] > WRONG]
    right = [row for row in served if row["error_deg"] < RIGHT]
    errors = np.array([row["error_deg"] for row in served])
    told = np.array([row["told_deg"] for row in served])
    return {
        "joints": len(rows),
        "served": len(served),
        "wrong": len(wrong),
        "wrong_unsaid": sum(not row["said"] for row in wrong),
        "right": len(right),
        "right_said": sum(row["said"] for row in right),
        "error_deg": float(np.sqrt((errors**2).mean())) if served else None,
        "told_deg": float(np.sqrt((told**2).mean())) if served else None,
    }


_BEFORE = """\
### 2e Wrong axes, and whether it is said

Free motion is solved by `universal-joint`, all else by default; twist of ±8 to 10°, 1° of
correlated noise but where soft tissue is named. *Wrong*: the worse axis that comes from the
movement is more than {wrong:.0f}° off; *right*: less than {right:.0f}°. *Unsaid*: no doubt and no
remark goes with it. Joints whose axes are the body's count as not served. Of the others the rms
error, and what is told.

| motion | joints | served | wrong | unsaid | right | doubted | error, ° | told, ° |
|---|---:|---:|---:|---:|---:|---:|---:|---:|"""


def page(table: Mapping[str, Any]) -> str:
    """Return the section."""
    if not table:
        return ""
    lines = [_BEFORE.format(wrong=WRONG, right=RIGHT)]
    names = ("joints", "served", "wrong", "wrong_unsaid", "right", "right_said")
    for motion, row in table.items():
        figures = [
            number(row[name]) if row["served"] else "–" for name in ("error_deg", "told_deg")
        ]
        lines.append(
            "| " + " | ".join([motion, *(str(row[name]) for name in names), *figures]) + " |"
        )
    return "\n".join([*lines, ""])
