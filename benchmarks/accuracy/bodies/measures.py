"""How good a partition, a tree, names and joint centres are, where the truth is known."""

from collections import Counter
from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from kinesphere.data import TopologicalModel

Array = NDArray[np.float64]


def adjusted_rand(truth: Sequence[str], found: Sequence[str]) -> float:
    """Return the adjusted Rand index of two partitions (Hubert & Arabie 1985): 1 if they agree."""
    table = np.zeros((len(set(truth)), len(set(found))))
    rows = {name: i for i, name in enumerate(dict.fromkeys(truth))}
    columns = {name: i for i, name in enumerate(dict.fromkeys(found))}
    for a, b in zip(truth, found, strict=True):
        table[rows[a], columns[b]] += 1
    together, in_rows, in_columns = (
        float((x * (x - 1) / 2).sum()) for x in (table, table.sum(axis=1), table.sum(axis=0))
    )
    n = len(truth)
    chance = in_rows * in_columns / (n * (n - 1) / 2)
    most = (in_rows + in_columns) / 2
    return 1.0 if most == chance else (together - chance) / (most - chance)


def partition_of(model: TopologicalModel, others: Sequence[Sequence[str]] = ()) -> dict[str, str]:
    """Return label → body; the bodies of other trees, which are no limbs, count as one each."""
    own = {label: segment.name for segment in model.segments for label in segment.markers}
    return own | {label: f"tree {i}" for i, tree in enumerate(others) for label in tree}


def rand_of(truth: Mapping[str, str], found: Mapping[str, str]) -> float:
    """Return the adjusted Rand index over the labels of the truth; a label of no body is alone."""
    labels = list(truth)
    return adjusted_rand(
        [truth[label] for label in labels], [found.get(label, f"alone {label}") for label in labels]
    )


def true_names(model: TopologicalModel, truth: Mapping[str, str]) -> dict[str, str]:
    """Return each found body's true limb: the one most of its markers are of; empty for none."""
    named = {}
    for segment in model.segments:
        votes = Counter(truth[label] for label in segment.markers if truth.get(label))
        named[segment.name] = votes.most_common(1)[0][0] if votes else ""
    return named


def wrong_edges(
    model: TopologicalModel, truth: Mapping[str, str], edges: set[frozenset[str]]
) -> list[str]:
    """Return the joints between bodies no limbs of which meet.

    A limb found as two bodies that meet, or two limbs found as one body, are no wrong joints: that
    shows in the partition.
    """
    limbs = _limbs_in(model, truth)
    names = true_names(model, truth)
    wrong = []
    for joint in model.joints:
        pairs = [(a, b) for a in limbs[joint.parent] for b in limbs[joint.child]]
        if pairs and not any(a == b or frozenset((a, b)) in edges for a, b in pairs):
            wrong.append(f"{names[joint.parent]}–{names[joint.child]}")
    return wrong


def _limbs_in(model: TopologicalModel, truth: Mapping[str, str]) -> dict[str, set[str]]:
    """Return each found body's true limbs: where most of it is of, and those mostly in it."""
    sizes = Counter(truth.values())
    limbs = {}
    for segment in model.segments:
        votes = Counter(truth[label] for label in segment.markers if truth.get(label))
        whole = {limb for limb, n in votes.items() if 2 * n > sizes[limb]}
        limbs[segment.name] = whole | {limb for limb, _ in votes.most_common(1)}
    return limbs


def wrong_names(model: TopologicalModel, truth: Mapping[str, str]) -> list[str]:
    """Return the limbs whose name is not that of most of their markers; numbers are no names."""
    names = true_names(model, truth)
    return [
        f"{name} is {names[name]}"
        for name in names
        if not name.startswith("limb_") and names[name] and names[name] != name
    ]
