"""A labelled recording in, a measured skeleton and its motion out."""

import numpy as np

import kinesphere
from kinesphere.data import (
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
from kinesphere.skeleton.adoption import adopt, find_adoptions
from kinesphere.skeleton.chain import measure_chain
from kinesphere.skeleton.discovery.size import subject_size
from kinesphere.skeleton.doubts import open_centres, poor_fits
from kinesphere.skeleton.far_centres import far_centres
from kinesphere.skeleton.filling import hidden_samples
from kinesphere.skeleton.other_size import larger, with_lengths
from kinesphere.skeleton.report import describe_joint, describe_limb
from kinesphere.skeleton.sampling import spread_over_joints
from kinesphere.skeleton.scale import scaled, size_share, times_too_large
from kinesphere.skeleton.settings import SkeletonSettings
from kinesphere.skeleton.solve import solve_poses
from kinesphere.skeleton.strays import without_strays
from kinesphere.skeleton.tree import find_tree

DEFAULT = SkeletonSettings()
TOO_LARGE = (
    "nobody is so large: the unit of length is likely wrong; joints are judged as if it were "
    "{:g} times smaller, and so are the millimetres said of them"
)
TOO_SMALL = (
    "no body is so small: the unit of length is likely wrong; joints are judged as if it were "
    "{:g} times larger, and so are the millimetres said of them"
)


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
    limbs = tuple(describe_limb(bodies[limb], joints) for limb in tree.limbs)
    hidden, of_samples = hidden_samples(recording, limbs, solved.flags)
    step = Step(
        name="skeleton",
        settings=settings_as_json(asked),
        findings={
            "model": model.name,
            "length_share": _number(share),
            "frames_measured_on": len(frames),
            "adopted_markers": dict(adopted),
            "hidden_samples": hidden,
            "hidden_share": _number(hidden / max(of_samples, 1)),
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
            *poor_fits(tree.limbs, solved.residuals, share),
            *open_centres(described.values(), joints, far.limbs),
            *far.warnings,
        ),
        version=kinesphere.__version__,
    )
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
