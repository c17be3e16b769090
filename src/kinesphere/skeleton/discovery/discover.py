"""Trajectories in, a topological model out: which markers are a body, and which bodies meet."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from kinesphere.data import (
    Recording,
    Step,
    TopologicalModel,
    settings_as_json,
)
from kinesphere.errors import BadRecording, DegenerateMotion
from kinesphere.skeleton.discovery.account import account_of, doubts_about
from kinesphere.skeleton.discovery.forest import Forest, rerooted
from kinesphere.skeleton.discovery.joint_costs import JointCosts
from kinesphere.skeleton.discovery.names import settled
from kinesphere.skeleton.discovery.partition import Partition, find_partition
from kinesphere.skeleton.discovery.rigidity import trimmed_share, worth_grouping
from kinesphere.skeleton.discovery.settings import DiscoverySettings
from kinesphere.skeleton.discovery.size import PERSON, from_the_middle, subject_size
from kinesphere.skeleton.discovery.spikes import without_spikes
from kinesphere.skeleton.discovery.steadiness import OWN_POSE
from kinesphere.skeleton.discovery.tree_model import tree_model
from kinesphere.skeleton.discovery.tree_names import named_tree
from kinesphere.skeleton.discovery.trust import shaken
from kinesphere.skeleton.discovery.twigs import TORSO, without_twigs
from kinesphere.skeleton.sampling import spread_frames
from kinesphere.skeleton.settings import SkeletonSettings


@dataclass(frozen=True, eq=False)
class Discovery:
    """What motion alone tells."""

    model: TopologicalModel
    """Of the tree that was asked for."""
    step: Step
    """What was found and how sure it is, other trees and loose markers included."""


def discover(
    recording: Recording,
    settings: DiscoverySettings | None = None,
    skeleton: SkeletonSettings | None = None,
) -> Discovery:
    """Find marker bodies, the joints between them and the limbs they are, from motion alone.

    In the spirit of Hornung, Sar-Dessai & Kobbelt (IEEE VR 2005), whose internals are not public:
    markers whose distances stay the same ride on one body; bodies that move about a common point
    meet at a joint; a spanning tree of the cheapest joints is the skeleton. What moves
    independently is a tree of its own. Labels play no part.

    Parameters
    ----------
    recording
        In any right-handed axes, metres; NaN where not seen.
    settings
    skeleton
        What counts as an outlier and as a line when limbs are measured.

    Raises
    ------
    BadRecording
        If there are too few markers or frames, or no such tree.
    DegenerateMotion
        If the markers hardly move relative to each other, or no body has the three markers that a
        root needs.
    """
    settings = settings or DiscoverySettings()
    worth = worth_grouping(recording.seen, recording.rate, settings.ghost_s)
    columns = np.flatnonzero(worth)
    if len(columns) < 3:
        raise BadRecording(
            f"{len(columns)} of {recording.n_markers} markers are seen for long enough to be "
            "grouped into bodies; at least 3 are needed. What is never around for "
            f"{settings.ghost_s:g} s counts as a reflection (discovery.ghost_s)"
        )
    columns = columns[from_the_middle(recording.markers[:, columns])]
    markers = without_spikes(recording.markers[:, columns])
    unit = subject_size(markers) / PERSON
    markers /= unit  # from here on the subject is as large as a person
    points = np.ascontiguousarray(markers[spread_frames(markers, settings.sample_frames)])
    limits = skeleton or SkeletonSettings()
    costs = JointCosts(points, unit)
    trim = trimmed_share(recording.n_frames / recording.rate, settings.ghost_s)
    partition = find_partition(points, settings, limits, costs, trim=trim)
    labels = tuple(recording.labels[c] for c in columns)
    _check_tree(partition, labels, settings.tree)
    partition, tree, names = named_tree(partition, costs, settings)
    if settings.bodies is None:
        partition, tree, names = without_twigs(partition, tree, names, settings, limits)
    forest = _from_the_torso(partition, names.limbs)
    tree = next(t for t in forest.trees if tree[0] in t)
    partition = replace(partition, forest=forest)
    counted = 1.0 if settings.bodies else partition.clustering.count_confidence
    names = shaken(settled(names, tree), forest, counted)
    limb_of = {body: names.limbs[body] for body in tree}
    model = tree_model(partition, costs, limb_of, labels, recording.labels)
    near = settings.near_mm * 1e-3
    ghosts = [
        label
        for column, label in enumerate(recording.labels)
        if recording.seen[:, column].any() and not worth[column]
    ]
    step = Step(
        name="discovery",
        settings=settings_as_json(settings),
        findings=account_of(partition, labels, ghosts, model, names, limb_of, near),
        warnings=doubts_about(
            partition,
            labels,
            model,
            names,
            limb_of,
            count_given=settings.bodies is not None,
            faint=_faint(partition, costs, limb_of, model),
        ),
    )
    return Discovery(model, step)


def _check_tree(partition: Partition, labels: Sequence[str], number: int) -> None:
    forest = partition.forest
    if number > len(forest.trees):
        raise BadRecording(
            f"tree {number} was asked for; {len(forest.trees)} move independently here"
        )
    tree = forest.trees[number - 1]
    if len(partition.bodies[tree[0]]) < OWN_POSE:
        told = "; ".join(" ".join(labels[m] for m in partition.bodies[body]) for body in tree)
        raise DegenerateMotion(
            f"no body has the three markers that a root needs; the bodies are {told}"
        )


def _from_the_torso(partition: Partition, limb_of: dict[int, str]) -> Forest:
    """Let the tree hang from the pelvis, or from the trunk where it is the one that has a pose."""
    for limb in TORSO:
        for body, name in limb_of.items():
            if name == limb and len(partition.bodies[body]) >= OWN_POSE:
                return rerooted(partition.forest, body)
    return partition.forest


def _faint(
    partition: Partition, costs: JointCosts, limb_of: dict[int, str], model: TopologicalModel
) -> list[str]:
    """Return the joints of bodies that do not plainly move together."""
    markers = {limb: partition.bodies[body] for body, limb in limb_of.items()}
    return [
        joint.name
        for joint in model.joints
        if not costs.plain(markers[joint.parent], markers[joint.child])
    ]
