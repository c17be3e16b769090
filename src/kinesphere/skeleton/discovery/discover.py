"""Trajectories in, a topological model out: which markers are a body, and which bodies meet."""

from dataclasses import dataclass, replace

import numpy as np

from kinesphere.data import (
    Recording,
    Step,
    TopologicalModel,
    settings_as_json,
)
from kinesphere.errors import BadRecording
from kinesphere.geometry.lifetimes import worth_grouping
from kinesphere.geometry.vectors import is_seen
from kinesphere.skeleton.discovery.account import account_of, doubts_about
from kinesphere.skeleton.discovery.asked import check_bodies, check_places, check_tree
from kinesphere.skeleton.discovery.continued import find_continued
from kinesphere.skeleton.discovery.copies import (
    find_copies,
    told_of_copies,
    told_of_pieces,
    with_more,
    with_pieces,
    with_pieces_joined,
)
from kinesphere.skeleton.discovery.joint_costs import JointCosts
from kinesphere.skeleton.discovery.leftover import Leftover, left_over, settle
from kinesphere.skeleton.discovery.lives import all_broken, find_lives, with_lives_joined
from kinesphere.skeleton.discovery.names import settled
from kinesphere.skeleton.discovery.partition import Partition, find_partition
from kinesphere.skeleton.discovery.rigidity import trimmed_share
from kinesphere.skeleton.discovery.root import from_the_root
from kinesphere.skeleton.discovery.settings import DiscoverySettings
from kinesphere.skeleton.discovery.size import PERSON, from_the_middle, subject_size
from kinesphere.skeleton.discovery.tree_model import tree_model
from kinesphere.skeleton.discovery.tree_names import named_tree
from kinesphere.skeleton.discovery.trust import shaken
from kinesphere.skeleton.discovery.twigs import without_twigs
from kinesphere.skeleton.sampling import spread_frames
from kinesphere.skeleton.scale import times_too_large
from kinesphere.skeleton.settings import SkeletonSettings
from kinesphere.skeleton.strays import without_strays


@dataclass(frozen=True, eq=False)
class Discovery:
    """What motion alone tells."""

    model: TopologicalModel
    """Of the tree that was asked for."""
    step: Step
    """What was found and how sure it is, other trees and loose markers included."""
    unit: float | None = None
    """By which factor lengths are too large, or below 1 too small, for the person that was
    found; for `fit_skeleton`. None where nothing says so."""


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
        If there are too few markers or frames for the bodies that are asked for, no such tree, or
        a marker where none can be.
    DegenerateMotion
        If the markers hardly move relative to each other, or no body has the three markers that a
        root needs.
    """
    settings = settings or DiscoverySettings()
    check_places(recording)
    recording, _ = without_strays(recording, subject_size(recording.markers))  # told by the fit
    limits = skeleton or SkeletonSettings()
    named = recording.labels
    lives = find_lives(recording, settings.ghost_s, limits)
    recording = with_lives_joined(recording, lives)
    worth = worth_grouping(recording.seen, recording.rate, settings.ghost_s)
    columns = np.flatnonzero(worth)
    if len(columns) < 3:
        raise BadRecording(
            f"{len(columns)} of {recording.n_markers} markers are seen for long enough to be "
            "grouped into bodies; at least 3 are needed. What is never around for "
            f"{settings.ghost_s:g} s counts as a reflection (discovery.ghost_s)"
        )
    check_bodies(len(columns), settings.bodies)
    columns = columns[from_the_middle(recording.markers[:, columns])]
    markers = recording.markers[:, columns]
    unit = subject_size(markers) / PERSON
    markers = markers / unit  # from here on the subject is as large as a person
    copies, pieces = find_copies(markers, columns)
    alike, continued = (
        {recording.labels[columns[c]]: recording.labels[columns[k]] for c, k in pairs.items()}
        for pairs in (copies, pieces)
    )
    if twice := [*copies, *pieces]:
        markers = np.delete(with_pieces_joined(markers, pieces), twice, axis=1)
        columns = np.delete(columns, twice)
    continued |= {named[p]: continued.get(named[w], named[w]) for p, w in lives.items()}
    if later := find_continued(markers, recording.rate, columns):
        found_again = {
            recording.labels[columns[p]]: recording.labels[columns[w]] for p, w in later.items()
        }
        continued = {p: found_again.get(w, w) for p, w in continued.items()} | found_again
        markers = np.delete(with_pieces_joined(markers, later), [*later], axis=1)
        columns = np.delete(columns, [*later])
    broken = all_broken(len(continued), recording.seen)
    if broken:
        lasting = ~left_over(is_seen(markers))
        markers, columns = np.ascontiguousarray(markers[:, lasting]), columns[lasting]
    points = np.ascontiguousarray(markers[spread_frames(markers, settings.sample_frames)])
    costs = JointCosts(points, unit)
    trim = trimmed_share(recording.n_frames / recording.rate, settings.ghost_s)
    partition = find_partition(points, settings, limits, costs, trim=trim)
    labels = tuple(recording.labels[c] for c in columns)
    check_tree(len(partition.forest.trees), settings.tree)
    partition, tree, names = named_tree(partition, costs, settings)
    if settings.bodies is None:
        partition, tree, names = without_twigs(partition, tree, names, settings, limits)
    of_tree = [m for body in tree for m in partition.bodies[body]]
    person = names.too_large if names.too_large != 1 else None
    times = person or times_too_large(points[:, of_tree] * unit)
    forest = from_the_root(partition, names.limbs, labels, limits, times)
    tree = next(t for t in forest.trees if tree[0] in t)
    partition = replace(partition, forest=forest)
    rest = Leftover({}, ())
    if broken:
        others = [recording.labels.index(m) for m in (*alike, *continued) if m in recording.labels]
        rest = settle(recording, columns, others, partition.bodies, unit, limits)
    counted = 1.0 if settings.bodies else partition.clustering.count_confidence
    names = shaken(settled(names, tree), forest, counted, rest.trust)
    limb_of = {body: names.limbs[body] for body in tree}
    model = tree_model(partition, costs, limb_of, labels, recording.labels, times)
    riders = {recording.labels[c]: limb_of[b] for c, b in rest.rides.items() if b in limb_of}
    model = with_more(model, riders, recording.labels)
    if continued:
        model = with_pieces(model, continued, named)
    near = settings.near_mm * 1e-3
    ghosts = [
        label
        for column, label in enumerate(recording.labels)
        if recording.seen[:, column].any() and not worth[column] and label not in riders
    ]
    step = Step(
        name="discovery",
        settings=settings_as_json(settings),
        findings=account_of(partition, labels, ghosts, model, names, limb_of, near)
        | {"copies": dict(alike), "pieces": dict(continued), "riders": dict(riders)},
        warnings=told_of_copies(alike)
        + told_of_pieces(continued)
        + rest.told()
        + doubts_about(
            partition,
            labels,
            model,
            names,
            limb_of,
            count_given=settings.bodies is not None,
            faint=_faint(partition, costs, limb_of, model),
        ),
    )
    return Discovery(model, step, person)


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
