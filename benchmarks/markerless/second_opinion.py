"""Knees, hips and elbows of the real footage beside the angles that came with it.

    python -m benchmarks.markerless.second_opinion [--solved DIR] [--data KINESPHERE_DATA]

The recording's `.mot` was computed by inverse kinematics from 2-D keypoints, its `.trc` holds the
keypoints in space: a second and a third opinion, and no truth. Without ``--solved``, a folder that
``kinesphere track`` wrote, the footage is tracked first, from its automatic start. Writes
docs/results/markerless-angles.md and the curves beside it.
"""

import argparse
import os
import tempfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from benchmarks.markerless.curves import Panel, curves_svg
from benchmarks.markerless.real_scenes import write_pose2sim_scene
from kinesphere.data import Array, Solution
from kinesphere.data.isb import isb_angles
from kinesphere.io import read_solution, read_trc, replacing
from kinesphere.io.scene import read_scene
from kinesphere.pipeline.track import solve_scene

PAGE = Path("docs/results/markerless-angles.md")
CURVES = PAGE.with_suffix(".svg")
JOINTS = {
    "left_hip": "hip_flexion_l",
    "right_hip": "hip_flexion_r",
    "left_knee": "knee_angle_l",
    "right_knee": "knee_angle_r",
    "left_elbow": "elbow_flex_l",
    "right_elbow": "elbow_flex_r",
}
"""Our joint, whose flexion is read after the ISB, and the coordinate of the `.mot`."""
_CHAINS = {
    "left_elbow": ("LShoulder", "LElbow", "LWrist"),
    "right_elbow": ("RShoulder", "RElbow", "RWrist"),
    "left_knee": ("LHip", "LKnee", "LAnkle"),
    "right_knee": ("RHip", "RKnee", "RAnkle"),
}
"""Keypoints whose angle is the joint's bend."""


@dataclass(frozen=True, eq=False)
class Opinions:
    """Flexion of one joint over the frames, deg; NaN where nobody says."""

    joint: str
    tracked: Array
    mot: Array
    keypoints: Array


def read_mot(path: Path) -> dict[str, Array]:
    """Return the columns of an OpenSim motion in degrees, by name."""
    lines = path.read_text(encoding="utf-8").splitlines()
    start = next(i for i, line in enumerate(lines) if line.strip() == "endheader") + 1
    names, *rows = (line.split("\t") for line in lines[start:] if line.strip())
    table = np.array([[float(word) for word in row] for row in rows])
    return {name.strip(): table[:, k] for k, name in enumerate(names)}


def opinions(solution: Solution, video: Path) -> list[Opinions]:
    """Return every joint's flexion as tracked, of the `.mot` and of the keypoints."""
    mot = read_mot(next(video.glob("*.mot")))
    keypoints = read_trc(next(video.glob("*.trc")))
    places = dict(zip(keypoints.labels, np.moveaxis(keypoints.markers, 1, 0), strict=True))
    found = isb_angles(solution.motion, solution.skeleton)
    begin = solution.motion.first_frame - 1
    frames = np.arange(begin, begin + solution.motion.n_frames)
    out = []
    for joint, column in JOINTS.items():
        j = [each.name for each in found.joints].index(joint)
        k = found.joints[j].angle_names.index("flexion")
        own = np.degrees(found.angles[:, j, k])
        bend = np.full(len(frames), np.nan)
        if joint in _CHAINS:
            bend = _bend(*(places[name] for name in _CHAINS[joint]))[frames]
        out.append(Opinions(joint, own, mot[column][frames], bend))
    return out


def page(found: list[Opinions]) -> str:
    """Return the results page as Markdown."""
    lines = [
        "# Real angles beside a second opinion",
        "",
        "Written by `python -m benchmarks.markerless.second_opinion`; see [how](../markerless.md). "
        "One person balancing before clutter, four cameras, from the automatic start, as "
        "`kinesphere track` gives it. The recording came with angles by inverse kinematics from "
        "2-D keypoints (`.mot`) and with the keypoints in space (`.trc`). Neither is truth, no "
        "marker was worn: where the two differ from each other, nobody can say who is right. "
        "Nothing was fitted or set by these figures.",
        "",
        "*Apart*: root mean square difference; *in shape*: the same without the constant part, "
        "which differs by definition of the zero.",
        "",
        "| joint, flexion | range, tracked | range, `.mot` | apart from `.mot` | in shape | r | "
        "apart from `.trc` | in shape | `.mot` apart from `.trc` |",
        "|---|--:|--:|--:|--:|--:|--:|--:|--:|",
    ]
    for one in found:
        rms, shape, r = _apart(one.tracked, one.mot)
        rms_k, shape_k, _ = _apart(one.tracked, one.keypoints)
        between = _apart(one.mot, one.keypoints)[0]
        lines.append(
            f"| {one.joint.replace('_', ' ')} | {_range(one.tracked)} | {_range(one.mot)} | "
            f"{_deg(rms)} | {_deg(shape)} | {_plain(r)} | {_deg(rms_k)} | {_deg(shape_k)} | "
            f"{_deg(between)} |"
        )
    lines += ["", f"![Flexion over the frames, three opinions]({CURVES.name})", ""]
    return "\n".join(lines)


def _bend(a: Array, b: Array, c: Array) -> Array:
    """Return how far three points are from lying in line, (n,) deg."""
    u, v = b - a, c - b
    across = np.linalg.norm(np.cross(u, v), axis=-1)
    angle: Array = np.degrees(np.arctan2(across, (u * v).sum(axis=-1)))
    return angle


def _apart(a: Array, b: Array) -> tuple[float, float, float]:
    """Return the RMS difference, the same without its mean, deg, and the correlation."""
    known = np.isfinite(a) & np.isfinite(b)
    if known.sum() < 3:
        return (float("nan"),) * 3
    off = a[known] - b[known]
    moving = a[known].std() > 0 and b[known].std() > 0
    r = float(np.corrcoef(a[known], b[known])[0, 1]) if moving else float("nan")
    return float(np.sqrt((off**2).mean())), float(off.std()), r


def _range(values: Array) -> str:
    known = values[np.isfinite(values)]
    return f"{known.min():.0f}…{known.max():.0f}°" if len(known) else "–"


def _deg(value: float) -> str:
    return "–" if np.isnan(value) else f"{value:.1f}°"


def _plain(value: float) -> str:
    return "–" if np.isnan(value) else f"{value:.2f}"


def main() -> None:
    """Measure what the command line asks for and write the page."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--solved", type=Path)
    default = Path(os.environ.get("KINESPHERE_DATA", "../shared/data"))
    parser.add_argument("--data", type=Path, default=default)
    asked = parser.parse_args()
    if asked.solved is not None:
        solution = read_solution(asked.solved)
    else:
        with tempfile.TemporaryDirectory() as folder:
            scene = read_scene(write_pose2sim_scene(Path(folder), asked.data, masks=True))
            solution = solve_scene(scene).solution
    found = opinions(solution, asked.data / "video" / "pose2sim")
    panels = [
        Panel(
            one.joint.replace("_", " "),
            {"tracked": one.tracked, ".mot": one.mot, "keypoints": one.keypoints},
        )
        for one in found
    ]
    for path, text in ((PAGE, page(found)), (CURVES, curves_svg(panels, "frame", "flexion, deg"))):
        with replacing(path) as partial:
            partial.write_text(text, encoding="utf-8")
        print(path)


if __name__ == "__main__":
    main()
