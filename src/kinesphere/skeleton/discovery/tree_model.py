"""The topological model that a tree of bodies is."""

from collections.abc import Sequence

import numpy as np

from kinesphere.data import JointModel, Landmark, Segment, TopologicalModel
from kinesphere.geometry.rigid import RigidFit
from kinesphere.skeleton.degrees import count_axes
from kinesphere.skeleton.discovery.joint_costs import JointCosts
from kinesphere.skeleton.discovery.partition import Partition
from kinesphere.skeleton.discovery.steadiness import owners
from kinesphere.skeleton.landmarks import STEADY
from kinesphere.skeleton.naming import joint_name
from kinesphere.skeleton.scale import size_share

MODEL = "motion alone"
"""Name of every model found so."""
AT_THE_JOINT = 0.06
"""m, how far a joint's centre may be from a marker over it: half a knee's width with the marker,
and as much again."""
POSED = 3
"""Markers of a limb at an end of the tree from which another's marker that is steady in it is at
their joint: in two it keeps but two distances, and may be anywhere that moves little. Between two
others such a limb has joints at both ends, and the marker aids its pose; doubtful joints do not
count, for the limb may be an end."""


def tree_model(
    partition: Partition,
    costs: JointCosts,
    limb_of: dict[int, str],
    labels: Sequence[str],
    in_file: Sequence[str],
    too_large: float = 1.0,
) -> TopologicalModel:
    """Return the model of one tree; ``limb_of`` has its bodies in order, the root first.

    The recording's lengths are ``too_large`` times what they should be.
    """
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
    edges = [partition.forest.edge(body) for body in list(limb_of)[1:]]
    sure = {body: sum(body in (e.a, e.b) and not e.doubtful for e in edges) for body in limb_of}
    unposed = {b for b in limb_of if len(partition.bodies[b]) < POSED and sure[b] <= 1}
    joints = []
    for number, body in enumerate(list(limb_of)[1:], start=1):
        edge = partition.forest.edge(body)
        parent, child = limb_of[edge.a], limb_of[edge.b]
        over = [m for m, there in visits.items() if {int(owner[m]), there} == {edge.a, edge.b}]
        over = [m for m in over if visits[m] not in unposed]
        landmark = Landmark(
            weights={labels[m]: 1 / max(len(over), 1) for m in over},
            spread=AT_THE_JOINT * too_large * size_share(costs.points * costs.unit / too_large),
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
                doubtful=edge.doubtful,
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


def _axes(parent: RigidFit | None, child: RigidFit | None) -> int | None:
    if parent is None or child is None:
        return None
    return count_axes(np.swapaxes(parent.rotations, 1, 2) @ child.rotations)
