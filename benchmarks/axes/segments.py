"""``python -m benchmarks.axes.segments``: the movements found in functional trials, drawn.

One picture a trial: the speed of the limb that the trial is about, the threshold between movement
and rest, and every movement that was found, coloured by the axis it was taken to be about.
"""

import argparse
import json
import os
import sys
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinesphere import read
from kinesphere.data import PoseFlag, Solution
from kinesphere.parameterization.axes.fit import phase_labels
from kinesphere.parameterization.settings import ParameterizationSettings
from kinesphere.parameterization.view import JointView, reliable_frames, view_joint
from kinesphere.pipeline import solve

ROOT = Path(__file__).parents[2]
PICTURES = ROOT / "docs" / "images" / "segments"
JOINTS = {"trunk": "lumbar"} | {
    f"{side[0]}{name}": f"{side}_{name}"
    for side in ("left", "right")
    for name in ("hip", "knee", "ankle")
}
"""What a trial is called after → the joint it moves."""
WIDE, HIGH = 900, 220
MARGIN = 44
SWINGS = 2  # axes that move the limb, the last of its axes
COLOURS = ("#e8590c", "#1098ad", "#868e96")
"""Of movements about axis 1, axis 2, and neither."""


class Trial(NamedTuple):
    """One joint in one functional trial."""

    name: str
    joint: str
    solution: Solution
    view: JointView
    labels: NDArray[np.intp]
    """(n_phases,) which axis each movement is about; −1: none."""


def trials(folder: Path) -> list[tuple[str, str, str]]:
    """Return (name, joint, path) of every functional trial that moves one joint."""
    found = []
    for path in sorted(folder.glob("functional/Test_func_*.c3d")):
        name = path.stem.removeprefix("Test_func_")
        if name in JOINTS:
            found.append((name, JOINTS[name], str(path)))
    return found


def look_at(name: str, joint: str, path: str) -> Trial:
    """Solve a trial and see its joint as the parameterization does."""
    solution = solve(read(path))
    motion, j = solution.motion, solution.skeleton.joint_names.index(joint)
    limbs = [int(solution.skeleton.parents[j + 1]), j + 1]
    view = view_joint(
        joint,
        motion.relative_rotations()[:, j],
        motion.skeleton.limbs[j + 1].long_axis,
        motion.flags[:, j + 1] != PoseFlag.TWIST_UNKNOWN,
        motion.rate,
        reliable_frames(motion.flags[:, limbs], np.ones(motion.n_frames, dtype=bool)),
        ParameterizationSettings(),
    )
    axes = solution.skeleton.joint(joint).axes
    assert axes is not None
    return Trial(name, joint, solution, view, phase_labels(view.samples, axes[-SWINGS:]))


def row(trial: Trial) -> dict[str, Any]:
    """Return what a trial's line in the table says."""
    joint, movement = trial.solution.skeleton.joint(trial.joint), trial.view.movement
    phases = trial.view.samples.phase_times
    return {
        "trial": trial.name,
        "joint": trial.joint,
        "seconds": len(movement.moving) / trial.view.samples.rate,
        "threshold_deg_s": float(np.rad2deg(movement.threshold)),
        "valley": movement.valley,
        "movements": len(phases),
        "about": [int((trial.labels == k).sum()) for k in range(min(SWINGS, joint.n_axes))],
        "moving_s": float(sum(end - start for start, end in phases)),
        "axes_from": ", ".join(sorted(set(joint.axes_sources), reverse=True)),
    }


def run(name: str, joint: str, path: str) -> dict[str, Any]:
    """Return one trial's line in the table."""
    return row(look_at(name, joint, path))


def picture(trial: Trial) -> str:
    """Return the speed over time as SVG, movements shaded."""
    view, movement = trial.view, trial.view.movement
    rate, speeds = view.samples.rate, np.rad2deg(movement.speeds)
    seconds, top = len(speeds) / rate, float(np.nanpercentile(speeds, 99.5)) * 1.1

    def x(time: float) -> float:
        return MARGIN + time / seconds * (WIDE - MARGIN - 8)

    def y(speed: float) -> float:
        return HIGH - 26 - min(speed, top) / top * (HIGH - 50)

    shades = [
        f'<rect x="{x(start):.1f}" y="22" width="{x(end) - x(start):.1f}" height="{HIGH - 48}" '
        f'fill="{COLOURS[label if 0 <= label < 2 else 2]}" fill-opacity=".22"/>'
        for (start, end), label in zip(view.samples.phase_times, trial.labels, strict=True)
    ]
    curve = " ".join(
        f"{x(f / rate):.1f},{y(v):.1f}" for f, v in enumerate(speeds) if np.isfinite(v)
    )
    limit = y(float(np.rad2deg(movement.threshold)))
    marks = [
        f'<text x="{x(t):.0f}" y="{HIGH - 8}" text-anchor="middle">{t:.0f} s</text>'
        for t in np.arange(0, seconds, 10)
    ]
    source = trial.solution.skeleton.joint(trial.joint).axes_source
    title = f"{trial.name}: {trial.joint.replace('_', ' ')}, speed in deg/s; axes from {source}"
    return "\n".join(
        [
            f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDE} {HIGH}" '
            'font-family="sans-serif" font-size="11" fill="#495057">',
            f'<rect width="{WIDE}" height="{HIGH}" fill="#fff"/>',
            f'<text x="{MARGIN}" y="14" font-size="13">{title}</text>',
            *shades,
            f'<polyline points="{curve}" fill="none" stroke="#343a40" stroke-width="1"/>',
            f'<path d="M{MARGIN} {limit:.1f}H{WIDE - 8}" stroke="#e03131" stroke-dasharray="5 3"/>',
            f'<text x="{MARGIN - 4}" y="{limit + 4:.0f}" text-anchor="end" fill="#e03131">'
            f"{np.rad2deg(movement.threshold):.0f}</text>",
            f'<text x="{MARGIN - 4}" y="{y(top) + 4:.0f}" text-anchor="end">{top:.0f}</text>',
            *marks,
            "</svg>",
        ]
    )


_INTRODUCTION = """
On the functional trials (12 Hz, the whole of each as calibration) what the filter finds can only be
looked at. `python -m benchmarks.axes.segments` draws the speed of the limb in question with the
threshold and every movement, coloured by the axis it is taken to be about, into
`docs/images/segments`:

"""


SEEN = """
Looked at one by one: no burst of speed lies outside a movement, and standing, at 0 to 6 deg/s, lies
in none, but for the first second of *rhip*, where a fidget of 33 deg/s is taken for one.

- *lknee*, *rknee*: every bend is in a movement and the threshold sits in the valley. Rests that the
  speed window leaves less than 0.24 s of are bridged, so that some bends share a movement.
- *lhip*: the leg never rests between its movements; all 37 s are one movement about several axes,
  no axes can be had from it, and those of the body serve. *rhip* rests once, at 27 s; what comes
  before is about neither axis by half (grey), what comes after tells one.
- *lankle*, *rankle*: the foot circles at 40 to 70 deg/s, about both axes at once and about neither
  by itself: one long movement, about no axis by 90 %. Then it turns its sole in and out seven times
  about one, in movements of 11 to 12° whose peaks at 30 deg/s rise little above the threshold, and
  which lose their slow ends. The left one's tell an axis, those of the right one go less far. The
  last burst of *rankle* is the foot being put down.
- *trunk*: five movements with the rests between them. From 62 s on the trunk turns about its own
  length, ±50° in the report: its direction hardly moves then, 1 to 12 deg/s, and direction is all
  that the filter looks at, as in the paper. The speed of the whole orientation tells a third axis.
"""


def page(rows: list[dict[str, Any]]) -> str:
    """Return the table and what the pictures show; nothing where no trial was to be had."""
    if not rows:
        return ""
    lines = [
        "| trial | joint | s | threshold, deg/s | movements | about axis 1, 2 | moving, s | axes |",
        "|---|---|---:|---:|---:|---:|---:|---|",
    ]
    for r in rows:
        limit = f"{r['threshold_deg_s']:.1f}" + ("" if r["valley"] else " (no valley)")
        lines.append(
            f"| [{r['trial']}](../images/segments/{r['trial']}.svg) | {r['joint']} | "
            f"{r['seconds']:.0f} | {limit} | {r['movements']} | "
            f"{', '.join(map(str, r['about']))} | {r['moving_s']:.0f} | {r['axes_from']} |"
        )
    return _INTRODUCTION + "\n".join(lines) + "\n" + SEEN


def main() -> int:
    """Draw every trial, put the table among the other figures and write the page anew."""
    from benchmarks.axes.__main__ import PAGE, RESULTS, as_json
    from benchmarks.axes.page import page as whole

    parser = argparse.ArgumentParser(description=__doc__)
    default = Path(os.environ.get("KINESPHERE_DATA", ROOT.parent / "shared" / "data"))
    parser.add_argument("--data", type=Path, default=default, help="folder of real recordings")
    parser.add_argument("-o", "--output", type=Path, default=PICTURES, help="folder of pictures")
    arguments = parser.parse_args()
    arguments.output.mkdir(parents=True, exist_ok=True)
    rows = []
    for task in trials(arguments.data):
        trial = look_at(*task)
        rows.append(row(trial))
        (arguments.output / f"{trial.name}.svg").write_text(picture(trial), encoding="utf-8")
    found = json.loads(RESULTS.read_text(encoding="utf-8")) | {"segments": rows}
    found.pop("version"), found.pop("bars")
    RESULTS.write_text(as_json(found), encoding="utf-8")
    PAGE.write_text(whole(found), encoding="utf-8")
    print(page(rows))
    return 0


if __name__ == "__main__":
    sys.exit(main())
