"""The paper's labeller: rigid sets by spectral clustering, local k-d trees, articulated order.

W. Huang, S. Xia (2010), "Building Local k-d Tree for Flexibly Labeling Articulated Point Sets",
section 3. What the paper leaves open is settled as ``docs/papers.md`` says.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Array, TopologicalModel
from kinesphere.geometry.pair_distances import pair_distances
from kinesphere.geometry.signature import FRAMES, evenly_spread, scale_of
from kinesphere.geometry.spectral import k_means, self_tuning_affinity, spectrum
from kinesphere.labelling.local_tree import aligned, match_leaves, shape_from_distances
from kinesphere.labelling.matching import Match, nothing
from kinesphere.labelling.similarity_tree import from_votes
from kinesphere.labelling.template import Template, template_of

NEIGHBOUR = 2
"""Nearest neighbour that sets the local scale. The paper takes the 5th because no group has more
than 5 markers, which puts it outside the group; the 2nd finds more partitions."""
VOTING = 100
"""Frames in which the local trees of a segment vote."""
SEED = 20100517


@dataclass(frozen=True)
class _Part:
    """A segment as the paper means it: its own markers and those it shares."""

    name: str
    own: list[int]
    shared: list[int]


def match_huang_xia(points: Array, model: TopologicalModel) -> Match:
    """Label points segment by segment, from the root outward.

    It assumes what the paper assumes: every marker there, seen in most frames, and all joints
    moved. Groups whose size is not their segment's are matched as far as both go.
    """
    template = template_of(model)
    n_points = points.shape[1]
    at = {name: i for i, name in enumerate(template.labels)}
    parts = {
        s.name: _Part(
            s.name,
            [at[x] for x in s.markers if x in at],
            [at[x] for x in s.shared if x in at],
        )
        for s in model.segments
        if any(x in at for x in s.markers)
    }
    if n_points < len(parts):
        return nothing(n_points, f"{n_points} points are fewer than the {len(parts)} segments")
    found = pair_distances(points[evenly_spread(len(points), FRAMES)])
    deviation = np.where(np.isfinite(found.std), found.std, np.nanmax(found.std, initial=0.0))
    groups = _groups(deviation, parts)
    labels = _articulated(points, found.mean, deviation, groups, model, parts, template)
    votes = np.zeros((n_points, template.n))
    for k, votes_of in labels.items():
        votes[k] = votes_of
    return from_votes(votes, model, template.labels)


def _groups(deviation: Array, parts: dict[str, _Part]) -> list[NDArray[np.intp]]:
    """Return the rigid groups: two halves first, then as many in each as the model has segments."""
    halves = _clusters(deviation, 2)
    lower = [p for p in parts.values() if _is_lower(p.name)]
    n_lower = sum(len(p.own) for p in lower)
    if not lower or len(lower) == len(parts):
        return _clusters(deviation, len(parts))
    # the half whose size is the lower body's
    halves.sort(key=lambda half: abs(len(half) - n_lower))
    counts = (len(lower), len(parts) - len(lower))
    groups = []
    for half, k in zip(halves, counts, strict=True):
        inner = deviation[np.ix_(half, half)]
        groups += [half[group] for group in _clusters(inner, min(k, len(half)))]
    return groups


def _is_lower(name: str) -> bool:
    return name.endswith(("thigh", "shank", "foot"))


def _clusters(deviation: Array, k: int) -> list[NDArray[np.intp]]:
    """Return k groups by self-tuning spectral clustering (1)."""
    if k >= len(deviation):
        return [np.array([i]) for i in range(len(deviation))]
    rows = spectrum(self_tuning_affinity(deviation, NEIGHBOUR)).embedding(k)
    numbers = k_means(rows, k, np.random.default_rng(SEED))
    return [np.flatnonzero(numbers == number) for number in np.unique(numbers)]


def _articulated(
    points: Array,
    mean: Array,
    deviation: Array,
    groups: list[NDArray[np.intp]],
    model: TopologicalModel,
    parts: dict[str, _Part],
    template: Template,
) -> dict[int, Array]:
    """Return the votes for each point, segment after segment from the root outward."""
    votes: dict[int, Array] = {}
    bearer: dict[int, int] = {}
    left = list(groups)
    order = [(model.root, ""), *((j.child, j.parent) for j in model.joints_from_root)]
    for name, parent in order:
        if name not in parts or not left:
            continue
        part = parts[name]
        near = [bearer[i] for i in part.shared if i in bearer]
        if not near and parent in parts:
            near = [bearer[i] for i in parts[parent].own if i in bearer]
        group = min(left, key=lambda g: _cost(g, near, part, mean, deviation, template))
        left = [g for g in left if g is not group]
        lost = [i for i in part.shared if i in bearer]
        for point, label, count in _locally(points, group, part, lost, bearer, template):
            votes.setdefault(point, np.zeros(template.n))[label] += count
        for point in group:
            if int(point) in votes:
                bearer[int(votes[int(point)].argmax())] = int(point)
    return votes


def _cost(
    group: NDArray[np.intp],
    near: Sequence[int],
    part: _Part,
    mean: Array,
    deviation: Array,
    template: Template,
) -> float:
    """Return how badly a group fits a segment: its size, and its tie to what is labelled.

    Where nothing is labelled yet, the waist, the tie is to all other points: the paper's group of
    the upper body with the least deviation to the lower one.
    """
    others = np.asarray(near) if len(near) else np.setdiff1d(np.arange(len(mean)), group)
    tie = float(deviation[np.ix_(group, others)].mean()) if len(others) else 0.0
    scale = scale_of(mean)
    size = abs(len(group) - len(part.own)) / max(len(part.own), 1)
    inner = template.mean[np.ix_(part.own, part.own)]
    extent = abs(_extent(mean[np.ix_(group, group)] / scale) - _extent(inner))
    return tie / scale + 0.1 * size + extent


def _extent(distances: Array) -> float:
    return float(np.nanmax(distances, initial=0.0))


def _locally(
    points: Array,
    group: NDArray[np.intp],
    part: _Part,
    lost: list[int],
    bearer: dict[int, int],
    template: Template,
) -> list[tuple[int, int, int]]:
    """Return (point, label, frames) by the local trees of one segment."""
    labels = np.array([*part.own, *lost], dtype=np.intp)
    members = np.array([*group, *(bearer[i] for i in lost)], dtype=np.intp)
    n = min(len(labels), len(members))
    labels, members = labels[:n], members[:n]
    inner = template.mean[np.ix_(labels, labels)]
    place = {int(label): i for i, label in enumerate(labels)}
    handed = [
        [*(place[int(i)] for i in four), sign]
        for four, sign in zip(template.quadruples, template.handedness, strict=True)
        if all(int(i) in place for i in four)
    ]
    shape = shape_from_distances(inner, np.array(handed).reshape(-1, 5))
    seen = np.flatnonzero(np.isfinite(points[:, members]).all(axis=(1, 2)))
    count: dict[tuple[int, int], int] = {}
    for t in seen[evenly_spread(len(seen), VOTING)]:
        order = match_leaves(shape - shape.mean(axis=0), aligned(points[t, members], shape))
        for label, k in zip(labels, order, strict=True):
            if int(members[k]) in group and int(label) in part.own:
                pair = int(members[k]), int(label)
                count[pair] = count.get(pair, 0) + 1
    return [(point, label, frames) for (point, label), frames in count.items()]
