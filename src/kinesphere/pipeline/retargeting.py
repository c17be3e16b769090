"""A solved motion on other limb lengths or on a rig: poses, and for people their parameters."""

from collections.abc import Mapping
from dataclasses import replace
from typing import overload

import numpy as np

from kinesphere.data import Motion, Recording, Skeleton, Solution, Step
from kinesphere.editing import RetargetSettings, retarget_motion, scaled_skeleton
from kinesphere.pipeline.retarget_parameters import parameters_like
from kinesphere.pipeline.settings import Settings
from kinesphere.pipeline.surface import surface_for


@overload
def retarget(
    source: Solution,
    onto: Solution | float,
    *,
    settings: Settings | RetargetSettings | None = ...,
    parts: Mapping[str, str] | None = ...,
    source_parts: Mapping[str, str] | None = ...,
) -> Solution: ...
@overload
def retarget(
    source: Solution | Motion,
    onto: Skeleton,
    *,
    settings: Settings | RetargetSettings | None = ...,
    parts: Mapping[str, str] | None = ...,
    source_parts: Mapping[str, str] | None = ...,
) -> Motion: ...
@overload
def retarget(
    source: Motion,
    onto: Solution | float,
    *,
    settings: Settings | RetargetSettings | None = ...,
    parts: Mapping[str, str] | None = ...,
    source_parts: Mapping[str, str] | None = ...,
) -> Motion: ...


def retarget(
    source: Solution | Motion,
    onto: Solution | Skeleton | float,
    *,
    settings: Settings | RetargetSettings | None = None,
    parts: Mapping[str, str] | None = None,
    source_parts: Mapping[str, str] | None = None,
) -> Solution | Motion:
    """Put a motion on another person's limb lengths, on its own times a factor, or on a rig.

    Parameters
    ----------
    source
        A solution, or a motion as read from BVH or AMC.
    onto
        A solution: its skeleton, with the source's axes and rest positions. A number: the
        source's own skeleton so many times as large. A skeleton: a rig, as ``read_rig`` gives it.
    settings
        Of feet and ground; those of the whole line where parameters are found again.
    parts, source_parts
        Part of the figure → name of the limb, where names and shape do not tell: of the target,
        of the source.

    Returns
    -------
    Solution or Motion
        A solution from a solution onto a solution or a number: the markers of its recording are
        those of the target, riding on its limbs. Else a motion.

    Raises
    ------
    BadModel, BadSetting, DegenerateMotion
        As `kinesphere.editing.retarget_motion` does.
    """
    whole = settings if isinstance(settings, Settings) else Settings()
    options = settings if isinstance(settings, RetargetSettings) else whole.retargeting
    motion = source.motion if isinstance(source, Solution) else source
    if isinstance(onto, Skeleton):
        skeleton, alike = onto, False
    elif isinstance(onto, Solution):
        skeleton, alike = onto.skeleton, isinstance(source, Solution)
    else:
        skeleton, alike = scaled_skeleton(motion.skeleton, onto), True
    done = retarget_motion(
        motion,
        _without_axes(skeleton) if alike else skeleton,
        settings=options,
        parts=parts,
        source_parts=source_parts,
        rests_alike=alike,
    )
    if not isinstance(source, Solution) or isinstance(onto, Skeleton):
        return done
    parameters = parameters_like(done, source, whole.parameterization)
    surface = None
    if source.surface is not None:
        surface, step = surface_for(done, whole.surface)
        parameters = replace(parameters, history=(*parameters.history, step))
    return Solution(
        recording=_recording(done, done.history[-1]),
        motion=done,
        parameters=parameters,
        model_name=source.model_name,
        surface=surface,
    )


def _without_axes(skeleton: Skeleton) -> Skeleton:
    """Return the skeleton as it is before parameterization: the axes are the source's."""
    return replace(skeleton, joints=tuple(joint.without_axes for joint in skeleton.joints))


def _recording(motion: Motion, step: Step) -> Recording:
    """Return the markers of a skeleton where its limbs carry them."""
    placed = motion.marker_positions()
    markers = (
        np.stack(list(placed.values()), axis=1) if placed else np.empty((motion.n_frames, 0, 3))
    )
    return Recording(
        markers=markers,
        labels=tuple(placed),
        rate=motion.rate,
        first_frame=motion.first_frame,
        up="+y",
        history=(step,),
    )
