"""Section 2: how far off movement axes are, method by method."""

from collections.abc import Iterable
from typing import Any

import numpy as np

from benchmarks.axes import prototype
from benchmarks.axes.bars import Bar
from benchmarks.axes.generator import (
    CONES,
    NOISES,
    Array,
    TrueJoint,
    make_calibration,
    make_free_motion,
)
from benchmarks.axes.measures import axis_errors, line_angles
from kinesphere.parameterization import AxesSettings, ParameterizationSettings, parameterize
from kinesphere.parameterization.axes import AXES, find_axes
from kinesphere.parameterization.view import view_joint

NAMED = (
    "pca",
    "em",
    "em-restarts",
    "direction-joining",
    "small-circle",
    "phase-log-pca",
    "sara",
    "universal-joint",
)
METHODS = (*NAMED, *(method for method in AXES if method not in NAMED))
DEFAULT = "as delivered"
"""The whole stage with its defaults: main movements picked, order found, doubts named."""
SEEDS = 30
FIRST_SEED = 1000
FAILED = 15.0  # deg
LIMITS = {"iid 1°": 0.2, "OU 1°": 0.6, "OU 3°": 1.8}
FREE_TWISTS = {"without twist": 0.0, "±10° of twist": 10.0, "±30° of twist": 30.0}
FREE_NOISES = ("clean", "iid 1°", "iid 3°", "OU 1°", "OU 3°")
FREE_METHODS = ("universal-joint", "direction-joining", DEFAULT)
FREE_LIMIT = 2.0


def run(cone: str, noise: str, seed: int) -> dict[str, list[float]]:
    """Return method → errors of both axes in deg on one calibration."""
    joint = make_calibration(np.random.default_rng(seed), CONES[cone], NOISES[noise])
    everywhere = np.ones(len(joint.rotations), dtype=bool)
    samples = view_joint(
        "joint_01",
        joint.rotations,
        joint.long_axis,
        everywhere,
        joint.motion.rate,
        everywhere,
        ParameterizationSettings(),
    ).samples
    found = {
        method: axis_errors(find_axes(samples, 2, AxesSettings(method=method)), joint.axes)
        for method in METHODS
    }
    delivered, _, source = whole_stage(joint)
    trusted = source == "movement"
    found[DEFAULT] = axis_errors(delivered if trusted else np.empty((0, 3)), joint.axes)
    return {name: [float(e) for e in errors] for name, errors in found.items()}


def whole_stage(joint: TrueJoint, **options: Any) -> tuple[Array, Array, str]:
    """Return the axes, (2, 3), and rest, (3, 3), that the whole stage finds, and their source."""
    settings = ParameterizationSettings(axes=AxesSettings(counts="joint_01=2", **options))
    solved = parameterize(joint.motion, settings).skeleton.joints[0]
    return np.asarray(solved.axes), np.asarray(solved.rest), str(solved.axes_source)


def run_free(noise: str, twist: str, seed: int) -> dict[str, list[float]]:
    """Return method → errors of both axes in deg in free motion.

    The proximal axis is compared in the parent, the distal one in the child: there each is fixed
    whatever pose serves as rest.
    """
    joint = make_free_motion(
        np.random.default_rng(seed), CONES["60–120°"], NOISES[noise], twist=FREE_TWISTS[twist]
    )
    errors = {}
    for method in FREE_METHODS:
        options = {} if method == DEFAULT else {"method": method, "on_doubt": "movement"}
        axes, rest, source = whole_stage(joint, **options)
        pairs = ((rest.T @ axes[0], joint.rest.T @ joint.axes[0]), (axes[1], joint.axes[1]))
        found = [float(line_angles(a, b)) for a, b in pairs]
        errors[method] = found if source == "movement" else [90.0, 90.0]
    return errors


TASKS = [
    (cone, noise, FIRST_SEED + seed) for cone in CONES for noise in NOISES for seed in range(SEEDS)
]
FREE_TASKS = [
    (noise, twist, 3000 + seed)
    for twist in FREE_TWISTS
    for noise in FREE_NOISES
    for seed in range(SEEDS)
]


def cell(errors: list[list[float]]) -> dict[str, float]:
    """Return median of the mean error, p90 of the worst, and percent failed of runs, (n, 2) deg."""
    both = np.array(errors)
    worst = both.max(axis=1)
    return {
        "median_deg": float(np.median(both.mean(axis=1))),
        "p90_worst_deg": float(np.percentile(worst, 90)),
        "failed_percent": 100 * float((worst > FAILED).mean()),
        "worst_deg": float(worst.max()),
    }


def summary(results: list[dict[str, list[float]]]) -> dict[str, Any]:
    """Return cone → method → noise → statistics."""
    table: dict[str, Any] = {}
    for cone in CONES:
        for method in (*METHODS, DEFAULT):
            for noise in NOISES:
                errors = [
                    r[method]
                    for (c, n, _), r in zip(TASKS, results, strict=True)
                    if (c, n) == (cone, noise)
                ]
                table.setdefault(cone, {}).setdefault(method, {})[noise] = cell(errors)
    return table


def summary_free(results: list[dict[str, list[float]]]) -> dict[str, Any]:
    """Return twist → method → noise → statistics."""
    table: dict[str, Any] = {}
    for twist in FREE_TWISTS:
        for method in FREE_METHODS:
            for noise in FREE_NOISES:
                errors = [
                    r[method]
                    for (n, t, _), r in zip(FREE_TASKS, results, strict=True)
                    if (n, t) == (noise, twist)
                ]
                table.setdefault(twist, {}).setdefault(method, {})[noise] = cell(errors)
    return table


def bars(table: dict[str, Any], free: dict[str, Any]) -> list[Bar]:
    """Return what is asked of the default estimator, and of free motion."""
    default = table["60–120°"][DEFAULT]
    asked = [
        Bar(
            "Axes",
            f"default, cones 60–120°, {noise}: median error",
            default[noise]["median_deg"],
            "deg",
            limit,
        )
        for noise, limit in LIMITS.items()
    ]
    for name, rows in (
        ("default", default),
        ("phase-log-pca alone", table["60–120°"]["phase-log-pca"]),
    ):
        worst = max(rows[noise]["worst_deg"] for noise in ("clean", *LIMITS))
        asked.append(
            Bar("Axes", f"{name}, up to OU 3°: worst axis of all runs", worst, "deg", FAILED)
        )
    for twist, rows in free.items():
        asked.append(
            Bar(
                "Axes",
                f"free motion, {twist}, OU 1°: median error",
                rows["universal-joint"]["OU 1°"]["median_deg"],
                "deg",
                FREE_LIMIT,
            )
        )
    return asked


_BEFORE = """\
## 2 Movement axes

Median of the mean error of both axes / 90th percentile of the worse axis, in degrees / percent of
runs with an axis more than 15° off; {seeds} calibrations each. The *cone* is the angle between the
limb and its axes: at 90° it sweeps a great circle. Rows by name run the estimator alone on the
default filter's phases; *as delivered* is the whole stage with its defaults. Where that doubts what
it found and falls back to the body's axes, saying so, both axes count as 90° off.
"""
_MEANING = """
Position-only methods that fit planes through the joint (PCA, EM, Direction Joining) assume a great
circle. A limb at 75° to its axes makes them wrong by a little more than the missing 15°, and
*without any noise*; more data do not help. Methods that use orientations, or circles of any size,
do not have this bias. PCA fails even on great circles, because the directions of movements need
not be perpendicular. EM fails now and then from the PCA start and hardly ever from many starts:
the paper's argument against it is an argument against its start.

**Free motion: both axes at once for 20 s, no calibration, cones 60–120°**
"""
_AFTER = """
The proximal axis is compared in the parent, the distal one in the limb, where each is fixed.
Estimators that wait for one movement at a time cannot work here; a method that found no axes, or
fell back to the body's, counts as 90° off. *Least twist from the truth* is a yardstick, not a
method: two axes and a twist rebuild every pose, so all that speaks for one pair of axes against
another is that people twist little. The axes that need least twist, searched from the true ones,
show about how much 20 s can tell. Whoever wants better axes in spite of slow twist needs longer
motion, or must know more than the poses.
"""


def page(table: dict[str, Any], free: dict[str, Any], floor: dict[str, Any]) -> str:
    """Return the section."""
    lines = [_BEFORE.format(seeds=SEEDS)]
    for cone, rows in table.items():
        low, high = CONES[cone].between
        apart = f"{low:.0f}°" if low == high else f"{low:.0f}–{high:.0f}°"
        lines += [f"**Cone {cone}, axes {apart} apart**\n", *_head(NOISES)]
        for method, row in rows.items():
            name = f"**{method}**" if method == DEFAULT else method
            lines.append(f"| {name} | " + " | ".join(_shown(r) for r in row.values()) + " |")
            if before := prototype.AXES.get(cone, {}).get(method):
                lines.append(f"| *{method}, prototype* | " + " | ".join(before) + " |")
        lines.append("")
    lines += [_MEANING, *_head(FREE_NOISES)]
    for twist, rows in free.items():
        for method, row in rows.items():
            cells = " | ".join(_shown(r) for r in row.values())
            lines.append(f"| {method}, {twist} | {cells} |")
        cells = " | ".join(_shown(r) for r in floor[twist].values())
        lines.append(f"| *least twist from the truth, {twist}* | {cells} |")
        if twist == "without twist":
            lines.append("| *universal-joint, prototype* | " + " | ".join(prototype.FREE) + " |")
    return "\n".join([*lines, _AFTER])


def _head(columns: Iterable[str]) -> list[str]:
    names = list(columns)
    return ["| method | " + " | ".join(names) + " |", "|---|" + "---:|" * len(names)]


def _shown(row: dict[str, float]) -> str:
    return f"{row['median_deg']:.2f}/{row['p90_worst_deg']:.2f}/{row['failed_percent']:.0f}"
