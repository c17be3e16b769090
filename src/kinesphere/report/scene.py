"""What the page's player and curves need of a solution, thinned to what a screen can show."""

from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from kinesphere.data import Array, Codes, Joint, JointFlag, Skeleton, Solution
from kinesphere.data.sticks import side_of, sticks_of
from kinesphere.report.bodies import marker_colours
from kinesphere.report.moments import Moment, find_moments, most_telling, runs
from kinesphere.report.packing import pack
from kinesphere.report.surface import pack_surface

SCREEN_RATE = 60.0
"""Hz; a screen shows no more."""
MAX_FRAMES = 24_000
"""Frames in one page: 400 s at the rate of a screen, about 9 MB with 41 noisy markers."""

_POSITION_STEP = 1e-4  # m: a tenth of a millimetre is far below a pixel
_QUATERNION_STEP = 1e-4  # 0.01°
_ANGLE_STEP = 0.01  # deg
_RESIDUAL_STEP = 0.01  # mm


def frame_stride(n_frames: int, rate: float) -> int:
    """Return how many frames make one of the page: 1 up to SCREEN_RATE and MAX_FRAMES."""
    by_rate = max(1, int(np.floor(rate / SCREEN_RATE + 1e-6)))
    by_size = -(-n_frames // MAX_FRAMES)
    return max(by_rate, by_size)


def scene_from_solution(solution: Solution) -> dict[str, Any]:
    """Return everything the page draws, as JSON can hold it.

    Lengths are in m, residuals in mm, angles in degrees, times in s.
    """
    motion, parameters, recording = solution.motion, solution.parameters, solution.recording
    stride = frame_stride(motion.n_frames, motion.rate)
    moments = find_moments(solution)
    mesh, mesh_arrays = pack_surface(solution.surface, solution.skeleton)
    shown = np.arange(0, motion.n_frames, stride)
    columns = _shown_markers(solution)
    colours = marker_colours(solution)
    used = {label for limb in motion.skeleton.limbs for label in limb.markers}
    return {
        "rate": motion.rate / stride,
        "stride": stride,
        "first_frame": motion.first_frame,
        "n_frames": len(motion.rotations[shown]),
        "markers": [
            {
                "label": recording.labels[c],
                "used": recording.labels[c] in used,
                "colours": colours.get(recording.labels[c], []),
            }
            for c in columns
        ],
        "limbs": _limbs(solution.skeleton),
        "joints": _joints(solution.skeleton),
        "mesh": mesh,
        "arrays": {
            **mesh_arrays,
            "markers": pack(recording.markers[shown][:, columns], _POSITION_STEP),
            "origins": pack(motion.origins[shown], _POSITION_STEP),
            "quaternions": pack(_quaternions(motion.rotations[shown]), _QUATERNION_STEP),
            "angles": pack(np.rad2deg(parameters.angles[shown]), _ANGLE_STEP),
            "twists": pack(np.rad2deg(parameters.twists[shown]), _ANGLE_STEP),
            "joint_residuals": pack(parameters.residuals[shown] * 1e3, _RESIDUAL_STEP),
            "limb_residuals": pack(motion.residuals[shown] * 1e3, _RESIDUAL_STEP),
            "missing": pack(_missing(solution, stride), 0.5),
        },
        "moving": [runs(column) for column in parameters.moving[shown].T],
        "flags": [_flag_runs(column) for column in _any(parameters.flags, stride).T],
        "moments": [_moment(m, stride, columns) for m in most_telling(moments)],
        "improbable": [
            [m.first // stride, -(-m.end // stride)] for m in moments if m.kind == "improbable"
        ],
        "measured_s": [_measured(solution, joint) for joint in solution.skeleton.joints],
    }


def _moment(moment: Moment, stride: int, columns: list[int]) -> dict[str, Any]:
    kind, index = moment.about or ("", 0)
    if kind == "marker":  # a marker never seen is not in the page
        kind, index = ("marker", columns.index(index)) if index in columns else ("", 0)
    first = moment.first // stride
    return {
        "first": first,
        "end": max(first + 1, -(-moment.end // stride)),
        "kind": moment.kind,
        "about": [kind, index] if kind else None,
    }


def _any(codes: Codes, stride: int) -> Codes:
    """Return the flags of every ``stride`` frames together: none is lost by thinning."""
    starts = np.arange(0, len(codes), stride)
    return np.bitwise_or.reduceat(codes, starts, axis=0) if len(codes) else codes


def _missing(solution: Solution, stride: int) -> Array:
    """Return how many markers that limbs wear are unseen, at most, in each frame of the page."""
    recording = solution.recording
    worn = {label for limb in solution.skeleton.limbs for label in limb.markers}
    columns = [i for i, label in enumerate(recording.labels) if label in worn]
    counts = (~recording.seen[:, columns]).sum(axis=1, dtype=np.float64)
    starts = np.arange(0, len(counts), stride)
    return np.asarray(np.maximum.reduceat(counts, starts) if len(counts) else counts)[:, None]


def _measured(solution: Solution, joint: Joint) -> list[list[float]]:
    """Return start and end in s of the movements that a joint's axes were found from."""
    steps = [step for step in solution.history if step.name == "parameterization"]
    if not steps or joint.axes_source != "movement":
        return []
    joints: Any = steps[-1].findings.get("joints", {})
    return [list(span) for span in joints.get(joint.name, {}).get("phases_s", [])]


def _flag_runs(flags: Codes) -> dict[str, list[list[int]]]:
    return {
        str(flag.name).lower(): runs(np.asarray((flags & flag) > 0))
        for flag in JointFlag
        if (flags & flag).any()
    }


def _shown_markers(solution: Solution) -> list[int]:
    return [int(c) for c in np.flatnonzero(solution.recording.seen.any(axis=0))]


def _limbs(skeleton: Skeleton) -> list[dict[str, Any]]:
    """Return of each limb the sticks it is drawn by, in limb coordinates."""
    drawn = []
    for i, (limb, sticks) in enumerate(zip(skeleton.limbs, sticks_of(skeleton), strict=True)):
        drawn.append(
            {
                "name": limb.name,
                "side": side_of(limb.name),
                "parent": int(skeleton.parents[i]),
                "near": _numbers(sticks[0].near),
                "far": [_numbers(stick.far) for stick in sticks],
                "length": limb.length if np.isfinite(limb.length) else None,
            }
        )
    return drawn


def _joints(skeleton: Skeleton) -> list[dict[str, Any]]:
    return [
        {
            "name": joint.name,
            "side": side_of(joint.name),
            "parent": skeleton.limb_names.index(joint.parent),
            "centre": _numbers(joint.centre_in_parent),
            "axes": [] if joint.axes is None else [_numbers(axis) for axis in joint.axes],
        }
        for joint in skeleton.joints
    ]


def _quaternions(rotations: Array) -> Array:
    """Return xyzw, (n, m, 3, 3) → (n, m, 4), of continuous sign; NaN stays NaN."""
    known = np.asarray(np.isfinite(rotations).all(axis=(2, 3)))
    found = np.full((*known.shape, 4), np.nan)
    if known.any():
        found[known] = Rotation.from_matrix(rotations[known]).as_quat()
    for limb in range(found.shape[1]):
        seen = found[known[:, limb], limb]
        against = np.einsum("fi,fi->f", seen[1:], seen[:-1]) < 0
        signs = np.cumprod(np.r_[1.0, np.where(against, -1.0, 1.0)])[: len(seen)]
        found[known[:, limb], limb] = seen * signs[:, None]
    return found


def _numbers(values: Array) -> list[float | None]:
    return [round(float(v), 6) if np.isfinite(v) else None for v in values]
