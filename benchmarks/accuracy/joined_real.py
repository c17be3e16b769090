"""What functional trials of one person tell together, and how far they contradict each other."""

from collections.abc import Iterator, Mapping, Sequence
from itertools import combinations
from pathlib import Path
from typing import NamedTuple

import numpy as np

from benchmarks.accuracy.one_movement import Array
from kinesphere.data import Joint, Recording, Solution
from kinesphere.io import read
from kinesphere.parameterization import n_told
from kinesphere.pipeline import solve
from kinesphere.pipeline.frames_apart import turn_between

FUNCTIONAL = ("lknee", "rknee", "lankle", "rankle", "lhip", "rhip")
ASKED = "trunk"


class Pair(NamedTuple):
    """One axis that two recordings tell."""

    joint: str
    by_name: float
    """deg, between the two where frames of one name are taken for the same."""
    by_markers: float
    sure: float
    """deg, standard deviation of their difference."""


def functional(folder: Path) -> list[str]:
    """Return what functional trials of one person tell together, lines of the page."""
    files = {name: folder / f"Test_func_{name}.c3d" for name in (*FUNCTIONAL, ASKED)}
    alone = {name: solve(_recording(file)) for name, file in files.items()}
    trials = {name: alone[name] for name in FUNCTIONAL}
    trunk = solve(_recording(files[ASKED]), calibration_from=trials)
    told = list(pairs(alone))
    lines = [
        "## Functional trials",
        "",
        "`Test_func_trunk`, solved with the trials of knees, ankles and hips. In brackets what",
        "that recording tells by itself.",
        "",
        "| joint | axis 1 | axis 2 | axis 3 |",
        "|---|---|---|---|",
    ]
    for joint in trunk.skeleton.joints:
        own = alone[ASKED].skeleton.joint(joint.name)
        if n_told(joint):
            cells = [_cell(joint, k, own) for k in range(3)]
            lines.append(f"| {joint.name.replace('_', ' ')} | {' | '.join(cells)} |")
    step = next(step for step in trunk.history if step.name == "calibration")
    apart, turned = ([pair[k] for pair in told] for k in (1, 2))
    beyond = [sum(p[k] > max(10.0, p.sure) for p in told) for k in (1, 2)]
    return [
        *lines,
        "",
        *(f"Said: {warning}." for warning in step.warnings),
        "",
        f"{len(told)} times two of the seven recordings tell the same axis. They are "
        f"{rms(apart):.1f}° apart (rms) where frames of one name are taken for the same, "
        f"{rms(turned):.1f}° where one is turned into the other's by the parent's markers; "
        f"{beyond[0]} and {beyond[1]} of them by more than 10° and more than they are uncertain.",
    ]


def rms(values: Sequence[float]) -> float:
    """Return the root of the mean square."""
    return float(np.sqrt(np.mean(np.square(values))))


def _recording(file: Path) -> Recording:
    found = read(file)
    assert isinstance(found, Recording)
    return found


def _cell(joint: Joint, k: int, own: Joint) -> str:
    """Return where an axis is from and how sure it is, and how sure by the recording itself."""
    if k >= joint.n_axes:
        return "–"
    known = [
        [] if one.axes_uncertainty is None else np.rad2deg(one.axes_uncertainty)
        for one in (joint, own)
    ]
    text = (joint.axes_reused_from[k] if joint.axes_reused_from else "") or joint.axes_sources[k]
    if np.isfinite(known[0][k]):
        text += f" ±{known[0][k]:.1f}°"
    if own.n_axes == joint.n_axes and own.axes_sources[k] == "movement":
        text += f" (±{known[1][k]:.1f}°)"
    return text


def pairs(solutions: Mapping[str, Solution]) -> Iterator[Pair]:
    """Yield axes that two of several recordings of one person tell, and how far they are apart."""
    skeletons = [solution.skeleton for solution in solutions.values()]
    for name in skeletons[0].joint_names:
        for one, other in combinations(skeletons, 2):
            a, b = one.joint(name), other.joint(name)
            if a.axes is None or b.axes is None or a.n_axes != b.n_axes:
                continue
            turn = turn_between(one.limb(a.parent), other.limb(b.parent))
            for k in range(a.n_axes):
                if {a.axes_sources[k], b.axes_sources[k]} != {"movement"}:
                    continue
                known = [s.axes_uncertainty[k] for s in (a, b) if s.axes_uncertainty is not None]
                yield Pair(
                    name,
                    _apart(a.axes[k], b.axes[k]),
                    _apart(a.axes[k], turn.rotation @ b.axes[k]),
                    float(np.rad2deg(np.linalg.norm([*known, turn.unsure]))),
                )


def _apart(a: Array, b: Array) -> float:
    return float(np.rad2deg(np.arccos(min(1.0, abs(float(a @ b))))))
