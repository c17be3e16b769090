"""A labelled recording in, a measured skeleton and its motion out."""

from collections.abc import Container, Iterable, Mapping, Sequence

import numpy as np

import kinesphere
from kinesphere.data import (
    Array,
    Joint,
    Json,
    Motion,
    Recording,
    Skeleton,
    Step,
    TopologicalModel,
    given_away,
    settings_as_json,
)
from kinesphere.errors import BadRecording
from kinesphere.geometry.in_words import in_millimetres
from kinesphere.skeleton.adoption import adopt, find_adoptions
from kinesphere.skeleton.chain import measure_chain
from kinesphere.skeleton.discovery.size import subject_size
from kinesphere.skeleton.far_centres import far_centres
from kinesphere.skeleton.landmarks import BETWEEN, STEADY
from kinesphere.skeleton.measured import MeasuredJoint
from kinesphere.skeleton.other_size import larger, with_lengths
from kinesphere.skeleton.report import describe_joint, describe_limb
from kinesphere.skeleton.sampling import spread_over_joints
from kinesphere.skeleton.scale import scaled, size_share, times_too_large
from kinesphere.skeleton.settings import SkeletonSettings
from kinesphere.skeleton.solve import solve_poses
from kinesphere.skeleton.strays import without_strays
from kinesphere.skeleton.tree import find_tree

DEFAULT = SkeletonSettings()
POOR = 0.03
"""m, rms residual from which on markers are no body: soft tissue leaves 22 mm at most."""

TOO_LARGE = (
    "nobody is so large: the unit of length is likely wrong; joints are judged as if it were "
    "{:g} times smaller, and so are the millimetres said of them"
)
TOO_SMALL = (
    "no body is so small: the unit of length is likely wrong; joints are judged as if it were "
    "{:g} times larger, and so are the millimetres said of them"
)
ELSEWHERE = {
    BETWEEN: "put midway between the markers of both limbs",
    STEADY: "put amid the markers that are steady in both limbs",
}
"""Where a centre is that no landmark of a model tells, by its source."""


def fit_skeleton(
    recording: Recording,
    model: TopologicalModel,
    settings: SkeletonSettings = DEFAULT,
    *,
    unit: float | None = None,
) -> Motion:
    """Measure limbs and joint centres from labelled markers, and the pose of every limb.

    From the root outward every limb gets a reference shape of its markers and the joint it shares
    with its parent; where the motion does not tell the joint's centre, the model's landmarks do,
    and the joint's note says so. A limb that owns too few markers for a pose of its own takes the
    joint centre as one more point; where even its twist stays open, the next limb lends it while
    the joint between is flexed, else it is the least from rest and flagged. Sightings that stray
    from their marker's path for a moment count as missing, aloud.

    Parameters
    ----------
    recording
        With the labels of ``model``, in the world: y up, metres.
    model
        Which markers sit on which limb.
    settings
    unit
        How many times too large lengths are, as far as that is known already: everything is
        measured in lengths that suit people, and brought back. If None, 1, and aloud a power of ten
        where nobody is so large or no body so small.

    Returns
    -------
    Motion
        Limb frames are provisional: principal axes of each limb's own markers.

    Raises
    ------
    BadRecording
        If there are no frames, or the root has fewer than three markers.
    DegenerateMotion
        If the root's markers never show an orientation.
    """
    if recording.n_frames == 0:
        raise BadRecording("the recording has no frames; one at least is needed to fit a skeleton")
    given, size = recording, subject_size(recording.markers)
    tree = find_tree(recording, model)
    recording, strays = without_strays(recording, size, tree.markers.values())
    used = [label for limb in tree.limbs for label in tree.markers[limb]]
    columns = recording.columns(tuple(used))
    frames = spread_over_joints(
        recording.markers, settings.sample_frames, tree.joint_columns(recording)
    )
    of_limbs = recording.markers[frames][:, columns]
    known, unit = unit is not None, times_too_large(of_limbs) if unit is None else unit
    if unit != 1:
        smaller = with_lengths(given, model, 1 / unit)
        motion = fit_skeleton(*smaller, settings, unit=1.0)
        told = TOO_LARGE.format(unit) if unit > 1 else TOO_SMALL.format(1 / unit)
        return larger(motion, unit, "" if known else told)
    asked, share = settings, size_share(of_limbs)
    settings = scaled(asked, share)
    markers = {label: recording.markers[:, i] for i, label in enumerate(recording.labels)}
    sample = {label: m[frames] for label, m in markers.items()}
    bodies, joints = measure_chain(tree, model, sample, settings)
    adopted = (
        find_adoptions(model, bodies, sample, settings.adopt_mm * 1e-3)
        if settings.adopt_markers
        else {}
    )
    if adopted:
        model = adopt(model, adopted)
        tree = find_tree(recording, model)
        bodies, joints = measure_chain(tree, model, sample, settings)
    solved = solve_poses(tree, bodies, joints, markers, recording.rate, settings, frames)
    poses = {limb: solved.of(i) for i, limb in enumerate(tree.limbs)}
    described = {
        child: describe_joint(j, poses[j.model.parent], poses[child], bodies[child], settings)
        for child, j in joints.items()
    }
    far = far_centres(joints, bodies)
    step = Step(
        name="skeleton",
        settings=settings_as_json(asked),
        findings={
            "model": model.name,
            "length_share": _number(share),
            "frames_measured_on": len(frames),
            "adopted_markers": dict(adopted),
            "stray_sightings": strays.findings,
            "joints": {
                joint.name: {
                    "observability": joint.observability,
                    "residual_mm": _number(joint.residual * 1e3),
                    "range_of_motion_deg": _number(np.rad2deg(joint.range_of_motion)),
                    "uncertainty_mm": _number(np.sqrt(np.trace(joint.covariance)) * 1e3),
                    "note": joint.note,
                }
                for joint in described.values()
            },
        },
        warnings=(
            *strays.warnings,
            *tree.warnings,
            *_poor_fits(tree.limbs, solved.residuals, share),
            *_open_centres(described.values(), joints, far.limbs),
            *far.warnings,
        ),
        version=kinesphere.__version__,
    )
    limbs = tuple(describe_limb(bodies[limb], joints) for limb in tree.limbs)
    history = (*recording.history, step)
    return Motion(
        skeleton=Skeleton(limbs, tuple(described[limb] for limb in tree.limbs[1:]), history),
        rotations=given_away(solved.rotations),
        origins=given_away(solved.shifts),
        residuals=given_away(solved.residuals),
        flags=given_away(solved.flags),
        rate=recording.rate,
        first_frame=recording.first_frame,
        history=history,
    )


def _number(value: float) -> Json:
    """Return a number as JSON holds it, to three decimals; null for NaN."""
    return round(float(value), 3) if np.isfinite(value) else None


def _poor_fits(limbs: Sequence[str], residuals: Array, share: float) -> tuple[str, ...]:
    """Return the warning that names the limbs whose markers do not move as one body."""
    poor = []
    for limb, column in zip(limbs, residuals.T, strict=True):
        known = column[np.isfinite(column)]
        if len(known) and (rms := float(np.sqrt(np.mean(known**2)))) > POOR * share:
            poor.append(f"{limb} ({in_millimetres(rms)})")
    if not poor:
        return ()
    return (
        f"markers do not move as one body on {', '.join(poor)}: "
        "they may be mislabelled, swapped, or on another limb",
    )


def _open_centres(
    joints: Iterable[Joint], measured: Mapping[str, MeasuredJoint], far: Container[str]
) -> tuple[str, ...]:
    """Return the warnings that name the joints whose centres the motion does not tell.

    Parameters
    ----------
    measured
        Child limb → its joint and where that was expected, as `expected_centre` says it.
    far
        Child limbs of joints that have a warning of their own.
    """
    places: dict[str, list[str]] = {}
    drawn: list[str] = []
    for joint in joints:
        if joint.observability != "undetermined" or joint.child in far:
            continue
        one = measured[joint.child]
        if one.drawn_away:
            drawn.append(f"{joint.name} ({in_millimetres(one.off)})")
        else:
            place = ELSEWHERE.get(one.source, "where the model's landmarks expect it")
            places.setdefault(place, []).append(joint.name)
    told = [
        f"the motion does not tell the centre of {', '.join(names)}; it is {place}"
        for place, names in places.items()
    ]
    if drawn:
        told.append(
            "the motion hardly tells these centres, yet draws them away from where they are "
            f"expected: {', '.join(drawn)}"
        )
    return tuple(told)
