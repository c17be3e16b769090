"""Joint centres and joint angles among the points of a recording, as C3D files have them."""

from dataclasses import replace

import numpy as np

from kinesphere.data import Array, Motion, Output, Recording, Solution
from kinesphere.data.conventions import ANGLES, LIMBS, POSE, WRITTEN_BY
from kinesphere.geometry.chain import three_told
from kinesphere.io.c3d.renew import DESCRIPTIONS, NOTES, OURS
from kinesphere.io.c3d.source import Source
from kinesphere.io.own_points import CENTRE, TURNS

_CENTRE, _ANGLES = "_centre", "_angles"


def with_joints(solution: Solution) -> Recording:
    """Return the recording with the joint centres of the motion among its points and joint angles.

    A centre is a point named like its joint (``_centre`` appended where a marker has that name);
    angles are an output of type angle, ``JOINT_angles``, in degrees as gait labs have them (in
    radians where the file's own angles are).
    """
    recording, joints = solution.recording, solution.skeleton.joints
    taken = {*recording.labels, *(output.label for output in recording.outputs)}
    names = tuple(_free(joint.name, _CENTRE, taken) for joint in joints)
    taken |= set(names)
    unit = next((o.unit for o in recording.outputs if o.kind == "angle" and o.unit), "deg")
    scale = 1.0 if unit.lower().startswith("rad") else np.rad2deg(1.0)
    outputs, told = [], {}
    for j, (joint, name) in enumerate(zip(joints, names, strict=True)):
        label = _free(f"{joint.name}{_ANGLES}", _CENTRE, taken)
        taken.add(label)
        outputs.append(Output(label, "angle", _angles(solution, j) * scale, unit))
        told[name] = CENTRE.format(joint.parent, joint.child)
        turns = [f"axis {k}" for k in range(1, joint.n_axes + 1)]
        turns += ["none"] * (2 - joint.n_axes) + ([] if joint.n_axes == 3 else ["twist"])
        told[label] = TURNS.format(joint.child, joint.parent, ", ".join(turns))
    centres = solution.motion.joint_centres()
    residuals = recording.residuals
    if residuals is not None:
        residuals = np.hstack([residuals, np.full(centres.shape[:2], np.nan)])
    sure = recording.confidence
    if sure is not None:
        sure = np.concatenate([sure, np.full(len(names), np.nan)])
    points = "Points, joint centres included, stand in the axes this file has always had."
    notes = (WRITTEN_BY, points, LIMBS, POSE, ANGLES)
    return replace(
        recording,
        markers=np.hstack([recording.markers, centres]),
        labels=recording.labels + names,
        residuals=residuals,
        confidence=sure,
        outputs=(*recording.outputs, *outputs),
        details={**recording.details, DESCRIPTIONS: told, NOTES: notes},
    )


def without_notes(source: Source) -> Source:
    """Return what a recording's C3D file held before its joints were added to it."""
    section = source.layout.section
    groups = tuple(group for group in section.groups if group.name != OURS)
    layout = replace(source.layout, section=replace(section, groups=groups))
    return replace(source, layout=layout)


def _free(name: str, ending: str, taken: set[str]) -> str:
    while name in taken:
        name += ending
    return name


def _angles(solution: Solution, j: int) -> Array:
    """Return axis 1, axis 2 and twist, or three axes, (n_frames, 3) rad; with NaN where unseen."""
    parameters = solution.parameters
    n_axes = solution.skeleton.joints[j].n_axes
    angles = np.array(parameters.angles[:, j])
    angles[:, n_axes:] = 0.0
    if n_axes < 3:
        angles[:, 2] = np.nan_to_num(parameters.twists[:, j], nan=0.0)
        return angles
    return three_told(angles)


def recording_of_joints(motion: Motion) -> Recording:
    """Return where limbs hang and end as a recording, for programs that know points alone.

    A point is named like the limb that hangs there; the far end of a limb that carries none is
    ``LIMB_end``, where its length is known.
    """
    skeleton = motion.skeleton
    points = [motion.origins[:, :1], motion.joint_centres()]
    labels = list(skeleton.limb_names)
    for i, limb in enumerate(skeleton.limbs):
        if limb.length > 0 and i not in skeleton.parents:
            hangs = skeleton.joints[i - 1].centre_in_child if i else np.zeros(3)
            end = motion.rotations[:, i] @ (hangs + limb.length * limb.long_axis)
            points.append((end + motion.origins[:, i])[:, None])
            labels.append(_free(f"{limb.name}_end", "_", set(labels)))
    told = {label: f"where {label} hangs" for label in skeleton.limb_names[1:]}
    return Recording(
        markers=np.concatenate(points, axis=1),
        labels=tuple(labels),
        rate=motion.rate,
        first_frame=motion.first_frame,
        up="+y",
        details={DESCRIPTIONS: told},
        history=motion.history,
    )
