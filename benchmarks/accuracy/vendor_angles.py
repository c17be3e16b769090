"""``python -m benchmarks.accuracy.vendor_angles``: clinical angles against the vendor's own.

Plug-in Gait files hold the joint angles that the vendor's software computed from the same markers,
with anatomical measurements we do not have. Zero and frames are defined otherwise there; what is
compared is the movement, after a constant offset and after a constant turn of both limb frames.
"""

import argparse
import json
import os
import sys
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

from benchmarks.accuracy.vendor_picture import Panel, picture
from kinesphere import __version__, isb_angles, read
from kinesphere.data import Array, Solution
from kinesphere.geometry.rotations import mean_rotation, rotation_angle
from kinesphere.pipeline import solve

ROOT = Path(__file__).parents[2]
RECORDINGS = (
    "PiG_Calibration-FlatFoot-Full",
    "PiG_Motion-FlatFoot-Full",
    "pycgm_static",
    "pycgm_movement",
)
OUTPUTS = {"hip": "HipAngles", "knee": "KneeAngles", "ankle": "AnkleAngles"}
"""Joint → the vendor's point: flexion, adduction, internal rotation in deg, both sides alike."""
BAR_DEG = 5.0
_ROUNDS = 300
_MOVES_DEG = 5.0  # range below which a standing trial tells nothing but the offset


@dataclass(frozen=True)
class VendorRow:
    """One joint of one recording; angles in deg, ours minus the vendor's."""

    recording: str
    joint: str
    n: int
    range: float
    """Of the vendor's flexion."""
    offset: float
    """Mean difference of flexion."""
    after_offset: float
    """RMSD of flexion without it."""
    aligned: tuple[float, float, float]
    """RMSD of flexion, adduction, rotation after a constant turn of both frames."""
    turns: tuple[float, float]
    """Of the parent's and the child's frame."""
    line: float
    """The foot alone: RMSD, after an offset, of its line's slope in the sagittal plane of the
    shank; NaN elsewhere."""
    ranges: tuple[float, float]
    """Of adduction: the vendor's, ours."""
    cross_talk: tuple[float, float]
    """Share of adduction's variance that flexion explains: the vendor's, ours."""


def aligned_frames(vendor: Array, ours: Array) -> tuple[Array, Array]:
    """Return P and C with ``vendor ≈ P @ ours @ C``, each (3, 3), by turns of chordal means.

    Parameters
    ----------
    vendor, ours : (n, 3, 3)
        ``parent_from_child`` of both, without NaN.
    """
    p, c = np.eye(3), np.eye(3)
    for _ in range(_ROUNDS):
        p = mean_rotation(vendor @ c.T @ np.swapaxes(ours, 1, 2))
        c = mean_rotation(np.swapaxes(p @ ours, 1, 2) @ vendor)
    return p, c


def vendor_rows(path: Path) -> Iterator[tuple[VendorRow, Panel]]:
    """Solve a recording and set its angles beside the vendor's."""
    solution = solve(read(path))
    outputs = {o.label.rpartition(":")[2]: o for o in solution.recording.outputs}
    for kind, output in OUTPUTS.items():
        for side in ("left", "right"):
            found = outputs.get(side[0].upper() + output)
            if found is not None:
                gap = (found.values == 0).all(axis=1)
                values = np.where(gap[:, None], np.nan, found.values)
                yield _row(path.stem, f"{side}_{kind}", solution, values)


def _row(name: str, joint: str, solution: Solution, vendor: Array) -> tuple[VendorRow, Panel]:
    found = isb_angles(solution.motion, solution.skeleton)
    j = next(i for i, one in enumerate(found.joints) if one.name == joint)
    signs = np.array([sign for _, _, sign in found.joints[j].convention.angles])
    ours = np.rad2deg(found.angles[:, j])
    known = np.isfinite(ours).all(axis=1) & np.isfinite(vendor).all(axis=1)
    theirs, ours = vendor[known], ours[known]
    apart = (ours[:, 0] - theirs[:, 0] + 180) % 360 - 180
    rotations = [
        Rotation.from_euler("ZXY", angles * signs, degrees=True).as_matrix()
        for angles in (theirs, ours)
    ]
    p, c = aligned_frames(*rotations)
    turned = Rotation.from_matrix(p @ rotations[1] @ c).as_euler("ZXY", degrees=True) * signs
    row = VendorRow(
        recording=name,
        joint=joint,
        n=int(known.sum()),
        range=float(np.ptp(theirs[:, 0])),
        offset=float(apart.mean()),
        after_offset=float(apart.std()),
        aligned=tuple(np.sqrt(np.mean((turned - theirs) ** 2, axis=0)).tolist()),
        turns=tuple(np.rad2deg([rotation_angle(p), rotation_angle(c)]).tolist()),
        line=_line(solution, joint, vendor[:, 0]),
        ranges=(float(np.ptp(theirs[:, 1])), float(np.ptp(ours[:, 1]))),
        cross_talk=(_explained(theirs), _explained(ours)),
    )
    times = solution.motion.times[known]
    return row, Panel(name, joint, times, theirs[:, 0], ours[:, 0] - row.offset, turned[:, 0])


def _line(solution: Solution, joint: str, vendor: Array) -> float:
    """Compare where the foot's line points in the shank, which no roll of the foot changes."""
    if not joint.endswith("_ankle"):
        return float("nan")
    j = solution.skeleton.joint_names.index(joint)
    along = solution.motion.relative_rotations()[:, j] @ solution.skeleton.limbs[j + 1].long_axis
    return float(np.nanstd(np.rad2deg(np.arctan2(along[:, 1], along[:, 0])) - vendor))


def _explained(angles: Array) -> float:
    return float(np.corrcoef(angles[:, 0], angles[:, 1])[0, 1] ** 2)


def page(rows: list[VendorRow]) -> str:
    """Return the results as Markdown."""
    moving = [row for row in rows if row.range > _MOVES_DEG]
    within = sum(row.aligned[0] <= BAR_DEG for row in moving)
    worst = max(moving, key=lambda row: row.aligned[0])
    lines = [
        "# Clinical angles against the vendor's",
        "",
        "Written by `python -m benchmarks.accuracy.vendor_angles`; the numbers are in",
        "`benchmarks/results/vendor_angles.json`. The files hold joint angles that Plug-in Gait",
        "computed from the same markers, by regression and measurements taken on the person. Its",
        "convention is ours but for the names of the axes: flexion, adduction (varus) and internal",
        "rotation positive on both sides, in the sequence of Grood & Suntay; frames in which all",
        "three are exactly zero are its gaps and left out. Nobody measured the bones: this is",
        "agreement, not accuracy. Ours minus the vendor's, in degrees.",
        "",
        f"**{within} of {len(moving)} joints that move by more than {_MOVES_DEG:g}° agree within "
        f"{BAR_DEG:g}° in flexion** after the constant turns of",
        f"both limb frames are taken out; the farthest is {worst.joint.replace('_', ' ')} of "
        f"`{worst.recording}`, {worst.aligned[0]:.1f}°.",
        "",
        "- *offset*: mean difference of flexion; another zero (ours: limbs in line with the body).",
        "- *without it*: RMSD of flexion once that constant is taken out; nothing else is fitted.",
        "- *frames aligned*: RMSD of flexion, adduction and rotation after a constant turn of the",
        "  parent's and another of the child's frame, of the size given.",
        "",
        "| recording | joint | frames | range | offset | without it | frames aligned: flexion "
        "| adduction | rotation | turns |",
        "|---|---|---:|---:|---:|---:|---:|---:|---:|---:|",
    ]
    lines += [
        f"| {r.recording} | {r.joint.replace('_', ' ')} | {r.n} | {r.range:.0f} | {r.offset:+.1f} "
        f"| {r.after_offset:.1f} | {r.aligned[0]:.1f} | {r.aligned[1]:.1f} | {r.aligned[2]:.1f} "
        f"| {r.turns[0]:.0f}, {r.turns[1]:.0f} |"
        for r in rows
    ]
    lines += [
        "",
        "![Flexion of hips, knees and ankles over time, the vendor's and ours]"
        "(../images/vendor_angles.svg)",
        "",
        "## What remains, explained",
        "",
        "A knee hardly bends sideways. Where its flexion axis is set wrongly, flexion leaks into",
        "adduction (cross-talk), and the cosine of what leaks is missing from flexion. The table",
        "has the range of adduction and the share of its variance that flexion explains, for both.",
        "",
        "| recording | knee | adduction, vendor | ours | explained by flexion, vendor | ours |",
        "|---|---|---:|---:|---:|---:|",
    ]
    lines += [
        f"| {r.recording} | {r.joint.split('_')[0]} | {r.ranges[0]:.0f} | {r.ranges[1]:.0f} "
        f"| {r.cross_talk[0]:.0%} | {r.cross_talk[1]:.0%} |"
        for r in moving
        if r.joint.endswith("knee")
    ]
    lines += [
        "",
        "A foot of these files has two markers, heel and toe; its roll about the line between them",
        "hangs on the ankle centre a few centimetres beside it, and is poorly known. Plug-in Gait",
        "takes the roll from the shank instead. The clinical sequence mixes roll into dorsiflexion",
        "where the foot points outward; the slope of the foot's line in the shank has no roll.",
        "",
        "| recording | ankle | dorsiflexion, without offset | frames aligned | the foot's line, "
        "without offset |",
        "|---|---|---:|---:|---:|",
    ]
    lines += [
        f"| {r.recording} | {r.joint.split('_')[0]} | {r.after_offset:.1f} | {r.aligned[0]:.1f} "
        f"| {r.line:.1f} |"
        for r in moving
        if r.joint.endswith("ankle")
    ]
    return "\n".join(lines) + "\n"


def main() -> int:
    """Solve what there is and write ``vendor_angles.json``, the page and its picture."""
    parser = argparse.ArgumentParser(description=__doc__)
    default = os.environ.get("KINESPHERE_DATA", ROOT.parent / "shared" / "data")
    parser.add_argument("folder", type=Path, nargs="?", default=Path(default))
    folder = parser.parse_args().folder
    if not (folder / "plugin-gait").is_dir():
        print(f"no plugin-gait recordings at {folder}; name their folder", file=sys.stderr)
        return 2
    paths = [folder / "plugin-gait" / f"{name}.c3d" for name in RECORDINGS]
    found = [one for path in paths for one in vendor_rows(path)]
    rows = [row for row, _ in found]
    text = page(rows)
    print(text)
    docs = ROOT / "docs"
    (docs / "results" / "isb_angles.md").write_text(text, encoding="utf-8")
    moving = [panel for row, panel in found if row.range > _MOVES_DEG]
    (docs / "images" / "vendor_angles.svg").write_text(picture(moving), encoding="utf-8")
    kept = [
        {k: None if isinstance(v, float) and np.isnan(v) else v for k, v in asdict(row).items()}
        for row in rows
    ]
    (ROOT / "benchmarks" / "results" / "vendor_angles.json").write_text(
        json.dumps({"version": __version__, "joints": kept}, allow_nan=False, indent=1) + "\n",
        encoding="utf-8",
    )
    return 0


if __name__ == "__main__":
    sys.exit(main())
