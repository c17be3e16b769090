"""Hips where anatomy and motion both have their say: known hips off the regression.

Actors whose pelvis has the four markers of its spines, put where the regression of Harrington et
al. 2007 puts the true hips, but for what people deviate from it and how the markers were put on.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Landmark, Recording, TopologicalModel
from kinesphere.geometry.rigid import into_frame
from kinesphere.labelling import built_in_model
from kinesphere.skeleton import fit_skeleton
from kinesphere.synthetic import (
    Performance,
    make_performance,
    spoil_with_noise,
    spoil_with_soft_tissue,
)

Array = NDArray[np.float64]

SEEDS = range(1100, 1112)
SPREAD_M = (0.0045, 0.0040, 0.0052)
"""m, of people's hips off the regression: inward, down, forward (Harrington et al. 2007, leave one
out 3.2, 3.6, 5.2 mm; Hara et al. 2016, doi:10.1038/srep37707, 3.8, 4.4, 5.2; 158 CT scans 4.7,
3.6, 4.8)."""
SIDES = ("left_hip", "right_hip")
LABELS = ("LASI", "RASI", "LPSI", "RPSI")
WIDTH_SHARE, DEPTH_SHARE = 0.0, 0.65
"""Of the pelvis: its width follows from the hips; its depth is this of the width."""
STEP = 5


@dataclass(frozen=True)
class Motion:
    """What the hips do, and how the recording is spoilt."""

    name: str
    calibration_s: float = 60.0
    free_s: float = 10.0
    first_s: float | None = None
    skin: float = 0.0
    noise: float = 1e-3


MOTIONS = (
    Motion("hips well moved, noise"),
    Motion("hips well moved, skin", skin=0.010, noise=3e-4),
    Motion("3 s free, skin", calibration_s=0, free_s=3, skin=0.010, noise=3e-4),
    Motion("hips at rest, noise", first_s=20),
    Motion("hips at rest, skin", first_s=20, skin=0.010, noise=3e-4),
)


@dataclass(frozen=True)
class People:
    """How far hips are off the regression, and markers off the spines."""

    name: str
    times: float = 1.0
    misplaced: float = 0.0
    """m."""


PEOPLE = (
    People("as published"),
    People("markers 10 mm off", misplaced=0.010),
    People("three times as far", times=3.0),
    People("three times as far, markers 10 mm off", times=3.0, misplaced=0.010),
)


@dataclass(frozen=True)
class Hip:
    """One hip of one actor."""

    motion: str
    people: str
    way: str
    actor: int
    joint: str
    error_mm: float
    told_mm: float
    expected_mm: float
    """How far off the expectation is."""
    range_deg: float
    observability: str


def hip_rows(seeds: range = SEEDS, ways: dict[str, object] | None = None) -> Iterator[Hip]:
    """Yield a row a hip of every actor, motion and kind of people, by motion alone and by both."""
    for motion in MOTIONS:
        for seed in seeds:
            for people in PEOPLE:
                yield from rows_of(motion, people, seed, ways)


def rows_of(
    motion: Motion, people: People, seed: int, ways: dict[str, object] | None = None
) -> Iterator[Hip]:
    """Yield a row a hip and way."""
    rng = np.random.default_rng([seed, 5])
    performance, landmarks, off = with_pelvis(
        make_performance(
            np.random.default_rng(seed),
            calibration_s=motion.calibration_s,
            free_s=motion.free_s,
        ),
        people,
        rng,
    )
    recording = performance.recording
    if motion.skin:
        recording = spoil_with_soft_tissue(
            recording, rng, performance, per_radian=motion.skin, wobble=motion.skin / 5
        )
    recording = spoil_with_noise(recording, rng, deviation=motion.noise)
    shown = slice(None if motion.first_s is None else round(motion.first_s * recording.rate))
    recording = replace(recording, markers=recording.markers[shown], residuals=None)
    for way, change in (ways or {"motion": None, "both": lambda m: m}).items():
        for row in _found(recording, performance, shown, landmarks, change):
            yield Hip(motion.name, people.name, way, seed, row[0], *row[1:3], 1e3 * off[row[0]], *row[3:])


def _found(recording: Recording, performance, shown, landmarks, change):
    joints = tuple(
        replace(
            joint,
            landmarks=(change(landmarks[joint.name]),)
            if joint.name in landmarks and change is not None
            else (),
        )
        for joint in performance.model.joints
    )
    solved = fit_skeleton(recording, replace(performance.model, joints=joints))
    for name in SIDES:
        joint = solved.skeleton.joint(name)
        parent = solved.skeleton.limb_names.index(joint.parent)
        at = [one.name for one in performance.skeleton.joints].index(name)
        centres = performance.joint_centres[shown][::STEP, at]
        rotations, origins = solved.rotations[::STEP, parent], solved.origins[::STEP, parent]
        true = np.nanmean(into_frame(rotations, origins, centres[:, None])[:, 0], axis=0)
        yield (
            name,
            1e3 * float(np.linalg.norm(joint.centre_in_parent - true)),
            1e3 * float(np.sqrt(np.trace(joint.covariance))),
            float(np.rad2deg(joint.range_of_motion)),
            joint.observability,
        )


def with_pelvis(
    performance: Performance, people: People, rng: np.random.Generator
) -> tuple[Performance, dict[str, Landmark], dict[str, float]]:
    """Return the performance with markers on the spines, its hips' landmarks and their errors, m.

    What a hip deviates is put into the landmark: the actor's hips stay where they are.
    """
    model = built_in_model("plugin-gait")
    marks = {j.name: j.landmarks[0] for j in model.joints if j.name in SIDES}
    skeleton = performance.skeleton
    root = skeleton.limbs[0]
    hips = np.array([skeleton.joint(name).centre_in_parent for name in SIDES])
    right = (hips[1] - hips[0]) / np.linalg.norm(hips[1] - hips[0])
    width = (np.linalg.norm(hips[1] - hips[0]) / 2 - 0.0073) / 0.33
    depth = DEPTH_SHARE * width * rng.uniform(0.85, 1.15)
    tilt = np.deg2rad(rng.normal(12.0, 5.0))
    up = root.long_axis - (root.long_axis @ right) * right
    up /= np.linalg.norm(up)
    ahead = np.cross(up, right)
    forward = np.cos(tilt) * ahead - np.sin(tilt) * up
    above = np.cross(right, forward)
    front = hips.mean(axis=0) + (0.24 * depth + 0.0099) * forward + (0.30 * width + 0.0109) * above
    back, apart = front - depth * forward, 0.38 * width
    spines = np.stack(
        [front - width / 2 * right, front + width / 2 * right]
        + [back - apart / 2 * right, back + apart / 2 * right]
    )
    put = rng.normal(size=spines.shape)
    spines = spines + people.misplaced * put / np.linalg.norm(put, axis=1)[:, None]
    landmarks, off = {}, {}
    for name, sign in zip(SIDES, (1, -1), strict=True):
        deviation = people.times * rng.normal(size=3) * SPREAD_M
        landmarks[name] = replace(
            marks[name], offset=tuple(float(x) for x in np.add(marks[name].offset, deviation))
        )
        off[name] = float(
            np.linalg.norm(_expected(landmarks[name], spines, sign) - hips[SIDES.index(name)])
        )
    limb = replace(
        root,
        markers=(*root.markers, *LABELS),
        marker_positions=np.vstack([root.marker_positions, spines]),
    )
    worn = replace(skeleton, limbs=(limb, *skeleton.limbs[1:]))
    moved = replace(performance.motion, skeleton=worn)
    markers = moved.marker_positions()
    recording = replace(
        performance.recording,
        markers=np.stack(list(markers.values()), axis=1),
        labels=tuple(markers),
        residuals=None,
    )
    return (
        replace(
            performance,
            recording=recording,
            motion=moved,
            parameters=replace(performance.parameters, skeleton=worn),
            model=_worn(performance.model),
        ),
        landmarks,
        off,
    )


def _expected(landmark: Landmark, spines: Array, sign: float) -> Array:
    """Return the hip by the regression as published, from its own words, (3,)."""
    at = dict(zip(LABELS, spines, strict=True))
    right = at["RASI"] - at["LASI"]
    width = np.linalg.norm(right)
    right = right / width
    ahead = (at["LASI"] + at["RASI"] - at["LPSI"] - at["RPSI"]) / 2
    forward = ahead - (ahead @ right) * right
    forward /= np.linalg.norm(forward)
    point = sum(w * at[label] for label, w in landmark.weights.items())
    inward, down, onward = landmark.offset
    down += landmark.down * width
    return point + sign * inward * right - down * np.cross(right, forward) + onward * forward


def _worn(model: TopologicalModel) -> TopologicalModel:
    first = model.segments[0]
    segments = (replace(first, markers=(*first.markers, *LABELS)), *model.segments[1:])
    pairs = (*model.mirror, ("LASI", "RASI"), ("LPSI", "RPSI"))
    return replace(model, segments=segments, required=(*model.required, *LABELS), mirror=pairs)
