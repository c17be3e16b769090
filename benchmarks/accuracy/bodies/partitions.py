"""Bodies, trees and names of every case, by both ways of clustering."""

import time
from collections.abc import Iterable, Iterator
from contextlib import suppress
from dataclasses import dataclass, field

import numpy as np

from benchmarks.accuracy.bodies.cases import Case
from benchmarks.accuracy.bodies.measures import (
    partition_of,
    rand_of,
    true_names,
    wrong_edges,
    wrong_names,
)
from kinesphere.data import TopologicalModel
from kinesphere.errors import KinesphereError
from kinesphere.skeleton import Discovery, DiscoverySettings, discover, fit_skeleton

METHODS = ("spectral", "linkage")


@dataclass(frozen=True)
class Row:
    """One case, by one method."""

    case: str
    method: str
    rand: float
    bodies: int
    true_bodies: int
    wrong_edges: list[str]
    edges: int
    named: int
    wrong_names: list[str]
    trees: int
    loose: int
    seconds: float
    failure: str = ""
    centres_mm: dict[str, float] = field(default_factory=dict)
    """True joint → distance of the centre from the true one that stays the same over time, in the
    parent; across the axis for joints of one axis."""
    centres_rms_mm: dict[str, float] = field(default_factory=dict)
    """The same with what changes from frame to frame, rms."""


def rows(cases: Iterable[Case], *, centres: bool = False) -> Iterator[Row]:
    """Yield a row for every case and method; joint centres by the default method, if asked."""
    for case in cases:
        for method in METHODS:
            yield _row(case, method, centres=centres and method == METHODS[0])


def _row(case: Case, method: str, *, centres: bool) -> Row:
    start = time.process_time()
    n_true = len(set(case.truth.values()))
    try:
        found = discover(case.recording, DiscoverySettings(method=method))
    except KinesphereError as error:
        return Row(
            *(case.name, method, np.nan, 0, n_true, [], 0, 0, [], 0, 0),
            time.process_time() - start,
            f"{type(error).__name__}: {error}",
        )
    seconds = time.process_time() - start
    told = found.step.findings
    models = [found.model, *_other_models(case, method, int(told["trees"]))]
    partition = {
        label: f"{i}:{body}"
        for i, model in enumerate(models)
        for label, body in partition_of(model).items()
    }
    names = [segment.name for model in models for segment in model.segments]
    plain = {label: limb.rpartition(":")[2] for label, limb in case.truth.items()}
    edges = case.edges
    return Row(
        case=case.name,
        method=method,
        rand=rand_of(case.truth, partition),
        bodies=int(told["bodies_found"]),
        true_bodies=n_true,
        wrong_edges=[w for m in models for w in wrong_edges(m, case.truth, edges)] if edges else [],
        edges=sum(len(model.joints) for model in models) if edges else 0,
        named=sum(not name.startswith("limb_") for name in names),
        wrong_names=[wrong for model in models for wrong in wrong_names(model, plain)],
        trees=int(told["trees"]),
        loose=len(told["loose"]),
        seconds=seconds,
        **(_centres(case, found) if centres and case.performance else {}),
    )


def _other_models(case: Case, method: str, trees: int) -> Iterator[TopologicalModel]:
    """Yield what `discovery.tree` solves of the other trees; one that cannot be is left alone."""
    for tree in range(2, trees + 1):
        with suppress(KinesphereError):
            yield discover(case.recording, DiscoverySettings(method=method, tree=tree)).model


def _centres(case: Case, found: Discovery) -> dict[str, dict[str, float]]:
    """Return the errors in mm of every true joint's centre."""
    performance = case.performance
    assert performance is not None
    motion = fit_skeleton(case.recording, found.model)
    names = true_names(found.model, case.truth)
    at = {
        frozenset((names[joint.parent], names[joint.child])): j
        for j, joint in enumerate(motion.skeleton.joints)
    }
    measured = motion.joint_centres()
    constant, rms = {}, {}
    for j, joint in enumerate(performance.skeleton.joints):
        key = frozenset((joint.parent, joint.child))
        if key not in at:
            continue
        off = measured[:, at[key]] - performance.joint_centres[:, j]
        parent = performance.skeleton.limb_names.index(joint.parent)
        off = np.einsum("fji,fj->fi", performance.motion.rotations[:, parent], off)
        if joint.axes is not None and len(joint.axes) == 1:
            axis = joint.axes[0]
            off = off - (off @ axis)[:, None] * axis
        constant[joint.name] = 1e3 * float(np.linalg.norm(np.nanmean(off, axis=0)))
        rms[joint.name] = 1e3 * float(np.sqrt(np.nanmean((off**2).sum(axis=1))))
    return {"centres_mm": constant, "centres_rms_mm": rms}
