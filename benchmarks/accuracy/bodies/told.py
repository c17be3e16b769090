"""What is told of joint centres: errors beside the uncertainty that is given with them."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from benchmarks.accuracy.bodies.linked_chains import Kind, chain, model
from kinesphere.data import Motion, Recording
from kinesphere.geometry.rigid import into_frame
from kinesphere.skeleton import fit_skeleton
from kinesphere.synthetic import (
    Performance,
    make_performance,
    spoil_with_gaps,
    spoil_with_noise,
    spoil_with_soft_tissue,
)

Array = NDArray[np.float64]

SEEDS = range(1000, 1008)
"""Actors; the formula was settled on others (800 to 805)."""
KINDS = ("ankle", "knee", "hip", "neck", "shoulder", "elbow")
OWN_POSE = 3
"""Markers that tell a pose."""
STEP = 5
"""Every so many frames are compared."""
EXACT_MM = 1e-3
"""Uncertainty below which there is nothing but rounding."""
SKIN_NOISE = 3e-4
"""m, noise of markers on skin."""

SKIN = SKIN_NOISE, 0.010
"""Noise and skin, m and m a radian."""
FREE: dict[str, Any] = {"calibration_s": 0, "free_s": 20}
LONG: dict[str, Any] = {"gaps": 0.5, "gap_s": 2.0}
LAWS: dict[str, dict[str, float]] = {
    "skin three times as large": {"per_radian": 0.030},
    "skin all along the limb": {"reach": 1.0},
    "skin of whole limbs": {"shared": 0.9},
    "slow drift 8 mm": {"per_radian": 0.0, "wobble": 0.008, "time_constant": 4.0},
}
"""What skin does elsewhere than on the rest of the page."""


@dataclass(frozen=True)
class Condition:
    """How a recording is made and spoilt."""

    name: str
    noise: float = 1e-3
    """m."""
    skin: float = 0.0
    """m a radian; wobble is a fifth of it."""
    wobble: float | None = None
    """m, where it is not."""
    calibration_s: float = 60.0
    free_s: float = 10.0
    first_s: float | None = None
    """Only the first seconds of it: most joints hardly move in them."""
    sparse: bool = False
    """41 markers, two on thighs and upper arms."""
    law: Mapping[str, float] = field(default_factory=dict)
    """Of the skin, where it is another: arguments of `spoil_with_soft_tissue`."""
    missing: float = 0.0
    """Share of all samples, each by itself."""
    gaps: float = 0.0
    """Share that is hidden for ``gap_s`` at a time."""
    gap_s: float = 0.5


CONDITIONS = (
    Condition("no noise", noise=0.0),
    Condition("0.1 mm noise", noise=1e-4),
    Condition("1 mm noise"),
    Condition("3 mm noise", noise=3e-3),
    Condition("1 mm noise, 20 s free", calibration_s=0, free_s=20),
    Condition("1 mm noise, 12 s free", calibration_s=0, free_s=12),
    Condition("1 mm noise, 3 s free", calibration_s=0, free_s=3),
    Condition("1 mm noise, most joints at rest", first_s=20),
    Condition("skin 5 mm/rad", SKIN_NOISE, 0.005),
    Condition("skin 10 mm/rad", SKIN_NOISE, 0.010),
    Condition("skin 20 mm/rad", SKIN_NOISE, 0.020),
    Condition("skin 10 mm/rad, 20 s free", SKIN_NOISE, 0.010, calibration_s=0, free_s=20),
    Condition("skin 10 mm/rad, 12 s free", SKIN_NOISE, 0.010, calibration_s=0, free_s=12),
    Condition("skin 10 mm/rad, most joints at rest", SKIN_NOISE, 0.010, first_s=20),
    Condition("wobble 4 mm, 20 s free", SKIN_NOISE, wobble=0.004, calibration_s=0, free_s=20),
    Condition("41 markers, 1 mm noise", sparse=True),
    Condition("41 markers, skin 10 mm/rad", SKIN_NOISE, 0.010, sparse=True),
    Condition(
        "41 markers, skin 10 mm/rad, 12 s free",
        *(SKIN_NOISE, 0.010),
        calibration_s=0,
        free_s=12,
        sparse=True,
    ),
    *(Condition(f"{name}, 20 s free", *SKIN, **FREE, law=law) for name, law in LAWS.items()),
    Condition("half the samples missing, 1 mm noise, 20 s free", **FREE, missing=0.5),
    Condition("half missing, skin 10 mm/rad, 20 s free", *SKIN, **FREE, missing=0.5),
    Condition("40% in gaps, skin 10 mm/rad, 20 s free", *SKIN, **FREE, gaps=0.4),
    Condition("50% in gaps of 2 s, 1 mm noise", **LONG),
    Condition("50% in gaps of 2 s, skin 10 mm/rad", *SKIN, **LONG),
    Condition("41 markers, half missing, skin, 20 s free", *SKIN, **FREE, missing=0.5, sparse=True),
)

CHAINS = (
    Kind("1 mm noise", last=3),
    Kind("1 mm noise, a hinge beyond", last=3, hinge=True),
    Kind("3 mm of skin", skin=0.003),
    Kind("3 mm of skin, a hinge beyond", skin=0.003, hinge=True),
    Kind("8 mm of skin", skin=0.008),
)
"""Limbs in a row, fitted together: the middle one has no pose of its own."""
IN_A_ROW = "limbs in a row"
NO_AXIS = float("nan"), float("nan")


@dataclass(frozen=True)
class Told:
    """One joint of one actor; of hinges across their axis, and along it."""

    condition: str
    actor: int
    joint: str
    error_mm: float
    """That stays the same over time, in the parent's frame."""
    told_mm: float
    """Rms length of it by the covariance."""
    along_mm: float
    """NaN where the joint is no hinge."""
    told_along_mm: float
    observability: str


def told_rows() -> list[Told]:
    """Return a row a joint of every actor in every condition, and of chains of limbs."""
    people = [row for one in CONDITIONS for seed in SEEDS for row in rows_of(one, seed)]
    return people + [row for one in CHAINS for seed in SEEDS for row in chain_rows(one, seed)]


def chain_rows(kind: Kind, seed: int) -> list[Told]:
    """Return a row a joint of limbs in a row, the middle one of two markers."""
    recording, centres = chain(kind, seed)
    skeleton = (motion := fit_skeleton(recording, model(kind.last))).skeleton
    rows = []
    for joint, world in zip(skeleton.joints, centres, strict=True):
        parent = skeleton.limb_names.index(joint.parent)
        local = into_frame(motion.rotations[:, parent], motion.origins[:, parent], world[:, None])
        off = joint.centre_in_parent - np.nanmean(local[:, 0], axis=0)
        error, told = np.linalg.norm(off), np.sqrt(np.trace(joint.covariance))
        name = f"{IN_A_ROW} of 4, 2 and {kind.last} markers, {kind.name}"
        row = Told(
            name,
            seed,
            joint.name,
            1e3 * float(error),
            1e3 * float(told),
            *NO_AXIS,
            joint.observability,
        )
        rows.append(row)
    return rows


def rows_of(condition: Condition, seed: int) -> list[Told]:
    """Return a row a joint."""
    performance = make_performance(
        np.random.default_rng(seed),
        layout="cmu41" if condition.sparse else "bodies",
        calibration_s=condition.calibration_s,
        free_s=condition.free_s,
    )
    rng = np.random.default_rng([seed, 3])
    recording = performance.recording
    wobble = condition.skin / 5 if condition.wobble is None else condition.wobble
    if condition.skin or wobble:
        law = {"per_radian": condition.skin, "wobble": wobble, **condition.law}
        recording = spoil_with_soft_tissue(recording, rng, performance, **law)
    if condition.noise:
        recording = spoil_with_noise(recording, rng, deviation=condition.noise)
    if condition.missing:
        missing = rng.random(recording.markers.shape[:2]) < condition.missing
        seen = np.where(missing[..., None], np.nan, recording.markers)
        recording = replace(recording, markers=seen, residuals=None)
    if condition.gaps:
        recording = spoil_with_gaps(recording, rng, share=condition.gaps, gap_s=condition.gap_s)
    shown = slice(None)
    if condition.first_s is not None:
        shown = slice(round(condition.first_s * recording.rate))
        recording = replace(recording, markers=recording.markers[shown], residuals=None)
    joints = tuple(replace(joint, landmarks=()) for joint in performance.model.joints)
    motion = fit_skeleton(recording, replace(performance.model, joints=joints))
    rows = []
    for joint in motion.skeleton.joints:
        parent = motion.skeleton.limb_names.index(joint.parent)
        rotations, origins = motion.rotations[::STEP, parent], motion.origins[::STEP, parent]
        centres, axes = (x[shown][::STEP] for x in _truth(performance, joint.name))
        local = into_frame(rotations, origins, centres[:, None])[:, 0]
        true = np.nanmean(local[_posed(recording, motion, parent)[::STEP]], axis=0)
        seen = np.einsum("nji,nj->ni", rotations, axes).mean(axis=0)
        if np.isnan(true).any():
            continue  # the limb that sees it has no pose anywhere
        off, axis = joint.centre_in_parent - true, seen / np.linalg.norm(seen)
        hinge = bool(np.isfinite(axis).all())
        across = np.eye(3) - np.outer(axis, axis) if hinge else np.eye(3)
        rows.append(
            Told(
                condition.name,
                seed,
                joint.name,
                1e3 * float(np.linalg.norm(across @ off)),
                1e3 * float(np.sqrt(np.trace(across @ joint.covariance @ across))),
                1e3 * abs(float(axis @ off)),
                1e3 * float(np.sqrt(axis @ joint.covariance @ axis)),
                joint.observability,
            )
        )
    return rows


def _posed(recording: Recording, motion: Motion, limb: int) -> NDArray[np.bool_]:
    """Return the frames in which a limb's own markers tell its pose; all where there are none.

    Elsewhere its pose is filled in, and what is off there is off by that.
    """
    labels = motion.skeleton.limbs[limb].markers
    shown = recording.seen[:, [recording.labels.index(label) for label in labels]].sum(axis=1)
    posed = shown >= min(OWN_POSE, len(labels))
    return posed if posed.any() else np.ones_like(posed)


def _truth(performance: Performance, name: str) -> tuple[Array, Array]:
    """Return a joint's centre and, of a hinge, its axis in the world, (n, 3) each; else NaN."""
    skeleton = performance.skeleton
    at = list(skeleton.joint_names).index(name)
    joint = skeleton.joints[at]
    one = joint.axes is not None and len(joint.axes) == 1
    axis = joint.axes[0] if one and joint.axes is not None else np.full(3, np.nan)
    parent = skeleton.limb_names.index(joint.parent)
    return performance.joint_centres[:, at], performance.motion.rotations[:, parent] @ axis


def told_ratio(rows: Sequence[Mapping[str, Any]]) -> float:
    """Return the rms of errors over what is told of them; NaN where nothing but rounding is."""
    kept = [row for row in rows if row["told_mm"] > EXACT_MM]
    ratios = [row["error_mm"] / row["told_mm"] for row in kept]
    return float(np.sqrt(np.mean(np.square(ratios)))) if ratios else float("nan")


def of_conditions(rows: Sequence[dict[str, Any]]) -> dict[str, list[dict[str, Any]]]:
    """Return the rows of each condition, in their order."""
    names = dict.fromkeys(row["condition"] for row in rows)
    return {name: [row for row in rows if row["condition"] == name] for name in names}
