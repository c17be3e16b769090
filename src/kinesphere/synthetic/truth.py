"""A solution against the truth of the performance it came from, stage by stage."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

import numpy as np

from kinesphere.data import Array, Solution, motion_from_parameters
from kinesphere.geometry.rotations import rotation_angle
from kinesphere.synthetic.correspondence import Correspondence, JointPair, correspondence
from kinesphere.synthetic.performance import Performance
from kinesphere.synthetic.retelling import angles_about_axes


@dataclass(frozen=True)
class TruthRow:
    """One thing that was estimated and how far it is from the truth."""

    stage: str
    measure: str
    of: str
    """The joint, limb or markers it is about."""
    error: float
    """In ``unit``; rms over frames where it varies with them. NaN where nothing was estimated."""
    largest: float
    """In ``unit``; over all frames."""
    unit: str
    """``mm``, ``deg`` or nothing."""
    truth: float | None = None
    """In ``unit``, where the thing is a number."""
    estimate: float | None = None


def compare_with_truth(performance: Performance, solution: Solution) -> tuple[TruthRow, ...]:
    """Measure every stage of a solution against the truth.

    Limbs correspond by the markers they own, so a model that splits the actor's trunk in two, or
    gives the forearm a hand, is compared where both agree. The two worlds are first laid over each
    other by their markers; how far up is off is a row of its own. Axes are lines, compared in the
    actor's own parent limb whatever frame the solution gives it, in the order and with the signs
    that fit best. Angles are compared twice: as they are, but for order, sign and zero (*angle*,
    *twist*); and after the true motion is told in the conventions of the solution, its rest
    orientation, long axis and order of axes (*angle, same conventions*), which leaves what wrong
    axes and wrong poses cause.

    Parameters
    ----------
    performance
        As it was before anything spoiled its recording.
    solution
        Of that recording, spoiled or not, with all its frames.

    Returns
    -------
    tuple of TruthRow
        In the order of the line; one for each joint, limb or axis.
    """
    same = correspondence(performance, solution)
    return (
        TruthRow("orientation", "up", "world", same.tilt_deg, same.tilt_deg, "deg", truth=0.0),
        *_centre_rows(performance, solution, same),
        *_length_rows(performance, solution, same),
        *_frame_rows(same),
        *(row for pair in same.joints for row in _axis_rows(pair)),
        *(row for pair in same.joints for row in _angle_rows(pair)),
        *_marker_rows(performance, solution, same),
    )


def worst_rows(rows: Iterable[TruthRow]) -> tuple[TruthRow, ...]:
    """Return of each stage and measure the row with the largest error; NaN counts as largest."""
    worst: dict[tuple[str, str], TruthRow] = {}
    for row in rows:
        key = row.stage, row.measure
        if key not in worst or _size(row) > _size(worst[key]):
            worst[key] = row
    return tuple(worst.values())


def _size(row: TruthRow) -> float:
    return np.inf if np.isnan(row.error) else row.error


def _centre_rows(
    performance: Performance, solution: Solution, same: Correspondence
) -> Iterator[TruthRow]:
    """In every frame, and the constant part of it: what is wrong with the skeleton, not the poses.

    Of joints with one axis only the part across it: along it a hinge tells nothing.
    """
    estimated = same.into_truth(solution.motion.joint_centres())
    for pair in same.joints:
        offsets = estimated[:, pair.estimate_index] - performance.joint_centres[:, pair.truth_index]
        offsets = (offsets[:, None] @ pair.parent_world)[:, 0]  # seen from the true parent
        known = np.isfinite(offsets).all(axis=1)
        constant = offsets[known].mean(axis=0) if known.any() else np.full(3, np.nan)
        across, suffix = np.eye(3), ""
        if pair.truth.n_axes == 1:
            assert pair.truth.axes is not None
            axis = pair.truth.axes[0]
            across, suffix = across - np.outer(axis, axis), " across the axis"
            slid = np.array([1e3 * abs(constant @ axis)])
            yield _row("skeleton", "joint centre along the axis, constant", pair.name, slid, "mm")
        off = _lengths_mm(offsets @ across)
        yield _row("skeleton", f"joint centre{suffix}", pair.name, off, "mm")
        off = _lengths_mm(constant[None] @ across)
        yield _row("skeleton", f"joint centre{suffix}, constant", pair.name, off, "mm")


def _length_rows(
    performance: Performance, solution: Solution, same: Correspondence
) -> Iterator[TruthRow]:
    """Of limbs between two joints; where others end is a matter of definition."""
    carriers = {limb.parent for limb in performance.skeleton.limbs[1:]}
    for limb in performance.skeleton.limbs[1:]:
        if limb.name not in carriers or limb.name not in same.limbs:
            continue
        truth = limb.length * 1e3
        found = solution.skeleton.limbs[same.limbs[limb.name]].length * 1e3
        error = abs(found - truth)
        yield TruthRow(
            "skeleton", "segment length", limb.name, error, error, "mm", truth, float(found)
        )


def _frame_rows(same: Correspondence) -> Iterator[TruthRow]:
    for name, turn in same.estimate_from_truth.items():
        off = np.rad2deg(rotation_angle(turn))
        yield TruthRow("normalization", "limb frame", name, float(off), float(off), "deg", 0.0)


def _axis_rows(pair: JointPair) -> Iterator[TruthRow]:
    assert pair.truth.axes is not None
    if pair.estimate.n_axes != pair.truth.n_axes:
        yield _missing("axes", "axis", pair)
        return
    for k in range(pair.truth.n_axes):
        true, found = pair.truth.axes[k], pair.estimated_axes[k]
        sine = np.linalg.norm(np.cross(true, found))
        off = float(np.rad2deg(np.arctan2(sine, abs(true @ found))))
        yield TruthRow("axes", "axis", f"{pair.name} axis {k + 1}", off, off, "deg")
    if pair.truth.n_axes > 1:
        swapped = float(pair.order != tuple(range(pair.truth.n_axes)))
        yield TruthRow("axes", "axes in the other order", pair.name, swapped, swapped, "")


def _angle_rows(pair: JointPair) -> Iterator[TruthRow]:
    if pair.estimate.n_axes != pair.truth.n_axes:
        for measure in ("angle", "twist", "angle, same conventions", "twist, same conventions"):
            yield _missing("parameterization", measure, pair)
        return
    for k in range(pair.truth.n_axes):
        off = _about_mean(pair.estimated_angles[:, k] - pair.true_angles[:, k])
        yield _row("parameterization", "angle", f"{pair.name} axis {k + 1}", off, "deg")
    off = _about_mean(pair.estimated_twists - pair.true_twists)
    yield _row("parameterization", "twist", pair.name, off, "deg")
    told_angles, told_twists = angles_about_axes(
        pair.told_relative, *pair.told_joint, pair.told_start_angles, pair.told_start_twists
    )
    measure = "angle, same conventions"
    for k in range(pair.truth.n_axes):
        off = np.rad2deg(np.abs(_wrapped(pair.raw_angles[:, k] - told_angles[:, k])))
        yield _row("parameterization", measure, f"{pair.name} axis {pair.order[k] + 1}", off, "deg")
    off = np.rad2deg(np.abs(_wrapped(pair.raw_twists - told_twists)))
    yield _row("parameterization", "twist, same conventions", pair.name, off, "deg")


def _marker_rows(
    performance: Performance, solution: Solution, same: Correspondence
) -> Iterator[TruthRow]:
    """Every marker where skeleton and parameters put it, against where it was."""
    placed = motion_from_parameters(solution.parameters).marker_positions()
    truth = performance.recording
    for limb in performance.skeleton.limbs:
        labels = tuple(label for label in limb.markers if label in placed)
        if not labels:
            continue
        rebuilt = same.into_truth(np.stack([placed[label] for label in labels], axis=1))
        off = _lengths_mm(rebuilt - truth.markers[:, truth.columns(labels)])
        yield _row("reconstruction", "markers", limb.name, off.ravel(), "mm")


def _row(stage: str, measure: str, of: str, values: Array, unit: str) -> TruthRow:
    known = values[np.isfinite(values)]
    if not known.size:
        return TruthRow(stage, measure, of, np.nan, np.nan, unit)
    rms = float(np.sqrt((known**2).mean()))
    return TruthRow(stage, measure, of, rms, float(known.max()), unit)


def _missing(stage: str, measure: str, pair: JointPair) -> TruthRow:
    return TruthRow(stage, measure, pair.name, np.nan, np.nan, "deg")


def _lengths_mm(vectors: Array) -> Array:
    return np.asarray(np.linalg.norm(vectors, axis=-1) * 1e3)


def _about_mean(differences: Array) -> Array:
    """Return how far angles in rad are from their mean on the circle, in deg."""
    mean = np.angle(np.nanmean(np.exp(1j * differences)))
    return np.rad2deg(np.abs(_wrapped(differences - mean)))


def _wrapped(angles: Array) -> Array:
    return np.asarray(np.pi - np.mod(np.pi - angles, 2 * np.pi))
