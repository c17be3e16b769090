"""The steps the paper gives times for, ours and those of its twin on the same motion."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np

from benchmarks.speed.clock import median_seconds
from benchmarks.speed.given_axes import given_axes
from benchmarks.speed.twin import solve_frames
from kinesphere.data import Array, Motion, Parameters, Solution, motion_from_parameters
from kinesphere.geometry.rigid import fit_rigid
from kinesphere.geometry.rotations import rotation_about, rotation_angle
from kinesphere.normalization.propagation import propagate
from kinesphere.parameterization.angles import solve_angles
from kinesphere.parameterization.joint import fit_joint
from kinesphere.parameterization.settings import ParameterizationSettings
from kinesphere.parameterization.view import view_joint
from kinesphere.synthetic import Performance

PAPER_US = {"two axes and twist": 1170.0, "normalization": 18.7}
"""µs a frame; Sar Dessai, Hornung & Kobbelt 2006, section 5: 28.1 s and 449 ms for 24,000."""


def paper_comparison(
    performance: Performance, solution: Solution, twin_frames: int, repeats: int
) -> dict[str, Any]:
    """Return medians of the steps of the paper, µs a frame, and of the calibration, s.

    Everything is of all joints together: axes and rest positions, limb frames, angles and twists.
    """
    motion, skeleton = solution.motion, solution.skeleton
    rotations, n_frames = motion.rotations, motion.n_frames
    chosen = slice(n_frames // 2, n_frames // 2 + twin_frames)
    few, parameters = rotations[chosen], solution.parameters
    angles_s, _ = median_seconds(lambda: _angles(rotations, solution), repeats)
    twin_s, (twin_angles, twin_twists) = median_seconds(lambda: solve_frames(few, skeleton), 3)
    rng = np.random.default_rng(7)
    turns = rotation_about(np.array([0.6, 0.0, 0.8]), rng.uniform(-1, 1, len(skeleton.limbs)))
    still = np.zeros((len(skeleton.limbs), 3))
    along = np.stack([limb.long_axis for limb in skeleton.limbs])
    lengths = np.array([limb.length for limb in skeleton.limbs])
    moved_s, _ = median_seconds(lambda: propagate(motion, turns, still, along, lengths), repeats)
    rigid_s, _ = median_seconds(_rigid_fits(solution), repeats)
    calibration_s, _ = median_seconds(lambda: _calibrate(performance, motion), 3)
    given_s, _ = median_seconds(given_axes(motion, performance.calibration), repeats)
    return {
        "n_frames": n_frames,
        "n_joints": len(skeleton.joints),
        "twin_frames": len(few),
        "two_axes_and_twist_us": 1e6 * angles_s / n_frames,
        "twin_two_axes_and_twist_us": 1e6 * twin_s / len(few),
        "propagation_us": 1e6 * moved_s / n_frames,
        "rigid_fits_us": 1e6 * rigid_s / n_frames,
        "calibration_s": calibration_s,
        "given_axes_us": 1e6 * given_s / n_frames,
        "differs_deg": _difference(
            few, parameters, parameters.angles[chosen], parameters.twists[chosen]
        ),
        "twin_differs_deg": _difference(few, parameters, twin_angles, twin_twists),
    }


def _angles(rotations: Array, solution: Solution) -> None:
    settings, skeleton = ParameterizationSettings(), solution.skeleton
    known = np.ones(len(rotations), dtype=np.bool_)
    for j, joint in enumerate(skeleton.joints):
        assert joint.axes is not None
        assert joint.rest is not None
        relative = np.swapaxes(rotations[:, skeleton.parents[j + 1]], -1, -2) @ rotations[:, j + 1]
        long_axis = skeleton.limbs[j + 1].long_axis
        solve_angles(
            relative, joint.axes, joint.rest, long_axis, known, settings.angles, settings.twist
        )


def _rigid_fits(solution: Solution) -> Callable[[], None]:
    """Return what fits every limb's markers in every frame, weights and copies included."""
    recording = solution.recording
    limbs = [
        (limb.marker_positions, recording.markers[:, recording.columns(limb.markers)])
        for limb in solution.skeleton.limbs
        if len(limb.markers) >= 3
    ]

    def fit() -> None:
        for shape, points in limbs:
            fit_rigid(shape, points)

    return fit


def _calibrate(performance: Performance, motion: Motion) -> None:
    """Find movement, axes and rest position of every joint, within the calibration."""
    settings, skeleton = ParameterizationSettings(), motion.skeleton
    start, end = performance.calibration
    at = np.flatnonzero((motion.times >= start) & (motion.times <= end))
    known = np.ones(len(at), dtype=np.bool_)
    for j, joint in enumerate(skeleton.joints):
        parent = motion.rotations[at, skeleton.parents[j + 1]]
        relative = np.swapaxes(parent, -1, -2) @ motion.rotations[at, j + 1]
        long_axis = skeleton.limbs[j + 1].long_axis
        view = view_joint(joint.name, relative, long_axis, known, motion.rate, known, settings)
        fit_joint(view, settings)


def _difference(rotations: Array, parameters: Parameters, angles: Array, twists: Array) -> float:
    """Return the 95th percentile in deg of the angle between rebuilt poses and the motion's."""
    n_frames, n_joints = twists.shape
    twin = replace(
        parameters,
        root_positions=np.zeros((n_frames, 3)),
        root_rotations=rotations[:, 0],
        angles=angles,
        twists=twists,
        residuals=np.zeros((n_frames, n_joints)),
        flags=np.zeros((n_frames, n_joints), dtype=np.uint8),
        moving=np.zeros((n_frames, n_joints), dtype=np.bool_),
    )
    relative = motion_from_parameters(twin).relative_rotations()
    parents = parameters.skeleton.parents[1:]
    actual = np.swapaxes(rotations[:, list(parents)], -1, -2) @ rotations[:, 1:]
    off = rotation_angle(np.swapaxes(relative, -1, -2) @ actual)
    return float(np.rad2deg(np.nanpercentile(off, 95)))
