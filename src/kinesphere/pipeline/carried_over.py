"""Axes and rest positions of one recording in the limb frames of another."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from kinesphere.data import Joint, Json, Skeleton
from kinesphere.pipeline.frames_apart import turn_between


def into_frames_of(
    skeleton: Skeleton, joint: Joint, source: Skeleton
) -> tuple[Joint, dict[str, str]]:
    """Return a joint whose axes and rest orientation are those of a source, in other limb frames.

    ``axes' = C_parentᵀ axes`` and ``rest' = C_parentᵀ rest C_child``, as any change of limb frames
    (`kinesphere.normalization.propagation.move_skeleton`), with ``C`` of `turn_between`: the limbs
    stay where they are, beside their markers, and so does the zero of every angle.

    Parameters
    ----------
    skeleton
        Into whose limb frames.
    joint
        Of that skeleton, with axes, rest and uncertainty in the source's limb frames.
    source
        Has a joint of that name.

    Returns
    -------
    joint
        How unsure the parent's frame is adds to the axes' uncertainty.
    named
        Limb → why frames of one name are taken for the same.
    """
    there = source.joint(joint.name)
    parent = turn_between(skeleton.limb(joint.parent), source.limb(there.parent))
    child = turn_between(skeleton.limb(joint.child), source.limb(there.child))
    named = {
        limb: turn.why_named
        for limb, turn in ((joint.parent, parent), (joint.child, child))
        if turn.why_named
    }
    assert joint.axes is not None
    assert joint.rest is not None
    uncertainty = joint.axes_uncertainty
    moved = replace(
        joint,
        axes=joint.axes @ parent.rotation.T,
        rest=parent.rotation @ joint.rest @ child.rotation.T,
        axes_uncertainty=None if uncertainty is None else np.hypot(uncertainty, parent.unsure),
    )
    return moved, named


def as_json(named: Mapping[str, Mapping[str, str]]) -> Json:
    """Return recording → limb → why its frame is the one of the same name, as a finding."""
    return {recording: dict(limbs) for recording, limbs in named.items()}


def named_frames(found: Json) -> str:
    """Return which frames are taken for the same by name, and why, a clause; empty if none."""
    told: dict[tuple[str, str], list[str]] = {}
    for recording, limbs in sorted(found.items()) if isinstance(found, dict) else ():
        for limb, why in limbs.items() if isinstance(limbs, dict) else ():
            told.setdefault((recording, str(why)), []).append(limb)
    return "; ".join(
        f"{recording}: {', '.join(limbs)} ({why})" for (recording, why), limbs in told.items()
    )
