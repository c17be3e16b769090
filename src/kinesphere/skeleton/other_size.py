"""A skeleton measured at a person's size, brought back to the size of the recording."""

from dataclasses import replace

from kinesphere.data import Json, Motion, Recording, Skeleton, TopologicalModel
from kinesphere.skeleton.landmarks import STEADY

MILLIMETRES = ("residual_mm", "uncertainty_mm")
"""Findings of each joint that are lengths."""


def with_lengths(
    recording: Recording, model: TopologicalModel, times: float
) -> tuple[Recording, TopologicalModel]:
    """Return the recording, and what the model has from it, with all lengths times ``times``.

    What a model knows of people, from elsewhere, stays.
    """
    joints = tuple(
        replace(
            joint,
            landmarks=tuple(
                replace(mark, spread=mark.spread * times) if mark.source == STEADY else mark
                for mark in joint.landmarks
            ),
        )
        for joint in model.joints
    )
    return replace(recording, markers=recording.markers * times), replace(model, joints=joints)


def larger(motion: Motion, unit: float, told: str = "") -> Motion:
    """Return a motion, its skeleton and what its last step found with all lengths times ``unit``.

    Parameters
    ----------
    motion
        Fresh from being measured.
    unit
    told
        What is said first of it; nothing, if empty.
    """
    step = motion.history[-1]
    found = step.findings["joints"]
    assert isinstance(found, dict)
    joints: dict[str, Json] = {
        name: {
            key: _times(value, unit) if key in MILLIMETRES else value for key, value in of.items()
        }
        for name, of in found.items()
        if isinstance(of, dict)
    }
    step = replace(
        step,
        findings={**step.findings, "length_unit": unit, "joints": joints},
        warnings=(told, *step.warnings) if told else step.warnings,
    )
    history = (*motion.history[:-1], step)
    return replace(
        motion,
        skeleton=replace(_skeleton(motion.skeleton, unit), history=history),
        origins=motion.origins * unit,
        residuals=motion.residuals * unit,
        history=history,
    )


def _skeleton(skeleton: Skeleton, unit: float) -> Skeleton:
    return replace(
        skeleton,
        limbs=tuple(
            replace(limb, length=limb.length * unit, marker_positions=limb.marker_positions * unit)
            for limb in skeleton.limbs
        ),
        joints=tuple(
            replace(
                joint,
                centre_in_parent=joint.centre_in_parent * unit,
                centre_in_child=joint.centre_in_child * unit,
                covariance=joint.covariance * unit**2,
                residual=joint.residual * unit,
            )
            for joint in skeleton.joints
        ),
    )


def _times(value: Json, unit: float) -> Json:
    return round(value * unit, 6) if isinstance(value, float) else value
