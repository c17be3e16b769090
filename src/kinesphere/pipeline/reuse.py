"""Axes from other recordings of the same person: per joint from where they are known best."""

from collections.abc import Sequence
from dataclasses import replace
from typing import TypeAlias

import numpy as np

from kinesphere import __version__
from kinesphere.data import Joint, Json, Motion, Parameters, Skeleton, Solution, Step
from kinesphere.parameterization import ParameterizationSettings, n_told, parameterize, told_of
from kinesphere.pipeline.doubts import calibration_doubts

Source: TypeAlias = Solution | Skeleton
"""Another recording of the same person, solved."""


def skeletons_of(sources: Source | Sequence[Source] | None) -> tuple[Skeleton, ...]:
    """Return the skeletons of one solution or several, in their order."""
    if sources is None:
        return ()
    several = (sources,) if isinstance(sources, Solution | Skeleton) else sources
    return tuple(
        replace(s.skeleton, history=s.parameters.history) if isinstance(s, Solution) else s
        for s in several
    )


def parameterized(
    motion: Motion,
    settings: ParameterizationSettings,
    calibration: tuple[float, float] | None,
    others: Sequence[Skeleton],
) -> Parameters:
    """Return the joint parameters of a motion, about its own axes or those of other recordings.

    What speaks against the calibration window or the others becomes a step of the history.

    Parameters
    ----------
    motion
        Normalized.
    settings
    calibration
        (start, end) in s since the first stored frame: where the main movements are performed.
    others
        As `skeletons_of` returns them; empty for the motion's own axes.

    Raises
    ------
    DegenerateMotion, BadSetting
        As `kinesphere.parameterization.parameterize` does.
    """
    bearing, places = with_best_axes(motion.skeleton, others)
    doubts = calibration_doubts(motion, calibration, others)
    if doubts or len(others) > 1:
        found: dict[str, Json] = {}
        if len(others) > 1:
            found["axes_from"] = {name: number + 1 for name, number in places.items()}
        step = Step("calibration", {}, found, doubts, __version__)
        motion = replace(motion, history=(*motion.history, step))
    reuse = bearing if others else None
    return parameterize(motion, settings, calibration=calibration, reuse=reuse)


def with_best_axes(
    skeleton: Skeleton, sources: Sequence[Skeleton]
) -> tuple[Skeleton, dict[str, int]]:
    """Return a skeleton whose joints bear the axes that some other knows best.

    Laboratories record a functional trial for each joint: a hip's axes are measured in one, a
    knee's in another. Of the solutions that measured a joint's axes, those that measured most of
    them, the one with the smallest largest uncertainty serves; the first of equal ones. What
    twist that goes with the angle makes unsure does not count: it is the same in every recording,
    and a long movement only shows it.

    Parameters
    ----------
    skeleton
        Of the motion to be solved.
    sources
        Parameterized skeletons of the same person.

    Returns
    -------
    skeleton
        Joints that nobody measured have no axes. The last step of its history says of the others
        what was found of their axes where they come from.
    chosen
        Joint → index in ``sources``.
    """
    joints, chosen = [], {}
    for joint in skeleton.joints:
        others = {
            i: source.joint(joint.name)
            for i, source in enumerate(sources)
            if joint.name in source.joint_names and _measured(source.joint(joint.name))
        }
        if others:
            best = min(
                others, key=lambda i: (-n_told(others[i]), _uncertainty(others[i], sources[i]))
            )
            chosen[joint.name] = best
            joints.append(joint.with_axes_of(others[best]))
        else:
            joints.append(joint.without_axes)
    told: dict[str, Json] = {
        name: dict(told_of(name, sources[place])) for name, place in chosen.items()
    }
    step = Step("parameterization", findings={"joints": told})
    return replace(skeleton, joints=tuple(joints), history=(*skeleton.history, step)), chosen


def _measured(joint: Joint) -> bool:
    return joint.axes is not None and joint.rest is not None and joint.axes_source != "body"


def _uncertainty(joint: Joint, source: Skeleton) -> float:
    """Return the largest that is known, rad, without another reading; infinite where none is."""
    told = joint.axes_uncertainty
    if told is None or not np.isfinite(told).any():
        return np.inf
    other = told_of(joint.name, source).get("other_reading_deg")
    told = np.array(told)
    if isinstance(other, float):  # of a hinge, which is proximal to what was added to it
        told[-1] = np.sqrt(max(told[-1] ** 2 - np.deg2rad(other) ** 2, 0.0))
    return float(np.nanmax(told))
