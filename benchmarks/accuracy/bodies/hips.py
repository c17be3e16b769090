"""Hips of which both anatomy and motion know something: known hips, off the regression or not."""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from benchmarks.accuracy.bodies.worn_pelvis import HIPS, Dressed, wear_pelvis
from kinesphere.data import Recording
from kinesphere.geometry.rigid import into_frame
from kinesphere.skeleton import fit_skeleton
from kinesphere.synthetic import make_performance, spoil_with_noise, spoil_with_soft_tissue

SEEDS = range(1200, 1208)
"""Actors; what is weighed how was settled on others (1100 to 1103)."""
STEP = 5
"""Every so many frames are compared."""
SKIN, SKIN_NOISE = 0.010, 3e-4
"""m a radian, and m."""


@dataclass(frozen=True)
class Moved:
    """What the hips do, and whether markers are on skin."""

    name: str
    skin: bool = True
    calibration_s: float = 60.0
    free_s: float = 10.0
    first_s: float | None = None
    """Only the first seconds of it."""


@dataclass(frozen=True)
class People:
    """How far hips are off the regression, and markers off the spines."""

    name: str
    times: float = 1.0
    misplaced: float = 0.0
    """m."""


MOTIONS = (
    Moved("hips well moved, noise alone", skin=False),
    Moved("hips well moved"),
    Moved("3 s of free motion", calibration_s=0.0, free_s=3.0),
    Moved("hips at rest", first_s=20.0),
)
PEOPLE = (
    People("as published"),
    People("markers 10 mm off", misplaced=0.010),
    People("three times as far", times=3.0),
)


@dataclass(frozen=True)
class Hip:
    """One hip of one actor, without landmarks and with those of its pelvis."""

    motion: str
    people: str
    actor: int
    joint: str
    range_deg: float
    expected_mm: float
    """How far off anatomy is."""
    alone_mm: float
    """How far off the centre is by motion alone."""
    alone_told_mm: float
    both_mm: float
    """The same where the two are weighed."""
    both_told_mm: float
    observability: str


def hip_rows() -> Iterator[Hip]:
    """Yield a row a hip of every actor, motion and kind of people."""
    for motion in MOTIONS:
        for people in PEOPLE:
            for seed in SEEDS:
                yield from hips_of(motion, people, seed)


def hips_of(motion: Moved, people: People, seed: int) -> Iterator[Hip]:
    """Yield both hips of an actor."""
    performance = make_performance(
        np.random.default_rng(seed), calibration_s=motion.calibration_s, free_s=motion.free_s
    )
    rng = np.random.default_rng([seed, 5])
    dressed = wear_pelvis(performance, rng, times=people.times, misplaced=people.misplaced)
    recording = dressed.performance.recording
    if motion.skin:
        recording = spoil_with_soft_tissue(
            recording, rng, dressed.performance, per_radian=SKIN, wobble=SKIN / 5
        )
    noise = SKIN_NOISE if motion.skin else 1e-3
    recording = spoil_with_noise(recording, rng, deviation=noise)
    shown = slice(None if motion.first_s is None else round(motion.first_s * recording.rate))
    recording = replace(recording, markers=recording.markers[shown], residuals=None)
    alone, both = (_found(recording, dressed, shown, marked=marked) for marked in (False, True))
    for name in HIPS:
        yield Hip(
            motion.name,
            people.name,
            seed,
            name,
            both[name].range_deg,
            dressed.expected_mm[name],
            *alone[name].off,
            *both[name].off,
            both[name].observability,
        )


@dataclass(frozen=True)
class _Found:
    off: tuple[float, float]
    """mm, error and what is told of it."""
    range_deg: float
    observability: str


def _found(
    recording: Recording, dressed: Dressed, shown: slice, *, marked: bool
) -> dict[str, _Found]:
    """Return both hips as they are solved, with the landmarks of the pelvis or without."""
    truth = dressed.performance
    joints = tuple(
        replace(j, landmarks=(dressed.landmarks[j.name],) if marked and j.name in HIPS else ())
        for j in truth.model.joints
    )
    solved = fit_skeleton(recording, replace(truth.model, joints=joints))
    hips = {}
    for name in HIPS:
        joint = solved.skeleton.joint(name)
        parent = solved.skeleton.limb_names.index(joint.parent)
        centres = truth.joint_centres[shown, truth.skeleton.joint_names.index(name)][::STEP]
        rotations, origins = solved.rotations[::STEP, parent], solved.origins[::STEP, parent]
        true = np.nanmean(into_frame(rotations, origins, centres[:, None])[:, 0], axis=0)
        hips[name] = _Found(
            (
                1e3 * float(np.linalg.norm(joint.centre_in_parent - true)),
                1e3 * float(np.sqrt(np.trace(joint.covariance))),
            ),
            float(np.rad2deg(joint.range_of_motion)),
            joint.observability,
        )
    return hips
