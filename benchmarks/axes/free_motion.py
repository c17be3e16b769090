"""Section 2, second half: axes from free motion, without any calibration."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from benchmarks.axes import prototype
from benchmarks.axes.bars import Bar, number
from benchmarks.axes.estimators import DEFAULT, SEEDS, cell, head, shown, whole_stage
from benchmarks.axes.generator import CONES, NOISES, Array, TrueJoint, make_free_motion
from benchmarks.axes.measures import line_angles
from kinesphere.parameterization import AxesSettings, ParameterizationSettings
from kinesphere.parameterization.axes import find_axes
from kinesphere.parameterization.view import view_joint
from kinesphere.parameterization.zero import movement_rest

LIKELIEST, LEAST_SQUARES = "universal-joint", "universal-joint, axes.refine=no"
JOINING = "direction-joining"
METHODS = (LIKELIEST, LEAST_SQUARES, JOINING, DEFAULT)
LIMIT = 2.0
ALL_NOISES = ("clean", "iid 1°", "iid 3°", "OU 1°", "OU 3°")
LONG_NOISES = ("OU 1°",)
FEW = 10  # joints that are tried with the other noises


@dataclass(frozen=True)
class Free:
    """A way to move freely."""

    twist: float
    """deg, to both sides."""
    seconds: float
    noises: tuple[str, ...] = LONG_NOISES
    """Names of those it is tried with."""
    rhythm: bool = True
    """Whether angles are made of a few frequencies each."""


MOTIONS = {
    "20 s without twist": Free(0.0, 20.0, ALL_NOISES),
    "20 s, ±10° of twist": Free(10.0, 20.0, ALL_NOISES),
    "60 s, ±10° of twist": Free(10.0, 60.0),
    "120 s, ±10° of twist": Free(10.0, 120.0),
    "20 s, ±30° of twist": Free(30.0, 20.0, ALL_NOISES),
    "120 s, ±30° of twist": Free(30.0, 120.0),
    "60 s, ±10° of twist, no rhythm": Free(10.0, 60.0, rhythm=False),
}
TASKS = [
    (motion, noise, 3000 + seed)
    for motion, free in MOTIONS.items()
    for noise in free.noises
    for seed in range(SEEDS if noise in LONG_NOISES else FEW)
]


def make(motion: str, noise: str, seed: int) -> TrueJoint:
    """Return one joint in free motion."""
    free = MOTIONS[motion]
    rng = np.random.default_rng(seed)
    return make_free_motion(
        rng,
        CONES["60–120°"],
        NOISES[noise],
        twist=free.twist,
        seconds=free.seconds,
        rhythm=free.rhythm,
    )


def run(motion: str, noise: str, seed: int) -> dict[str, list[float]]:
    """Return method → errors of both axes in deg.

    The proximal axis is compared in the parent, the distal one in the child: there each is fixed
    whatever pose serves as rest.
    """
    joint = make(motion, noise, seed)
    errors = {}
    for method in METHODS:
        axes, rest = _whole(joint) if method == DEFAULT else _alone(joint, method)
        if len(axes) < 2:
            errors[method] = [90.0, 90.0]
            continue
        pairs = ((rest.T @ axes[0], joint.rest.T @ joint.axes[0]), (axes[1], joint.axes[1]))
        errors[method] = [float(line_angles(a, b)) for a, b in pairs]
    return errors


def _whole(joint: TrueJoint) -> tuple[Array, Array]:
    axes, rest, source = whole_stage(joint)
    return axes if source == "movement" else np.empty((0, 3)), rest


def _alone(joint: TrueJoint, method: str) -> tuple[Array, Array]:
    """Return axes, (n_found, 3), and rest, (3, 3), of an estimator by itself."""
    options = AxesSettings(method=method.partition(",")[0], refine=method != LEAST_SQUARES)
    settings = ParameterizationSettings(axes=options)
    everywhere = np.ones(len(joint.rotations), dtype=bool)
    view = view_joint(
        "joint_01",
        joint.rotations,
        joint.long_axis,
        everywhere,
        joint.motion.rate,
        everywhere,
        settings,
    )
    found = find_axes(view.samples, 2, options)
    if len(found) < 2:
        return found, np.eye(3)
    axes, rest, _ = movement_rest(view, found, np.zeros(2), settings)
    return axes, rest


def summary(results: list[dict[str, list[float]]]) -> dict[str, Any]:
    """Return motion → method → noise → statistics."""
    table: dict[str, Any] = {}
    for motion, free in MOTIONS.items():
        for noise in free.noises:
            for method in METHODS:
                errors = [
                    r[method]
                    for (m, n, _), r in zip(TASKS, results, strict=True)
                    if (m, n) == (motion, noise)
                ]
                table.setdefault(motion, {}).setdefault(method, {})[noise] = cell(errors)
    return table


def bars(table: dict[str, Any]) -> list[Bar]:
    """Return what is asked of the method made for free motion."""
    return [
        Bar(
            "Axes",
            f"free motion, `{LIKELIEST}` by name, {motion}, OU 1°: median error",
            rows[LIKELIEST]["OU 1°"]["median_deg"],
            "deg",
            LIMIT,
            beside=not MOTIONS[motion].twist,
        )
        for motion, rows in table.items()
    ]


_BEFORE = """
**Free motion: both axes at once, no calibration, cones 60–120°**; {few} joints instead of {all} but
in the column OU 1°.
"""
_AFTER = """
The proximal axis is compared in the parent, the distal one in the limb, where each is fixed, the
limb at its usual twist. Estimators that wait for one movement at a time cannot work here; a method
that found no axes, or fell back to the body's, counts as 90° off. That is what the defaults do in
free motion: they say that no axes were found, and the body's serve. The figures held to a number
are those of `universal-joint`, which is to be chosen by name (`--set axes.method=universal-joint`).

Two axes and a twist rebuild every pose, so no pose says anything about the axes. What is left is
what the angles are like in time. Rows in *italics* that start from the truth are yardsticks, not
methods. *Least twist*: the axes that need least twist frame by frame. *What the data hold*: axes of
maximum likelihood for somebody who knows that every angle is made of three frequencies, as these
are, though not which, and who knows what the errors are; nobody can do better for long. Where there
is no rhythm: for somebody who knows the band of every angle's noise, its size and the errors.

`universal-joint` takes each angle as a process in time: about the right axes the three go their own
ways, about wrong ones they are mixtures. It has three descriptions of them, smooth processes
(`axes/processes.py`), such that rest in some movements while others go on, and sums of rhythms
(`axes/spectra.py`), and takes the axes of the likeliest. None knows how these angles were made, but
the last suits them; *no rhythm* is the same band of frequencies as noise, of which nothing returns:
there less can be told. That real people's angles go their own ways is an assumption; where a person
couples them (and daily motion does), the axes are those of the coupling.
"""


def page(table: dict[str, Any], floor: dict[str, Any], held: dict[str, Any]) -> str:
    """Return the rest of the section."""
    lines = [_BEFORE.format(few=FEW, all=SEEDS), *head(ALL_NOISES)]
    for motion, rows in table.items():
        for method, row in rows.items():
            lines.append(_line(f"{method}, {motion}", row))
        if motion in floor:
            lines.append(_line(f"*least twist from the truth, {motion}*", floor[motion]))
        if motion in held:
            lines.append(_line(f"*what the data hold, {motion}*", held[motion]))
        if motion == next(iter(MOTIONS)):
            lines.append("| *universal-joint, prototype* | " + " | ".join(prototype.FREE) + " |")
    return "\n".join([*lines, _AFTER, _told(held)])


def _told(held: dict[str, Any]) -> str:
    bounds = (f"{number(row['OU 1°']['bound_deg'])}° in {name}" for name, row in held.items())
    said = "Cramér and Rao's bounds on *what the data hold* (rms, median of the joints): "
    return f"{said}{'; '.join(bounds)}.\n" if held else ""


def _line(name: str, row: dict[str, Any]) -> str:
    cells = (shown(row[noise]) if noise in row else "" for noise in ALL_NOISES)
    return f"| {name} | " + " | ".join(cells) + " |"
