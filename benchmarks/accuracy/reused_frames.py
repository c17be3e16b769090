"""Whole joints of one recording reused in another, by the frames' names and by the markers."""

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from benchmarks.accuracy.one_movement import ALL, NONE, Array, axis_errors, one_movement
from kinesphere.data import Skeleton
from kinesphere.pipeline import solve
from kinesphere.pipeline.frames_apart import turn_between
from kinesphere.synthetic import Performance, make_performance


class Reused(NamedTuple):
    """How far a joint's axes and rest position are off beside the markers, each in deg."""

    axes: list[float]
    rest: list[float]
    """From where it was in the recording it is from."""


def reused_frames(seeds: int, scatter_deg: float) -> dict[str, Reused]:
    """Return errors where whole joints are told, and in a recording whose posture is another."""
    errors = {where: Reused([], []) for where in ("there", "named", "markers")}
    for seed in range(seeds):
        actor = make_performance(
            np.random.default_rng(seed), rate=25.0, calibration_s=60.0, free_s=0.0
        )
        whole = one_movement(actor, ALL, scatter_deg, 100 * seed + 60)
        still = one_movement(actor, NONE, scatter_deg, 100 * seed + 70)
        there = solve(whole, actor.model).skeleton
        here = solve(still, actor.model, calibration_from=there).skeleton
        for joint in actor.skeleton.joints:
            name = joint.name
            if name.endswith("wrist") or here.joint(name).axes_source != "reused":
                continue  # hands have two markers
            if there.joint(name).n_axes != joint.n_axes or any(there.joint(name).axes_assumed):
                continue
            wanted = _rest(there, actor, name)
            skeletons = {"there": there, "named": by_name(here, there, name), "markers": here}
            for where, skeleton in skeletons.items():
                errors[where].axes.extend(axis_errors(skeleton, actor, name))
                errors[where].rest.append(_apart(wanted, _rest(skeleton, actor, name)))
    return errors


def table(errors: dict[str, Reused]) -> list[str]:
    """Return the lines of the page."""
    words = {
        "there": "in their own recording",
        "named": "in the other, frames of one name taken for the same",
        "markers": "in the other, turned by the markers (`--calibration-from`)",
    }
    return [
        "## Whole joints in another recording",
        "",
        "One trial has all movements one after another, the other none; it is solved with the",
        f"axes and rest positions of the first ({len(errors['there'].rest)} joints, "
        f"{len(errors['there'].axes)} axes). Axes",
        "are beside the markers of the parent, rest positions beside those of both limbs, from",
        "where they were. Who stands still has no joint centres to lay limb frames by.",
        "",
        "| joints of one recording | axes: median, deg | rms | worst | rest: median, deg | worst |",
        "|---|---|---|---|---|---|",
        *(
            f"| {words[where]} | {np.median(e.axes):.1f} | "
            f"{np.sqrt(np.mean(np.square(e.axes))):.1f} | {max(e.axes):.1f} | "
            f"{np.median(e.rest):.1f} | {max(e.rest):.1f} |"
            for where, e in errors.items()
        ),
    ]


def by_name(here: Skeleton, there: Skeleton, name: str) -> Skeleton:
    """Return a skeleton with a joint as another one's frames have it."""
    its = there.joint(name)
    joints = tuple(
        replace(j, axes=its.axes, rest=its.rest) if j.name == name else j for j in here.joints
    )
    return replace(here, joints=joints)


def _rest(skeleton: Skeleton, actor: Performance, name: str) -> Array:
    """Return a joint's rest orientation in the limb frames of the actor."""
    joint = skeleton.joint(name)
    assert joint.rest is not None
    parent, child = (
        turn_between(actor.skeleton.limb(limb), skeleton.limb(limb)).rotation
        for limb in (joint.parent, joint.child)
    )
    return np.asarray(parent @ joint.rest @ child.T)


def _apart(one: Array, other: Array) -> float:
    cosine = (np.trace(one.T @ other) - 1) / 2
    return float(np.rad2deg(np.arccos(np.clip(cosine, -1.0, 1.0))))
