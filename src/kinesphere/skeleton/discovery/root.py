"""Which body a tree hangs from: one whose markers tell where it points."""

from collections.abc import Sequence

import numpy as np

from kinesphere.errors import DegenerateMotion
from kinesphere.skeleton.body import measure_shape
from kinesphere.skeleton.discovery.forest import Forest, rerooted
from kinesphere.skeleton.discovery.partition import Partition
from kinesphere.skeleton.discovery.twigs import TORSO
from kinesphere.skeleton.scale import scaled, size_share
from kinesphere.skeleton.settings import SkeletonSettings


def from_the_root(
    partition: Partition,
    limb_of: dict[int, str],
    labels: Sequence[str],
    limits: SkeletonSettings,
    too_large: float = 1.0,
) -> Forest:
    """Return the forest with the tree hanging from its pelvis or, without one, from its trunk.

    From the body nearest to all markers where neither is told or tells where it points. What is too
    near to a line for that when limbs are measured is no root.

    Parameters
    ----------
    partition
    limb_of
        Bodies of the tree → limb.
    labels
        Of the partition's markers.
    limits
        What counts as an outlier and as a line, of a person.
    too_large
        How many times too large lengths are in the recording.

    Raises
    ------
    DegenerateMotion
        If no body tells where it points.
    """
    forest, points = partition.forest, partition.rigidity.points
    unit = partition.unit / too_large
    tree = np.concatenate([partition.bodies[body] for body in limb_of])
    share = size_share(points[:, tree] * unit)  # not of all who are there
    outlier = scaled(limits, share).outlier_mm * 1e-3 / unit
    spread = scaled(limits, share).min_spread_mm * 1e-3 / unit
    torso = [body for limb in TORSO for body, name in limb_of.items() if name == limb]
    for body in dict.fromkeys((*torso, *forest.amid(list(limb_of)))):
        if measure_shape(points[:, partition.bodies[body]], outlier, spread):
            return rerooted(forest, body)
    told = "; ".join(" ".join(labels[m] for m in partition.bodies[body]) for body in limb_of)
    raise DegenerateMotion(
        f"no body has the three markers off a line that a root needs; the bodies are {told}"
    )
