"""What must not change bodies and trees, and what may not spoil them: units, order, noise, gaps."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from benchmarks.accuracy.bodies.cases import Case
from benchmarks.accuracy.bodies.measures import partition_of, rand_of, wrong_edges, wrong_names
from kinesphere.data import Recording
from kinesphere.skeleton import Discovery, discover

DRAWS = 2
"""Of noise and of missing samples."""


@dataclass(frozen=True)
class Change:
    """One case, changed."""

    case: str
    change: str
    law: bool
    """True where the result must be the same."""
    same: bool
    """Whether bodies and tree are those of the recording as it is; of another order of markers,
    the names and numbers of limbs too."""
    rand: float
    wrong_edges: list[str]
    wrong_names: list[str]
    names_confidence: float | None


def change_rows(lawful: Sequence[Case], real: Sequence[Case]) -> Iterator[Change]:
    """Yield the laws for every case, and noise and missing samples for the real ones."""
    for case in (*real, *lawful):
        as_it_is = discover(case.recording)
        for unit in (0.1, 10.0):
            other = replace(case.recording, markers=unit * case.recording.markers)
            yield _row(case, f"lengths × {unit:g}", discover(other), as_it_is)
        other = _in_another_order(case.recording)
        yield _row(case, "another order of markers", discover(other), as_it_is, names=True)
    for case in real:
        for draw in range(DRAWS):
            rng = np.random.default_rng([draw, 7])
            markers = case.recording.markers
            for share in (0.05, 0.1):
                gone = rng.random(markers.shape[:2]) < share
                other = replace(case.recording, markers=np.where(gone[..., None], np.nan, markers))
                yield _row(case, f"{share:.0%} of samples missing", discover(other))
            noise = rng.normal(scale=0.002, size=markers.shape)
            other = replace(case.recording, markers=markers + noise)
            yield _row(case, "2 mm of noise", discover(other))


def _row(
    case: Case,
    change: str,
    found: Discovery,
    before: Discovery | None = None,
    *,
    names: bool = False,
) -> Change:
    same = before is not None and _told(found, names=names) == _told(before, names=names)
    others = {label for tree in found.step.findings["other_trees"] for label in tree}
    truth = {label: limb for label, limb in case.truth.items() if label not in others}
    return Change(
        case=case.name,
        change=change,
        law=before is not None,
        same=same,
        rand=rand_of(truth, partition_of(found.model)),
        wrong_edges=wrong_edges(found.model, case.truth, case.edges),
        wrong_names=wrong_names(found.model, case.truth),
        names_confidence=found.step.findings["names_confidence"],
    )


def _told(found: Discovery, *, names: bool) -> Any:
    bodies = {segment.name: frozenset(segment.markers) for segment in found.model.segments}
    joints = {(bodies[joint.parent], bodies[joint.child]) for joint in found.model.joints}
    return (bodies if names else set(bodies.values())), joints


def _in_another_order(recording: Recording) -> Recording:
    order = np.random.default_rng(9).permutation(recording.n_markers)
    return replace(
        recording,
        markers=np.ascontiguousarray(recording.markers[:, order]),
        labels=tuple(recording.labels[i] for i in order),
    )


def changes_section(rows: Sequence[dict[str, Any]]) -> str:
    """Return the page's section."""
    laws, spoilt = [r for r in rows if r["law"]], [r for r in rows if not r["law"]]
    broken = [f"{row['case']}, {row['change']}" for row in laws if not row["same"]]
    lines = [
        "## Units, order, noise, missing samples\n",
        f"All lengths × 0.1 and × 10, and the markers in another order, of "
        f"{len({row['case'] for row in laws})} recordings (the 41 markers, an actor with soft "
        "tissue, gaps and ghosts, a quadruped, a hand, two people): bodies and tree, and for the "
        "order names and numbers of limbs too, are the same in "
        f"{sum(row['same'] for row in laws)} of {len(laws)}"
        f"{'' if not broken else '; not in ' + '; '.join(broken)}.\n",
        "Single samples missing at random, and white noise in each direction:\n",
        "| recording | with | ARI | wrong joints | wrong names (confidence) |",
        "|---|---|---:|---|---|",
    ]
    for row in spoilt:
        sure = row["names_confidence"]
        names = ", ".join(row["wrong_names"]) or "none"
        told = "no names" if sure is None else f"{names} ({sure:.2f})"
        lines.append(
            f"| {row['case']} | {row['change']} | {row['rand']:.3f} "
            f"| {', '.join(row['wrong_edges']) or 'none'} | {told} |"
        )
    return "\n".join(lines) + "\n"
