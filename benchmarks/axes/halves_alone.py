"""Section 6: knee axes of halves that know nothing of each other, as a user would solve them."""

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.accuracy.bodies.functional import half_of
from benchmarks.axes.bars import Bar, number
from benchmarks.axes.measures import line_angles
from benchmarks.axes.same_person import turned
from kinesphere import read
from kinesphere.data import Solution
from kinesphere.labelling import choose_model

AGREE = 1.5
"""deg, most that is asked of halves."""
KNEES = {"left knee": "Test_func_lknee", "right knee": "Test_func_rknee"}


def tasks(data: Path) -> list[tuple[Any, ...]]:
    """Return what to run."""
    paths = [(name, data / "functional" / f"{trial}.c3d") for name, trial in KNEES.items()]
    return [(name, path) for name, path in paths if path.is_file()]


def run(name: str, path: Path) -> tuple[str, float | None]:
    """Return a knee's name, and the angle in deg between its axes by the trial's halves.

    Each half is solved as if it was all of the recording; the thigh's markers lay one on the other.
    """
    recording = read(path)
    model = choose_model(recording)
    assert model is not None
    middle = recording.n_frames // 2
    halves = [half_of(recording, model, part) for part in (slice(middle), slice(middle, None))]
    joint = name.replace(" ", "_")
    turn = turned(*(_thigh(half, joint) for half in halves))
    axes = [half.skeleton.joint(joint) for half in halves]
    if turn is None or any(axis.axes_source != "movement" for axis in axes):
        return name, None
    first, second = (np.asarray(axis.axes)[0] for axis in axes)
    return name, float(line_angles(turn @ first, second))


def _thigh(solution: Solution, joint: str) -> dict[str, np.ndarray]:
    limb = solution.skeleton.limb(solution.skeleton.joint(joint).parent)
    return dict(zip(limb.markers, limb.marker_positions, strict=True))


def section(
    run_all: Callable[[str, Callable[..., Any], Sequence[tuple[Any, ...]]], list[Any]], data: Path
) -> dict[str, Any]:
    """Return the figures."""
    return {"alone": dict(run_all("halves alone", run, tasks(data)))}


def bars(found: Mapping[str, float | None]) -> list[Bar]:
    """Return what is asked of them."""
    return [
        Bar(
            "Repeatability",
            f"{name}: axis, each half solved by itself",
            float("nan") if angle is None else angle,
            "deg",
            AGREE,
        )
        for name, angle in found.items()
    ]


def page(found: Mapping[str, float | None]) -> str:
    """Return the paragraph."""
    if not found:
        return ""
    told = ", ".join(f"{name} {number(angle)}°" for name, angle in found.items())
    return f"""
A user who wonders solves the first half of a trial and the second, each as if it was all there is,
and lays the thigh's markers one on the other: {told}. The table has the axes of both halves
by the limb poses of the whole trial instead. Neither is the truer one: shapes of limbs are measured
anew in each half here and shared there, and the difference between both shows how much of such a
figure is chance.
"""
