"""What discovery found and how sure it is, as the history tells it."""

from collections.abc import Sequence

import numpy as np

from kinesphere.data import Array, Json, TopologicalModel
from kinesphere.skeleton.discovery.clustering import merge_curve
from kinesphere.skeleton.discovery.forest import Edge
from kinesphere.skeleton.discovery.joint_doubts import doubts_of_joints, is_told
from kinesphere.skeleton.discovery.names import Names
from kinesphere.skeleton.discovery.partition import Partition
from kinesphere.skeleton.discovery.steadiness import owners
from kinesphere.skeleton.discovery.stillness import still_pairs, told_of_stillness
from kinesphere.skeleton.discovery.trust import DOUBTFUL_COUNT

CURVE = 30
"""Most bodies in the merge curve."""
DOUBTFUL_MARKER = 0.5
"""Confidence below which a marker is steadier in the next body than in its own."""
UNSTEADY = 0.02
"""m, wander within a body from which it is doubted that it is one: people in soft clothes have up
to 0.017, limbs of two markers each that were taken together 0.03 to 0.04."""


def account_of(
    partition: Partition,
    labels: Sequence[str],
    ghosts: Sequence[str],
    model: TopologicalModel,
    names: Names,
    limb_of: dict[int, str],
    near: float,
) -> dict[str, Json]:
    """Return the findings of the step.

    Parameters
    ----------
    labels
        Of the partition's markers.
    ghosts
        Markers seen too rarely to be grouped.
    limb_of
        Body → name of its limb in the model, of the tree that is solved.
    near
        m, as `Rigidity.unlikeness` takes it, at a person's size.
    """
    rigidity, forest, bodies = partition.rigidity, partition.forest, partition.bodies
    unit = partition.unit
    markers = {segment.name: segment.markers for segment in model.segments}
    confidence, owner = partition.confidence, owners(bodies, len(labels))
    curve = merge_curve(rigidity.unlikeness(near), rigidity.wander, CURVE)
    others: list[Json] = [
        [labels[m] for body in tree for m in bodies[body]]
        for tree in forest.trees
        if not limb_of.keys() & set(tree)
    ]
    return {
        "bodies_found": _count(partition),
        "count_confidence": _short(partition.clustering.count_confidence),
        "trees": len(forest.trees),
        "within_bodies_mm": _mm(unit * partition.usual),
        "names_confidence": _short(names.confidence),
        "names_from": names.account,
        "bodies": {
            limb: {
                "markers": ", ".join(markers[limb]),
                "within_mm": _mm(unit * _rms(partition.belonging.own[bodies[body]])),
                "confidence": _short(float(confidence[bodies[body]].min())),
            }
            for body, limb in limb_of.items()
        },
        "joints_found": {
            joint.name: {
                "parent": joint.parent,
                "child": joint.child,
                "cost_mm": _mm(unit * forest_edge.cost),
                "next_best_mm": _mm(unit * forest_edge.next_best),
                "confidence": _short(forest_edge.confidence),
                "doubtful": is_told(forest_edge, names.confidence),
                "n_axes": joint.n_axes,
            }
            for joint in model.joints
            for forest_edge in [_edge(partition, joint.parent, joint.child, limb_of)]
        },
        "marker_confidence": {labels[m]: _short(float(confidence[m])) for m in range(len(labels))},
        "at_joints": {
            labels[m]: limb_of[int(partition.belonging.neighbour[m])]
            for m in partition.shared
            if int(owner[m]) in limb_of
        },
        "loose": [labels[m] for m in partition.loose],
        "ghosts": list(ghosts),
        "other_trees": others,
        "merge_curve_mm": {str(k): _mm(unit * value) for k, value in curve.items()},
        "gaps": {str(k): _short(gap, 4) for k, gap in partition.clustering.gaps.items()},
    }


def doubts_about(
    partition: Partition,
    labels: Sequence[str],
    model: TopologicalModel,
    names: Names,
    limb_of: dict[int, str],
    *,
    count_given: bool,
    faint: Sequence[str],
) -> tuple[str, ...]:
    """Return what a person should be warned of.

    Parameters
    ----------
    partition, labels, model, names, limb_of
        As `account_of` takes them.
    count_given
        Whether the number of bodies was asked for.
    faint
        Joints of bodies that do not plainly move together.
    """
    doubts = []
    if still := told_of_stillness(partition):
        doubts.append(still)
    if len(partition.forest.trees) > 1:
        sizes = [sum(len(partition.bodies[b]) for b in tree) for tree in partition.forest.trees]
        doubts.append(
            f"{len(sizes)} groups of bodies move independently, with "
            f"{', '.join(map(str, sizes))} markers; the one with {_solved(partition, limb_of)} is "
            "solved, the others' markers are kept as they are (set discovery.tree for another one)"
        )
    sure = partition.clustering.count_confidence
    if not count_given and sure < DOUBTFUL_COUNT:
        doubts.append(
            f"{_count(partition)} bodies were found, but their number hardly stands out "
            f"(confidence {sure:.2f}); set discovery.bodies where it is known"
        )
    unsteady = [
        limb
        for body, limb in limb_of.items()
        if _rms(partition.belonging.own[partition.bodies[body]]) > UNSTEADY
    ]
    if unsteady:
        doubts.append(
            f"markers move apart within {', '.join(unsteady)}: each may be several bodies of too "
            "few markers, and the number of bodies is in doubt"
        )
    edges = [(j.name, _edge(partition, j.parent, j.child, limb_of)) for j in model.joints]
    apart = still_pairs(partition)
    if resting := [name for name, edge in edges if (edge.a, edge.b) in apart]:
        doubts.append(
            f"limbs move against each other no more than markers within them do at "
            f"{', '.join(resting)}: each two may be one body, and the number of bodies is in doubt"
        )
    doubts += doubts_of_joints(edges, names.confidence)
    if faint:
        doubts.append(
            f"hardly anything shows a joint at {', '.join(faint)}: a limb there stays about where "
            "it is, as bodies that have nothing to do with each other may"
        )
    confidence = partition.confidence
    unsure = [
        labels[m]
        for body in limb_of
        for m in partition.bodies[body]
        if confidence[m] < DOUBTFUL_MARKER
    ]
    if unsure:
        doubts.append(
            f"{', '.join(unsure)} move as much with a neighbouring limb as with their own"
        )
    if partition.loose:
        doubts.append(
            f"{', '.join(labels[m] for m in partition.loose)} belong to no body: loose, or a limb "
            "of one marker"
        )
    if names.doubt:
        doubts.append(names.doubt)
    return tuple(doubts)


def _count(partition: Partition) -> int:
    return sum(size > 0 for size in partition.sizes)


def _solved(partition: Partition, limb_of: dict[int, str]) -> int:
    return sum(len(partition.bodies[body]) for body in limb_of)


def _edge(partition: Partition, parent: str, child: str, limb_of: dict[int, str]) -> Edge:
    ends = {body for body, limb in limb_of.items() if limb in (parent, child)}
    return next(edge for edge in partition.forest.edges if {edge.a, edge.b} == ends)


def _rms(values: Array) -> float:
    known = values[np.isfinite(values)]
    return float(np.sqrt(np.mean(known**2))) if len(known) else np.nan


def _mm(metres: float) -> Json:
    return _short(metres * 1e3)


def _short(value: float, digits: int = 3) -> Json:
    return round(float(value), digits) if np.isfinite(value) else None
