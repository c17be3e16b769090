"""A topological model learnt from labelled recordings: limbs given, joints from the motion."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import combinations

import numpy as np

from kinesphere.data import Array, JointModel, Recording, Segment, TopologicalModel
from kinesphere.data.label_sides import mirror_pairs
from kinesphere.errors import BadModel
from kinesphere.skeleton.degrees import count_axes
from kinesphere.skeleton.naming import joint_name
from kinesphere.skeleton.sampling import spread_frames
from kinesphere.skeleton.statistics import marker_statistics
from kinesphere.skeleton.topology import joint_cost, limb_poses, spanning_tree

FRAMES = 400
"""Frames of each recording that joints are looked for on."""


def learn_model(
    recordings: Sequence[Recording],
    name: str,
    segments: Mapping[str, Sequence[str]] | None = None,
    model: TopologicalModel | None = None,
) -> TopologicalModel:
    """Learn a topological model from labelled recordings.

    With ``segments`` the joints come from the motion; with ``model`` (a built-in one, say) limbs
    and joints are its own, and the recordings add the distances that labelling compares with.

    Parameters
    ----------
    recordings
        Labelled; of one layout, of one or several people.
    name
        What to call the model.
    segments
        Limb → labels. Limb names of the conventions name the joints; others get ``joint_01``….
    model
        Used where there are no segments.

    Raises
    ------
    BadModel
        If neither segments nor a model are given, a label is in no recording, no recording is
        given, or a limb was never seen together with any other.
    """
    if not recordings:
        raise BadModel(f"model {name}: no recording to learn from; one at least is needed")
    if segments is None:
        if model is None:
            raise BadModel(f"model {name}: needs the segments of its markers, or a model to refine")
        learnt = replace(model, name=name)
    else:
        learnt = _from_segments(recordings, name, segments)
    statistics = tuple(
        marker_statistics(recording, learnt.labels, f"{name} {i + 1}")
        for i, recording in enumerate(recordings)
    )
    return replace(learnt, statistics=(*learnt.statistics, *statistics))


def _from_segments(
    recordings: Sequence[Recording], name: str, segments: Mapping[str, Sequence[str]]
) -> TopologicalModel:
    everywhere = {label for recording in recordings for label in recording.labels}
    kept = {limb: tuple(labels) for limb, labels in segments.items() if labels}
    missing = sorted({x for labels in kept.values() for x in labels} - everywhere)
    if missing or len(kept) < 1:
        raise BadModel(
            f"model {name}: no recording has the markers {', '.join(missing)}"
            if missing
            else f"model {name}: there are no segments with markers"
        )
    limbs = tuple(kept)
    costs: dict[tuple[str, str], list[float]] = {pair: [] for pair in combinations(limbs, 2)}
    axes: dict[tuple[str, str], list[int]] = {pair: [] for pair in costs}
    for recording in recordings:
        clouds = _clouds(recording, kept)
        poses = limb_poses(clouds)
        for a, b in costs:
            if a not in clouds or b not in clouds:
                continue
            cost = joint_cost(clouds[a], clouds[b], poses.get(a), poses.get(b))
            costs[a, b].append(cost)
            if a in poses and b in poses:
                relative = np.swapaxes(poses[a].rotations, 1, 2) @ poses[b].rotations
                if found := count_axes(relative):
                    axes[a, b].append(found)
    mean = {pair: float(np.mean(c)) if c else np.inf for pair, c in costs.items()}
    edges = spanning_tree(limbs, mean)
    if len(edges) < len(limbs) - 1:
        joined = {limb for edge in edges for limb in edge}
        alone = [limb for limb in limbs if limb not in joined] or list(limbs)
        raise BadModel(
            f"model {name}: no joint leads to {', '.join(alone)}; every limb must be seen together "
            "with another one"
        )
    root = _root(kept, edges)
    joints: list[JointModel] = []
    for parent, child in _outward(root, edges):
        pair = (parent, child) if (parent, child) in axes else (child, parent)
        # one recording without the movement does not make a hinge of a ball joint
        n_axes = max(axes[pair], default=None)
        joints.append(JointModel(joint_name(parent, child, len(joints) + 1), parent, child, n_axes))
    labels = tuple(label for own in kept.values() for label in own)
    return TopologicalModel(
        name=name,
        segments=tuple(Segment(limb, own) for limb, own in kept.items()),
        joints=tuple(joints),
        root=root,
        required=labels,
        mirror=mirror_pairs(labels),
        description=f"learnt from {len(recordings)} recording{'s' if len(recordings) > 1 else ''}",
    )


def _clouds(recording: Recording, segments: Mapping[str, tuple[str, ...]]) -> dict[str, Array]:
    at = {label: i for i, label in enumerate(recording.labels)}
    frames = spread_frames(recording.markers, FRAMES)
    clouds = {}
    for limb, labels in segments.items():
        columns = [at[label] for label in labels if label in at]
        points = recording.markers[frames][:, columns]
        seen = np.isfinite(points).all(axis=2).any(axis=0) if columns else np.zeros(0, dtype=bool)
        if seen.any():
            clouds[limb] = points[:, seen]
    return clouds


def _root(segments: Mapping[str, tuple[str, ...]], edges: list[tuple[str, str]]) -> str:
    """Return pelvis or trunk, else the limb with most neighbours, then most markers."""
    for known in ("pelvis", "trunk"):
        if known in segments:
            return known
    degree = {limb: sum(limb in edge for edge in edges) for limb in segments}
    return max(segments, key=lambda limb: (degree[limb], len(segments[limb])))


def _outward(root: str, edges: list[tuple[str, str]]) -> list[tuple[str, str]]:
    """Return the edges as (parent, child), parents first."""
    ordered: list[tuple[str, str]] = []
    reached, left = {root}, list(edges)
    while left:
        ready = [e for e in left if e[0] in reached or e[1] in reached]
        for a, b in ready:
            parent, child = (a, b) if a in reached else (b, a)
            ordered.append((parent, child))
            reached.add(child)
        left = [e for e in left if e not in ready]
    return ordered
