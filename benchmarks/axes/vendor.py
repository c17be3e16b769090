"""Section 8: the body frame and the limb frames beside those that a vendor's software wrote."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from benchmarks.axes.bars import Bar, number
from benchmarks.axes.generator import Array
from kinesphere.data import Recording, Solution
from kinesphere.geometry.rotations import nearest_rotation, rotation_angle

SEGMENTS: Mapping[str, str] = {
    "pelvis": "PEL",
    "trunk": "TRX",
    "head": "HED",
    "left_thigh": "LFE",
    "right_thigh": "RFE",
    "left_shank": "LTI",
    "right_shank": "RTI",
    "left_foot": "LFO",
    "right_foot": "RFO",
    "left_upper_arm": "LHU",
    "right_upper_arm": "RHU",
    "left_forearm": "LRA",
    "right_forearm": "RRA",
    "left_hand": "LHN",
    "right_hand": "RHN",
}
"""Limb → the vendor's name of it."""
HELD = ("pelvis", "left_thigh", "right_thigh", "left_shank", "right_shank")
MOVING = ("plugin-gait/PiG_Motion-FlatFoot-Full.c3d", "plugin-gait/pycgm_movement.c3d")
FOLDERS = ("cmu41/", "plugin-gait/")
LATERAL, LONG, SPREAD, ALIGNED, AHEAD = 8.0, 12.0, 4.0, 5.0, 0.5


def vendor_rows(solution: Solution) -> dict[str, Any]:
    """Return what normalization says of itself, and how its frames lie to the vendor's, if any."""
    found: Any = next(step for step in solution.motion.history if step.name == "normalization")
    told = found.findings
    row: dict[str, Any] = {
        "spread_deg": told["spread_rms_deg"],
        "feet_ahead": told["facing"]["scores"].get("feet"),
        "good": told["good_default_position"],
        "segments": {},
    }
    motion = solution.motion
    for limb, name in SEGMENTS.items():
        theirs = _frames(solution.recording, name)
        if theirs is None or limb not in motion.skeleton.limb_names:
            continue
        ours = motion.rotations[:, motion.skeleton.limb_names.index(limb)]
        known = np.isfinite(theirs).all(axis=(1, 2)) & np.isfinite(ours).all(axis=(1, 2))
        if not known.any():
            continue
        ours, theirs = ours[known], theirs[known]
        apart = np.swapaxes(ours, -1, -2) @ theirs
        constant = nearest_rotation(apart.sum(axis=0))
        left = np.rad2deg(rotation_angle(np.swapaxes(apart, -1, -2) @ constant))
        row["segments"][limb] = [float(np.median(left)), float(np.percentile(left, 95))]
        if limb == "trunk":
            # anterior, lateral, and an axis that points down: the lateral one lies to the right
            row["lateral_deg"] = _between(ours[:, :, 2], theirs[:, :, 1])
            row["long_deg"] = _between(ours[:, :, 1], -theirs[:, :, 2])
            row["tilt_deg"] = _between(-theirs[:, :, 2], np.array([0.0, 1.0, 0.0]))
    return row


def _frames(recording: Recording, name: str) -> Array | None:
    """Return the axes of a vendor's segment as columns, (n_frames, 3, 3); None if it is not there.

    Four points: the origin, and one each along an anterior, a lateral and a long axis.
    """
    points = {
        output.label: output.values @ recording.world_from_file.T for output in recording.outputs
    }
    if any(name + end not in points for end in "OALP"):
        return None
    axes = np.stack([points[name + end] - points[name + "O"] for end in "ALP"], axis=-1)
    return np.asarray(axes / np.linalg.norm(axes, axis=1, keepdims=True))


def _between(a: Array, b: Array) -> float:
    return float(np.median(np.rad2deg(np.arccos(np.clip((a * b).sum(axis=-1), -1, 1)))))


def bars(rows: Mapping[str, Mapping[str, Any]]) -> list[Bar]:
    """Return what is asked of body and limb frames on real recordings."""
    standard = {name: row for name, row in rows.items() if name.startswith(FOLDERS)}
    if not standard:
        return []
    thorax = [row for row in standard.values() if "lateral_deg" in row]
    aligned = [
        standard[name]["segments"][limb][0]
        for name in MOVING
        for limb in HELD
        if limb in standard.get(name, {}).get("segments", {})
    ]
    behind = [row for row in standard.values() if not (row["feet_ahead"] or 0.0) > AHEAD]
    figures = (
        ("trunk's lateral axis to the vendor's thorax, worst", thorax, "lateral_deg", LATERAL),
        ("trunk's long axis to the vendor's thorax, worst", thorax, "long_deg", LONG),
        ("spread over the default frames, worst", list(standard.values()), "spread_deg", SPREAD),
    )
    asked = [
        Bar("Real frames", what, max(row[key] for row in some), "deg", limit)
        for what, some, key, limit in figures
        if some
    ]
    if aligned:
        told = "pelvis, thighs, shanks to the vendor's, aligned: worst median"
        asked.append(Bar("Real frames", told, max(aligned), "deg", ALIGNED))
    told = "recordings that face the wrong way"
    return [*asked, Bar("Real frames", told, float(len(behind)), "", 0)]


_BEFORE = """\
## 8 Body and limb frames on real recordings

*Spread*: rms angle between the body frames of the averaged default frames and their mean. *Feet*:
share of frames in which the feet point ahead. Where the vendor's segments are in the file: median
angle of the trunk's lateral and long axis to the thorax's, and how far that itself leans.

| recording | stands | spread, ° | feet | lateral, ° | long, ° | thorax leans, ° |
|---|---|---:|---:|---:|---:|---:|"""
_ALIGNED = """
People who never stand still are averaged over whole strides, in which the shoulders turn against
the pelvis by ±10°; of those frames the half nearest to the mean serves, in which both face alike,
and is what the spread is told of (5.13° with all of them on `PiG_Motion`).

Each limb's frame against the vendor's after one constant rotation a limb, which takes the
difference of definitions out; median / 95th percentile over the frames of the two recordings that
move, in degrees. The vendor's feet are long axes with a twist taken from the shank, and its
forearms turn with two wrist markers: those differ by what the definitions make of the same markers.

| limb | {names} |
|---|{rule}"""


def page(rows: Mapping[str, Mapping[str, Any]]) -> str:
    """Return the section."""
    standard = {name: row for name, row in rows.items() if name.startswith(FOLDERS)}
    if not standard:
        return "## 8 Body and limb frames on real recordings\n\nNo real recordings were there.\n"
    lines = [_BEFORE]
    for name, row in standard.items():
        cells = [name, "yes" if row["good"] else "no", number(row["spread_deg"])]
        cells += [
            number(row.get(key)) for key in ("feet_ahead", "lateral_deg", "long_deg", "tilt_deg")
        ]
        lines.append("| " + " | ".join(cells) + " |")
    moving = [name for name in MOVING if name in standard]
    lines.append(_ALIGNED.format(names=" | ".join(moving), rule="---:|" * len(moving)))
    for limb in SEGMENTS:
        found: Sequence[Any] = [standard[name]["segments"].get(limb) for name in moving]
        cells = ["–" if f is None else f"{f[0]:.2f} / {f[1]:.1f}" for f in found]
        lines.append(f"| {limb.replace('_', ' ')} | " + " | ".join(cells) + " |")
    return "\n".join(lines) + "\n"
