"""A motion put on another skeleton: other limb lengths, another rest pose, another tree."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from kinesphere import __version__
from kinesphere.data import Array, Json, Motion, PoseFlag, Skeleton, Step
from kinesphere.data.figure import SIDES, Figure, find_figure
from kinesphere.data.settings import settings_as_json
from kinesphere.editing.foot_contacts import (
    FOOT,
    Ground,
    find_contacts,
    find_ground,
    foot_length,
    soles,
)
from kinesphere.editing.planting import plant_feet
from kinesphere.editing.retarget_gaps import without_gaps
from kinesphere.editing.retarget_rest import RestPose, corrections, rest_pose
from kinesphere.editing.retarget_settings import RetargetSettings
from kinesphere.editing.retarget_turns import limb_turns

_SAME = 1e-9
"""m and pure numbers: skeletons that differ by less are one and the same."""


@dataclass(frozen=True, eq=False)
class _Rig:
    """The target while it is being posed."""

    skeleton: Skeleton
    rest: RestPose
    turns: Array
    """(n_frames, n_limbs, 3, 3) ``world_from_limb``."""


def retarget_motion(
    motion: Motion,
    onto: Skeleton,
    *,
    settings: RetargetSettings | None = None,
    parts: Mapping[str, str] | None = None,
    source_parts: Mapping[str, str] | None = None,
    rests_alike: bool = False,
) -> Motion:
    """Put a motion on another skeleton.

    Limbs point where they pointed: arms, legs and head turn in the world as the source's do, apart
    from how the two rest poses differ. The way of the pelvis is scaled by the legs, and its height
    so that soles stand where they stood. Feet on the ground are then held in place: legs reach for
    them in closed form, knees bending as knees do, and the pelvis goes down where legs are too
    short.

    Parameters
    ----------
    motion
        World with y up; gaps are bridged, aloud.
    onto
        Whose limb frames are parallel in its rest pose, as those of solved skeletons and of rigs
        that ``io`` reads are.
    settings
        The defaults, if None.
    parts, source_parts
        Part of the figure (``left_thigh``) → name of the limb, where names and shape do not tell,
        of the target and of the source.
    rests_alike
        The rest poses are one pose (the default position) whatever the joints' places say: limb
        frames then turn alike, and so do all joint parameters.

    Returns
    -------
    Motion
        On ``onto``; its joints never come apart. What was done is the last step of its history.

    Raises
    ------
    BadModel
        If one of the two is no figure with two legs.
    DegenerateMotion
        If the pelvis is never seen.
    """
    settings = RetargetSettings() if settings is None else settings
    source_figure = find_figure(motion.skeleton, source_parts)
    target_figure = find_figure(onto, parts)
    source = rest_pose(motion.skeleton, source_figure)
    target = rest_pose(onto, target_figure)
    filled, doubts = without_gaps(motion)
    turned_by = {} if rests_alike else corrections(source, target)
    turns = limb_turns(
        filled.rotations, source, motion.skeleton.limb_names, target, onto, turned_by
    )
    rig = _Rig(onto, target, turns)

    places = _joint_places(filled)
    hips = np.stack([places[:, source_figure.parts[f"{s}_thigh"]] for s in SIDES], axis=1)
    ankles = np.stack([places[:, _ankle(source_figure, s)] for s in SIDES], axis=1)
    ground = find_ground(ankles, source.leg)
    scale = target.leg / source.leg
    ankle = _ankle_height(source, target, ground, scale)
    middle = hips.mean(axis=1) * scale
    middle[:, 1] += ground.floor * (1 - scale) + ankle - scale * ground.ankle
    at = _places(rig, middle)

    findings: dict[str, Json] = {
        "scale": scale,
        "parts_from": target_figure.source,
        "floor_mm": ground.floor * 1e3,
    }
    feet = all(f"{side}_foot" in figure.parts for side in SIDES
               for figure in (source_figure, target_figure))  # fmt: skip
    if settings.feet == "planted" and feet and not _same(motion.skeleton, onto, turned_by):
        foot = FOOT * source.leg
        shown = soles(source, motion.skeleton, filled.rotations, places, ground.ankle, foot)
        contacts = find_contacts(shown, motion.rate, source.leg, settings)
        levels = ground.floor + scale * (shown[..., 1] - ground.floor)
        points = soles(target, onto, turns, at, ankle, scale * (_foot(source, motion) or foot))
        planted = plant_feet(
            turns, at, points, contacts, levels, target, onto, motion.rate, settings
        )
        findings |= planted.findings
        rig = replace(rig, turns=planted.turns)
        at = _places(rig, middle - np.array([0.0, 1.0, 0.0]) * planted.drop[:, None])
    step = Step(
        "retargeting",
        settings_as_json(settings),
        findings,
        (*doubts, *ground.warnings, *_left_out(source_figure, target_figure)),
        __version__,
    )
    return _motion(rig, at, motion, filled, step)


def _ankle(figure: Figure, side: str) -> int:
    return figure.parts.get(f"{side}_foot", figure.parts[f"{side}_shank"])


def _joint_places(motion: Motion) -> Array:
    """Return where each limb hangs, (n_frames, n_limbs, 3) m; the root at its frame's origin."""
    places = np.array(motion.origins)
    places[:, 1:] = motion.joint_centres()
    return places


def _ankle_height(source: RestPose, target: RestPose, ground: Ground, scale: float) -> float:
    """Return how high the target's ankle stands, m."""
    least = 0.3 * scale * ground.ankle
    if target.ankle < least:  # its foot ends at the ankle's height: nothing tells
        return scale * ground.ankle
    if source.ankle < 0.3 * ground.ankle:
        return target.ankle
    return scale * ground.ankle + target.ankle - scale * source.ankle


def _foot(source: RestPose, motion: Motion) -> float:
    return float(np.mean([foot_length(source, motion.skeleton, side) for side in SIDES]))


def _places(rig: _Rig, middle: Array) -> Array:
    """Return where each limb of the rig hangs, (n_frames, n_limbs, 3) m, by the hips' middle."""
    skeleton = rig.skeleton
    at = np.zeros((len(middle), len(skeleton.limbs), 3))
    before = [np.zeros(3), *(joint.centre_in_child for joint in skeleton.joints)]
    for i, joint in enumerate(skeleton.joints, start=1):
        p = int(skeleton.parents[i])
        at[:, i] = at[:, p] + rig.turns[:, p] @ (joint.centre_in_parent - before[p])
    thighs = [rig.rest.figure.parts[f"{side}_thigh"] for side in SIDES]
    return np.asarray(at + (middle - at[:, thighs].mean(axis=1))[:, None])


def _same(source: Skeleton, target: Skeleton, turned_by: Mapping[str, Array]) -> bool:
    """Return whether two skeletons have the same limbs at the same places in the same pose."""
    if source.limb_names != target.limb_names or tuple(source.parents) != tuple(target.parents):
        return False
    ours = [(j.centre_in_parent, j.centre_in_child) for j in source.joints]
    theirs = [(j.centre_in_parent, j.centre_in_child) for j in target.joints]
    alike = np.allclose(np.array(ours), np.array(theirs), rtol=0.0, atol=_SAME)
    return alike and all(np.allclose(t, np.eye(3), atol=_SAME) for t in turned_by.values())


def _left_out(source: Figure, target: Figure) -> tuple[str, ...]:
    lost = sorted(set(target.parts) - set(source.parts))
    toes = {f"{side}_toes" for side in SIDES}
    lost = [part for part in lost if part not in toes]
    return (f"the motion tells nothing of {', '.join(lost)}: at rest",) if lost else ()


def _motion(rig: _Rig, at: Array, motion: Motion, filled: Motion, step: Step) -> Motion:
    skeleton = replace(rig.skeleton, history=(*rig.skeleton.history, step))
    into_child = np.array([np.zeros(3), *(j.centre_in_child for j in skeleton.joints)])
    origins = at - (rig.turns @ into_child[..., None])[..., 0]
    flags = np.full(origins.shape[:2], PoseFlag.FILLED, dtype=np.uint8)
    whole = (filled.flags != PoseFlag.FILLED).all(axis=1)
    flags[whole] = PoseFlag.MEASURED
    return Motion(
        skeleton=skeleton,
        rotations=rig.turns,
        origins=origins,
        residuals=np.full(flags.shape, np.nan),
        flags=flags,
        rate=motion.rate,
        first_frame=motion.first_frame,
        history=(*motion.history, step),
    )
