"""Section 2b: a third axis, found where a limb turns about itself on purpose, and only there."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from benchmarks.axes.bars import number
from benchmarks.axes.generator import (
    AMPLITUDES,
    CONES,
    JITTER,
    NOISES,
    RATE,
    SWAY,
    Array,
    TrueJoint,
    draw_axes,
    poses,
    spoil,
    swing,
    wander,
)
from benchmarks.axes.measures import axis_errors, line_angles
from kinesphere.data import Parameters
from kinesphere.geometry.rotations import rotation_exp
from kinesphere.parameterization import AxesSettings, ParameterizationSettings, parameterize

SEEDS = 30
FIRST_SEED = 5000
TWIST = 40.0  # deg to both sides
OFF_LIMB = 10.0  # deg, at most, between the limb's own line and what it turns about
SECONDS = 90.0
MADE = {
    "three axes": "swings about both axes one after another, then turns about the third, ±40°",
    "two axes": "swings about both axes, stands a while, and does not turn about itself",
    "two axes, twisting": "the same, and turns about itself by ±15° while it swings",
    "one axis": "swings about one axis only",
    "one axis and a twist": "swings about one axis, then turns about another near itself, ±40°",
}
TURNING = ("three axes", "one axis and a twist")
NAMES = tuple(NOISES)
JOINT = "joint_01"


def make(rng: np.random.Generator, kind: str, noise: str) -> tuple[TrueJoint, Array]:
    """Return a joint, and the third axis in its child, (3,)."""
    axes, limb = draw_axes(rng, CONES["60–120°"])
    off = rng.normal(size=3)
    off -= (off @ limb) * limb
    tilt = np.deg2rad(rng.uniform(0, OFF_LIMB)) * np.cross(limb, off / np.linalg.norm(off))
    third = rotation_exp(tilt) @ limb if kind in TURNING else limb
    n = round(RATE * SECONDS)
    t = np.arange(n) / RATE
    angles = np.deg2rad(SWAY) * wander(rng, n, 3)
    about = np.zeros((n, 3), dtype=bool)
    play = np.deg2rad(15.0) * swing(rng, n)
    for i, start in enumerate(np.linspace(2, SECONDS - 4, 12)):
        axis = i // 4
        if axis == 1 and kind.startswith("one"):
            axis = 0
        if axis == 2 and kind not in TURNING:
            continue
        during = (t >= start) & (t < start + 2)
        reach = np.deg2rad((*AMPLITUDES, TWIST)[axis]) * rng.uniform(1 - JITTER, 1 + JITTER)
        course = np.sin(np.pi * (t[during] - start))
        angles[during, axis] += reach * course
        if kind == "two axes, twisting":
            angles[during, 2] += play[during] * np.abs(course)
        about[during, axis] = True
    clean = poses(axes, np.eye(3), third, angles)
    moved = np.column_stack([angles.sum(axis=1), np.zeros(n)])  # all of it drags the skin along
    rotations = spoil(rng, clean, moved, NOISES[noise])
    return TrueJoint(rotations, limb, axes, np.eye(3), angles, about), third


def run(kind: str, noise: str, seed: int) -> dict[str, float]:
    """Return how many axes are found, how far off they are, and what a twist does to the others."""
    joint, third = make(np.random.default_rng(seed), kind, noise)
    found = parameterize(joint.motion)
    two = parameterize(joint.motion, _settings(2 if joint.about[:, 1].any() else 1))
    solved = found.skeleton.joints[0]
    told: dict[str, float] = {"n_axes": float(solved.n_axes)}
    if kind in TURNING:
        told["two_error_deg"] = _swing_error(two, joint)
        told["two_cross_talk_deg"] = _cross_talk(two, joint)
        if solved.n_axes == 3 and solved.axes is not None:
            in_child = np.asarray(solved.rest).T @ solved.axes[0]
            told["third_error_deg"] = float(line_angles(in_child, third))
            told["limb_error_deg"] = float(line_angles(joint.long_axis, third))
            told["swing_error_deg"] = _swing_error(found, joint)
            told["cross_talk_deg"] = _cross_talk(found, joint)
            assert solved.axes_uncertainty is not None
            told["said_deg"] = float(np.rad2deg(solved.axes_uncertainty[0]))
    return told


def _settings(count: int) -> ParameterizationSettings:
    return ParameterizationSettings(axes=AxesSettings(counts=f"{JOINT}={count}"))


def _swing_error(found: Parameters, joint: TrueJoint) -> float:
    """Return the mean error in deg of the axes that move the limb."""
    solved = found.skeleton.joints[0]
    if solved.axes_source != "movement":
        return 90.0
    axes = np.asarray(solved.axes)
    if not joint.about[:, 1].any():  # a hinge is proximal to whatever was added to it
        return float(line_angles(axes[-1], joint.axes[0]))
    return float(axis_errors(axes[-2:], joint.axes).mean())


def _cross_talk(found: Parameters, joint: TrueJoint) -> float:
    """Return the rms in deg of the angles that move the limb, while it turns about itself."""
    count = found.skeleton.joints[0].n_axes
    swings = found.angles[joint.about[:, 2], 0, max(0, count - 2) : count]
    return float(np.rad2deg(np.sqrt(((swings - np.median(swings, axis=0)) ** 2).mean())))


TASKS = [
    (kind, noise, FIRST_SEED + seed) for kind in MADE for noise in NAMES for seed in range(SEEDS)
]


def summary(results: Sequence[Mapping[str, float]]) -> dict[str, Any]:
    """Return kind → noise → how often each number of axes is found, and medians of the figures."""
    table: dict[str, Any] = {}
    for kind in MADE:
        for noise in NAMES:
            rows = [
                r for (k, n, _), r in zip(TASKS, results, strict=True) if (k, n) == (kind, noise)
            ]
            counts = [r["n_axes"] for r in rows]
            told: dict[str, float] = {
                f"percent_{c}": 100 * float(np.mean([n == c for n in counts])) for c in (1, 2, 3)
            }
            for name in sorted({name for r in rows for name in r} - {"n_axes"}):
                values = [r[name] for r in rows if name in r]
                told[name] = float(np.median(values))
                told["worst_" + name] = float(np.max(values))
            table.setdefault(kind, {})[noise] = told
    return table


_BEFORE = """
**A third axis: what a limb turns about when it turns about itself**

Percent of {seeds} calibrations of 90 s in which one, two and three axes are found, by a joint
nobody named. The limb rests between its movements:

{made}

What it turns about is up to {off:.0f}° off its own line.

| the joint | noise | 1 | 2 | 3 |
|---|---|---:|---:|---:|"""
_HEAD = """
Where there is a third axis: median (worst) error of it, and of the limb's own line in its place;
the standard deviation that is said; error of the axes that move the limb; cross-talk, the rms of
the angles about those while the limb turns about itself, with three axes and with two and a
twist about the limb (one and a twist for the hinge), in degrees.

| the joint | noise | third axis | limb's line | said | other axes | cross-talk | without it |
|---|---|---:|---:|---:|---:|---:|---:|"""
_REAL = """
On the real recordings a third axis is found at these joints and nowhere else:

| recording | joint | s | range, ° | off the limb, ° | halves, ° | said, ° |
|---|---|---|---:|---:|---:|---:|"""


def page(table: Mapping[str, Any], sources: Mapping[str, Sequence[Mapping[str, Any]]]) -> str:
    """Return the part of section 2."""
    made = "\n".join(f"- *{kind}*: {what}" for kind, what in MADE.items())
    lines = [_BEFORE.format(seeds=SEEDS, made=made, off=OFF_LIMB)]
    for kind, rows in table.items():
        for noise, told in rows.items():
            shares = (f"{told[f'percent_{count}']:.0f}" for count in (1, 2, 3))
            lines.append(f"| {kind} | {noise} | " + " | ".join(shares) + " |")
    lines.append(_HEAD)
    names = ("third_error", "limb_error", "said", "swing_error", "cross_talk", "two_cross_talk")
    for kind, rows in table.items():
        for noise, told in rows.items():
            if "third_error_deg" in told:
                cells = (
                    f"{number(told[f'{name}_deg'])} ({number(told[f'worst_{name}_deg'])})"
                    for name in names
                )
                lines.append(f"| {kind} | {noise} | " + " | ".join(cells) + " |")
    lines.append(_REAL)
    for source, joints in sources.items():
        for row in joints:
            if (told := row.get("twist_axis")) is not None:
                spans = ", ".join(f"{a:.0f}–{b:.0f}" for a, b in told["phases_s"])
                figures = ("range_deg", "off_limb_deg", "halves_deg", "said_deg")
                cells = (source, row["joint"].replace("_", " "), spans)
                numbers = (number(told[figure]) for figure in figures)
                lines.append("| " + " | ".join((*cells, *numbers)) + " |")
    return "\n".join(lines) + "\n"
