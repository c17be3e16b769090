"""What was found beside a person's torso and is no limb: the torso's own."""

import numpy as np

from kinesphere.skeleton.discovery.chains import widest
from kinesphere.skeleton.discovery.names import Names, renumbered
from kinesphere.skeleton.discovery.partition import Partition, merged
from kinesphere.skeleton.discovery.settings import DiscoverySettings
from kinesphere.skeleton.settings import SkeletonSettings

SURELY = 1.5
"""Times the ratio from which a body falls in two up to which what is no limb is the torso's: a
person has none there. Pieces of trunks had 0.4 to 1.03 of that ratio, heads 2.5."""
TORSO = ("pelvis", "trunk")
"""What a person's tree hangs from, the first that is there."""


def without_twigs(
    partition: Partition,
    tree: tuple[int, ...],
    names: Names,
    settings: DiscoverySettings,
    limits: SkeletonSettings,
) -> tuple[Partition, tuple[int, ...], Names]:
    """Give a person's torso back what was found beside it: a shoulder blade's two markers.

    A body that is no limb, and together with trunk or pelvis is not clearly less steady than the
    two are by themselves; arms that hung from it hang from there. Numbers of limbs without a name
    close up, and doubts speak of those that are there.

    Parameters
    ----------
    tree
        The bodies of the tree that is named.
    names
        As they were found for it.

    Returns
    -------
    Partition, tuple, Names
        With the body left empty, and out of the tree.
    """
    wander, kept = partition.rigidity.wander, tree
    for body in tree:
        near = [b for b in partition.forest.neighbours(body) if names.limbs[b] in TORSO]
        if not near or body in names.unnamed or not names.limbs[body].startswith("limb_"):
            continue
        parent = near[0]
        torso = partition.bodies[parent]
        steady = max(partition.usual, widest(wander, torso), widest(wander, partition.bodies[body]))
        both = np.concatenate([torso, partition.bodies[body]])
        if widest(wander, both) <= SURELY * settings.split_ratio * steady:
            partition = merged(partition, parent, body, settings, limits)
            kept = tuple(other for other in kept if other != body)
    return partition, kept, renumbered(names, kept)
