"""Whether bodies, joints and names hold where a recording is thinned, cut, noisy or reordered.

A figure on whole files says little of a clustering that a few frames can tip. Every recording is
looked at in parts and in disguises; what counts is the middle and the worst of them.
"""

from collections.abc import Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from benchmarks.accuracy.bodies.cases import Case, creature_cases, real_cases
from benchmarks.accuracy.bodies.measures import partition_of, rand_of, wrong_edges, wrong_names
from kinesphere.data import Recording
from kinesphere.errors import KinesphereError
from kinesphere.skeleton import DiscoverySettings, discover

NOISE = 0.0005
"""m, in each direction: what a capture system adds."""
DRAWS = 2
"""Of noise."""
SHORT_S = (15.0, 30.0, 60.0)
"""s, beginnings of a creature's 200 s."""
SEEDS = 4
"""Animals and hands."""
MOVES_DEG = 3.0
"""°, from its middle: a joint that turns less is still, and the limbs beside it are one body."""


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
                n = int(seconds * case.recording.rate)
                part = _frames(case.recording, slice(n))
                yield _row(_as_moved(case, n), f"first {seconds:g} s", part)[0]


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


def _as_moved(case: Case, n: int) -> Case:
    """Return the case with limbs as one where the joint between them is still in n frames."""
    performance = case.performance
    assert performance is not None  # creatures are made
    skeleton, turns = performance.skeleton, performance.motion.rotations[:n]
    names = list(skeleton.limb_names)
    body = {name: name for name in names}
    for joint in skeleton.joints:
        parent, child = names.index(joint.parent), names.index(joint.child)
        relative = Rotation.from_matrix(np.swapaxes(turns[:, parent], 1, 2) @ turns[:, child])
        off = (relative.mean().inv() * relative).magnitude()
        if np.degrees(off.max()) < MOVES_DEG:
            gone, kept = body[joint.child], body[joint.parent]
            body = {name: kept if other == gone else other for name, other in body.items()}
    edges = {frozenset(body[name] for name in edge) for edge in case.edges}
    truth = {label: body[limb] for label, limb in case.truth.items()}
    return replace(case, truth=truth, edges={edge for edge in edges if len(edge) == 2})


def _frames(recording: Recording, frames: slice, step: int = 1) -> Recording:
    markers = np.ascontiguousarray(recording.markers[frames])
    return replace(
        recording,
        markers=markers,
        rate=recording.rate / step,
        residuals=None,
        outputs=(),
        analog=None,
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
    models = [found.model]
    for tree in range(2, int(found.step.findings["trees"]) + 1):
        with suppress(KinesphereError):
            models.append(discover(recording, DiscoverySettings(tree=tree)).model)
    bodies = {
        label: f"{i}:{body}"
        for i, model in enumerate(models)
        for label, body in partition_of(model).items()
    }
    edges = case.edges
    row = Perturbed(
        case=case.name,
        change=change,
        rand=rand_of(case.truth, bodies),
        wrong_edges=[w for m in models for w in wrong_edges(m, case.truth, edges)] if edges else [],
        wrong_names=[wrong for model in models for wrong in wrong_names(model, case.truth)],
        names_confidence=found.step.findings["names_confidence"],
        law=law,
        same=whole is None or bodies == whole,
    )
    return row, bodies


def perturbed_section(rows: Sequence[dict[str, Any]]) -> str:
    """Return the page's section."""
    laws = [row for row in rows if row["law"] and row["change"] != "whole"]
    broken = [f"{row['case']}, {row['change']}" for row in laws if not row["same"]]
    lines = [
        "## In parts and in disguises\n",
        "Every recording whole, every second and third frame of it, its halves and thirds, with "
        f"{1e3 * NOISE:g} mm of noise in each direction ({DRAWS} draws), with its markers in "
        "another order and with its numbers laid out in another order in memory; the beginnings "
        f"of synthetic animals and hands ({', '.join(f'{s:g}' for s in SHORT_S)} s), where limbs "
        f"count as one while the joint between them turns less than {MOVES_DEG:g}°. Another order "
        f"of markers or of memory gives the same in {len(laws) - len(broken)} of {len(laws)}"
        f"{'; not in ' + '; '.join(broken) if broken else ''}.\n",
        "| recording | looks | whole | ARI, median | worst | in | wrong joints, median | most "
        "| all wrong names (confidence) |",
        "|---|---:|---:|---:|---:|---|---:|---:|---|",
    ]
    for case in dict.fromkeys(row["case"] for row in rows):
        mine = [row for row in rows if row["case"] == case]
        rands = [row["rand"] for row in mine]
        worst = min(mine, key=lambda row: row["rand"])
        whole = next((f"{row['rand']:.3f}" for row in mine if row["change"] == "whole"), "–")
        joints = [len(row["wrong_edges"]) for row in mine]
        names = [
            f"{', '.join(row['wrong_names'])} in {row['change']} ({row['names_confidence']:.2f})"
            for row in mine
            if row["wrong_names"]
        ]
        lines.append(
            f"| {case} | {len(mine)} | {whole} | {np.median(rands):.3f} | {worst['rand']:.3f} "
            f"| {worst['change']} | {np.median(joints):g} | {max(joints)} "
            f"| {'; '.join(names) or 'none'} |"
        )
    return "\n".join(lines) + "\n"
