"""Whether bodies, joints and names hold where a recording is thinned, cut, noisy or reordered.

A figure on whole files says little of a clustering that a few frames can tip. Every recording is
looked at in parts and in disguises; what counts is the middle and the worst of them.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from benchmarks.accuracy.bodies.cases import Case, creature_cases, real_cases
from benchmarks.accuracy.bodies.measures import partition_of, rand_of, wrong_edges, wrong_names
from kinesphere.data import Recording
from kinesphere.errors import KinesphereError
from kinesphere.skeleton import discover

NOISE = 0.0005
"""m, in each direction: what a capture system adds."""
DRAWS = 2
"""Of noise."""
SHORT_S = (15.0, 30.0, 60.0)
"""s, beginnings of a creature's 200 s."""
SEEDS = 4
"""Animals and hands."""


@dataclass(frozen=True)
class Perturbed:
    """One recording, in part or in disguise."""

    case: str
    change: str
    rand: float
    wrong_edges: list[str]
    wrong_names: list[str]
    names_confidence: float | None
    law: bool
    """True where the result must be the same as on the whole file."""
    same: bool
    failure: str = ""


def perturbed_rows() -> Iterator[Perturbed]:
    """Yield every real recording in its disguises, and creatures cut short."""
    for case in real_cases():
        whole: dict[str, str] | None = None
        for change, recording, law in disguises(case.recording):
            row, bodies = _row(case, change, recording, law=law, whole=whole)
            whole = bodies if whole is None else whole
            yield row
    for seed in range(SEEDS):
        for case in creature_cases(seed)[:2]:  # the animal and the hand
            for seconds in SHORT_S:
                part = _frames(case.recording, slice(int(seconds * case.recording.rate)))
                yield _row(case, f"first {seconds:g} s", part)[0]


def disguises(recording: Recording) -> Iterator[tuple[str, Recording, bool]]:
    """Yield (what is done, the recording so, whether nothing may come of it)."""
    n = recording.n_frames
    yield "whole", recording, True
    for step in (2, 3):
        yield f"every {step}", _frames(recording, slice(0, None, step), step), False
    for parts in (2, 3):
        ends = np.linspace(0, n, parts + 1).astype(int)
        for i in range(parts):
            part = _frames(recording, slice(ends[i], ends[i + 1]))
            yield f"part {i + 1} of {parts}", part, False
    for draw in range(DRAWS):
        noise = np.random.default_rng([draw, 11]).normal(scale=NOISE, size=recording.markers.shape)
        yield f"noise {draw + 1}", replace(recording, markers=recording.markers + noise), False
    order = np.random.default_rng(9).permutation(recording.n_markers)
    yield (
        "another order",
        replace(
            recording,
            markers=np.ascontiguousarray(recording.markers[:, order]),
            labels=tuple(recording.labels[i] for i in order),
        ),
        True,
    )
    yield "F order", replace(recording, markers=np.asfortranarray(recording.markers)), True


def _frames(recording: Recording, frames: slice, step: int = 1) -> Recording:
    markers = np.ascontiguousarray(recording.markers[frames])
    return replace(
        recording, markers=markers, rate=recording.rate / step, residuals=None, outputs=(), analog=None
    )


def _row(
    case: Case,
    change: str,
    recording: Recording,
    *,
    law: bool = False,
    whole: dict[str, str] | None = None,
) -> tuple[Perturbed, dict[str, str]]:
    try:
        found = discover(recording)
    except KinesphereError as error:
        told = f"{type(error).__name__}: {error}"
        return Perturbed(case.name, change, 0.0, [], [], None, law, False, told), {}
    bodies = partition_of(found.model)
    others = {label for tree in found.step.findings["other_trees"] for label in tree}
    truth = {label: limb for label, limb in case.truth.items() if label not in others}
    row = Perturbed(
        case=case.name,
        change=change,
        rand=rand_of(truth, bodies),
        wrong_edges=wrong_edges(found.model, case.truth, case.edges) if case.edges else [],
        wrong_names=wrong_names(found.model, case.truth),
        names_confidence=found.step.findings["names_confidence"],
        law=law,
        same=whole is None or bodies == whole,
    )
    return row, bodies
