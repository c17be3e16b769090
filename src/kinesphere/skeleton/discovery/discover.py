"""Trajectories in, a topological model out: which markers are a body, and which bodies meet."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from kinesphere.data import (
    Array,
    JointModel,
    Landmark,
    Recording,
    Segment,
    Step,
    TopologicalModel,
    settings_as_json,
)
from kinesphere.errors import BadRecording, DegenerateMotion
from kinesphere.geometry.rigid import RigidFit
from kinesphere.skeleton.degrees import count_axes
from kinesphere.skeleton.discovery.account import account_of, doubts_about
from kinesphere.skeleton.discovery.figure import make_figure
from kinesphere.skeleton.discovery.forest import Forest, rerooted
from kinesphere.skeleton.discovery.joint_costs import JointCosts
from kinesphere.skeleton.discovery.joint_markers import OWN_POSE, owners
from kinesphere.skeleton.discovery.names import Names, find_names, no_names, settled, shaken
from kinesphere.skeleton.discovery.partition import Partition, find_partition
from kinesphere.skeleton.discovery.rigidity import worth_grouping
from kinesphere.skeleton.discovery.rival_trees import similar_forests
from kinesphere.skeleton.discovery.settings import DiscoverySettings
from kinesphere.skeleton.discovery.size import PERSON, from_the_middle, subject_size
from kinesphere.skeleton.discovery.spikes import without_spikes
from kinesphere.skeleton.discovery.twigs import TORSO, without_twigs
from kinesphere.skeleton.landmarks import STEADY
from kinesphere.skeleton.naming import joint_name
from kinesphere.skeleton.sampling import spread_frames
from kinesphere.skeleton.scale import size_share
from kinesphere.skeleton.settings import SkeletonSettings

MODEL = "motion alone"
"""Name of every model found so."""
UNLIKELY = 20.0
"""What a doubtful edge's rival costs for each e-fold that its own cost is larger: 15 % more cost as
much as three squared standard deviations of a person's proportions."""
AT_THE_JOINT = 0.06
"""m, how far a joint's centre may be from a marker over it: half a knee's width with the marker,
and as much again."""


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
    partition = find_partition(points, settings, limits, costs)
    labels = tuple(recording.labels[c] for c in columns)
    _check_tree(partition, labels, settings.tree)
    partition, tree, names = _named(partition, costs, settings)
    if settings.bodies is None:
        partition, tree, names = without_twigs(partition, tree, names, settings, limits)
    forest = _from_the_torso(partition, names.limbs)
    tree = next(t for t in forest.trees if tree[0] in t)
    partition = replace(partition, forest=forest)
    counted = 1.0 if settings.bodies else partition.clustering.count_confidence
    names = shaken(settled(names, tree), forest, counted)
    limb_of = {body: names.limbs[body] for body in tree}
    model = _model(partition, costs, limb_of, labels, recording.labels)
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


def _named(
    partition: Partition, costs: JointCosts, settings: DiscoverySettings
) -> tuple[Partition, tuple[int, ...], Names]:
    """Name the limbs of the tree that was asked for.

    Where an edge is doubtful and the next best one makes a person of the tree, that one counts:
    people are what is mostly recorded.
    """
    at = settings.tree - 1
    tree = partition.forest.trees[at]
    if not settings.names:
        return partition, tree, no_names(tree)
    over: dict[frozenset[int], list[int]] = {}
    owner = owners(partition.bodies, len(partition.rigidity.mean))
    for m in partition.shared:
        pair = frozenset((int(owner[m]), int(partition.belonging.neighbour[m])))
        over.setdefault(pair, []).append(m)
    places: dict[frozenset[int], Array] = {}

    best: tuple[float, Forest, tuple[int, ...], Names] | None = None
    for forest, unlikely in similar_forests(partition.forest, at):
        there = next(t for t in forest.trees if tree[0] in t)
        pairs = [(edge.a, edge.b) for edge in forest.edges if edge.a in there]
        figure = make_figure(costs, partition.bodies, pairs, over, places)
        names = find_names(figure, there)
        cost = names.cost + UNLIKELY * unlikely if names.given else np.inf
        if best is None or cost < best[0]:
            best = cost, forest, there, names
    assert best is not None  # the forest itself is the first
    _, forest, there, names = best
    return replace(partition, forest=forest), there, names


def _from_the_torso(partition: Partition, limb_of: dict[int, str]) -> Forest:
    """Let the tree hang from the pelvis, or from the trunk where it is the one that has a pose."""
    for limb in TORSO:
        for body, name in limb_of.items():
            if name == limb and len(partition.bodies[body]) >= OWN_POSE:
                return rerooted(partition.forest, body)
    return partition.forest


def _model(
    partition: Partition,
    costs: JointCosts,
    limb_of: dict[int, str],
    labels: Sequence[str],
    in_file: Sequence[str],
) -> TopologicalModel:
    """Return the model of one tree; ``limb_of`` has its bodies in order, the root first."""
    at = {label: column for column, label in enumerate(in_file)}
    owner = owners(partition.bodies, len(labels))
    visits = {m: int(partition.belonging.neighbour[m]) for m in partition.shared}
    segments = tuple(
        Segment(
            limb,
            tuple(sorted((labels[m] for m in partition.bodies[body]), key=at.__getitem__)),
            shared=tuple(labels[m] for m, next_one in visits.items() if next_one == body),
        )
        for body, limb in limb_of.items()
    )
    joints = []
    for number, body in enumerate(list(limb_of)[1:], start=1):
        edge = partition.forest.edge(body)
        parent, child = limb_of[edge.a], limb_of[edge.b]
        over = [m for m, there in visits.items() if {int(owner[m]), there} == {edge.a, edge.b}]
        landmark = Landmark(
            weights={labels[m]: 1 / len(over) for m in over},
            spread=AT_THE_JOINT * size_share(costs.points * costs.unit),
            source=STEADY,
        )
        joints.append(
            JointModel(
                joint_name(parent, child, number),
                parent,
                child,
                n_axes=_axes(
                    costs.pose(partition.bodies[edge.a]), costs.pose(partition.bodies[body])
                ),
                landmarks=(landmark,) if over else (),
            )
        )
    return TopologicalModel(
        name=MODEL,
        segments=segments,
        joints=tuple(joints),
        root=next(iter(limb_of.values())),
        required=tuple(label for segment in segments for label in segment.markers),
        description="found from motion alone",
    )


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


def _axes(parent: RigidFit | None, child: RigidFit | None) -> int | None:
    if parent is None or child is None:
        return None
    return count_axes(np.swapaxes(parent.rotations, 1, 2) @ child.rotations)
