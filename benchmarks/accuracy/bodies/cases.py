"""Recordings whose bodies are known, their labels hidden."""

import os
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from kinesphere import read
from kinesphere.data import Recording
from kinesphere.labelling import built_in_model, match_labels
from kinesphere.synthetic import (
    HAND,
    HUMAN,
    PLAYER,
    QUADRUPED,
    BodyPlan,
    Performance,
    make_performance,
    spoil_with_gaps,
    spoil_with_ghosts,
    spoil_with_noise,
    spoil_with_soft_tissue,
    together,
)

ROOT = Path(__file__).parents[3]
FRAMES = 24_000
PLATES = {
    "LB": "trunk",
    "PV": "pelvis",
    "RUA": "right_upper_arm",
    "LUA": "left_upper_arm",
    "RFA": "right_forearm",
    "LFA": "left_forearm",
    "RTH": "right_thigh",
    "LTH": "left_thigh",
    "RSH": "right_shank",
    "LSH": "left_shank",
}
"""First letters of a plate's markers → what it is strapped to."""
GAIT_SEGMENTS = {
    frozenset(edge)
    for edge in (
        *(("RPV", "RTA"), ("RPV", "RTH"), ("RPV", "LTH"), ("RTH", "RSK"), ("LTH", "LSK")),
        *(("RSK", "RFT"), ("LSK", "LFT"), ("RTA", "RAR"), ("RTA", "LAR")),
        *(("RAR", "RFA"), ("LAR", "LFA")),
    )
}
"""Which of the twelve segments of ``encodings/pc_real.c3d`` meet."""
GAIT_NAMES = {
    "RPV": "pelvis",
    "RTA": "trunk",
    "RTH": "right_thigh",
    "LTH": "left_thigh",
    "RSK": "right_shank",
    "LSK": "left_shank",
    "RFT": "right_foot",
    "LFT": "left_foot",
    "RAR": "right_upper_arm",
    "LAR": "left_upper_arm",
    "RFA": "right_forearm",
    "LFA": "left_forearm",
}


@dataclass(frozen=True)
class Case:
    """A recording without labels, and what is true of its markers."""

    name: str
    recording: Recording
    """Labels are ``*0``…: nothing can be read off them."""
    truth: Mapping[str, str]
    """Hidden label → limb."""
    edges: set[frozenset[str]] = field(default_factory=set)
    """Limbs that meet; empty where that is not known."""
    performance: Performance | None = None


def folder() -> Path:
    """Return the folder of real recordings."""
    return Path(os.environ.get("KINESPHERE_DATA", ROOT.parent / "shared" / "data"))


def hidden(recording: Recording) -> Recording:
    """Return the recording with labels that say nothing."""
    labels = tuple(f"*{i}" for i in range(recording.n_markers))
    return replace(recording, labels=labels, history=())


def real_cases() -> list[Case]:
    """Return the real recordings whose marker bodies are known."""
    return [
        _by_label("plates/KneeltoProne01", _plate),
        _by_label(
            "encodings/pc_real",
            lambda label: GAIT_NAMES[label[:3]],
            {frozenset(GAIT_NAMES[name] for name in edge) for edge in GAIT_SEGMENTS},
        ),
        _by_label("rigid-bodies/walkingOptiTrack", lambda label: label.partition("_")[0]),
        *(_cmu(name) for name in ("02_05", "06_01", "85_02", "135_02")),
    ]


def _by_label(path, limb_of, edges=frozenset()) -> Case:
    recording = read(folder() / f"{path}.c3d")
    limbs = {f"*{i}": limb_of(label) for i, label in enumerate(recording.labels)}
    truth = {label: limb for label, limb in limbs.items() if limb}
    return Case(path, hidden(recording), truth, set(edges))


def _plate(label: str) -> str:
    return next((limb for plate, limb in PLATES.items() if label.startswith(plate)), "")


def _cmu(name: str) -> Case:
    model = built_in_model("cmu41")
    recording = match_labels(read(folder() / "cmu41" / f"{name}.c3d"), model)
    own = {label: segment.name for segment in model.segments for label in segment.markers}
    truth = {f"*{i}": own[x] for i, x in enumerate(recording.labels) if x in own}
    edges = {frozenset((joint.parent, joint.child)) for joint in model.joints}
    return Case(f"cmu41/{name}", hidden(recording), truth, edges)


def actor_case(seed: int, *, spoilt: bool) -> Case:
    """Return a synthetic actor of twelve limbs with 1 mm noise; spoilt, with all that spoils."""
    performance = make_performance(np.random.default_rng(seed), n_frames=FRAMES)
    rng = np.random.default_rng([seed, 1])
    recording = performance.recording
    if spoilt:
        recording = spoil_with_soft_tissue(recording, rng, performance)
    recording = spoil_with_noise(recording, rng, deviation=0.001)
    if spoilt:
        recording = spoil_with_gaps(recording, rng, share=0.1, gap_s=0.3)
        recording = spoil_with_ghosts(recording, rng, n_ghosts=5)
    what = "soft tissue, gaps, ghosts" if spoilt else "1 mm noise"
    return synthetic_case(f"actor {seed}, {what}", recording, performance)


def creature_cases(seed: int) -> list[Case]:
    """Return an animal, a hand, a person with a racket and two people."""
    rng = np.random.default_rng([seed, 2])
    plans: list[tuple[str, BodyPlan, float]] = [
        ("quadruped", QUADRUPED, 0.001),
        ("hand", HAND, 0.0002),
        ("person with a racket", PLAYER, 0.001),
    ]
    cases = []
    for name, plan, noise in plans:
        performance = make_performance(np.random.default_rng(seed), plan=plan, n_frames=FRAMES)
        recording = spoil_with_noise(performance.recording, rng, deviation=noise)
        cases.append(synthetic_case(f"{name} {seed}", recording, performance))
    people = {
        name: make_performance(np.random.default_rng([seed, k]), plan=HUMAN, n_frames=FRAMES)
        for k, name in enumerate(("Anna", "Ben"))
    }
    recording = spoil_with_noise(together(people), rng, deviation=0.001)
    owner = {
        f"{name}:{label}": f"{name}:{limb.name}"
        for name, performance in people.items()
        for limb in performance.skeleton.limbs
        for label in limb.markers
    }
    truth = {f"*{i}": owner[label] for i, label in enumerate(recording.labels)}
    edges = {
        frozenset((f"{name}:{joint.parent}", f"{name}:{joint.child}"))
        for name, performance in people.items()
        for joint in performance.skeleton.joints
    }
    cases.append(Case(f"two people {seed}", hidden(recording), truth, edges))
    return cases


def synthetic_case(name: str, recording: Recording, performance: Performance) -> Case:
    """Return a performance as a case, with what is true of it."""
    owner = {label: limb.name for limb in performance.skeleton.limbs for label in limb.markers}
    truth = {f"*{i}": owner[x] for i, x in enumerate(recording.labels) if x in owner}
    edges = {frozenset((joint.parent, joint.child)) for joint in performance.skeleton.joints}
    return Case(name, hidden(recording), truth, edges, performance)
