"""Everything about bodies that motion tells before any limb is measured."""

from dataclasses import dataclass, replace

import numpy as np

from kinesphere.data import Array
from kinesphere.skeleton.discovery.belonging import Belonging, measure_belonging
from kinesphere.skeleton.discovery.chains import split_chains
from kinesphere.skeleton.discovery.clustering import METHODS, Clustering
from kinesphere.skeleton.discovery.exchange import to_the_steadiest
from kinesphere.skeleton.discovery.forest import Forest, contracted
from kinesphere.skeleton.discovery.joint_costs import JointCosts, Members
from kinesphere.skeleton.discovery.joint_tree import find_forest
from kinesphere.skeleton.discovery.loners import resettle
from kinesphere.skeleton.discovery.rigidity import MOST_TRIMMED, Rigidity, measure_rigidity
from kinesphere.skeleton.discovery.settings import DiscoverySettings
from kinesphere.skeleton.discovery.steadiness import usual_wander
from kinesphere.skeleton.settings import SkeletonSettings


@dataclass(frozen=True, eq=False)
class Partition:
    """Markers in bodies, bodies in trees. Markers are columns of the points it was found from.

    Lengths are at a person's size: those of the subject over ``unit``.
    """

    rigidity: Rigidity
    clustering: Clustering
    bodies: tuple[Members, ...]
    loose: tuple[int, ...]
    """Markers that belong to no body."""
    forest: Forest
    belonging: Belonging
    usual: float
    """m, median wander of a distance within a body."""
    shared: tuple[int, ...]
    """Markers at joints: nearly as steady in a neighbouring body as in their own."""
    unit: float = 1.0
    """How many times larger the subject is than the person that all lengths here are of."""

    @property
    def sizes(self) -> list[int]:
        """How many markers each body has."""
        return [len(members) for members in self.bodies]

    @property
    def confidence(self) -> Array:
        """(n,) 0…1 that a marker belongs to its body rather than to the next; 0 for loose ones."""
        known: Array = self.belonging.confidence(self.usual)
        known[list(self.loose)] = 0.0
        return known


def find_partition(
    points: Array,
    settings: DiscoverySettings,
    limits: SkeletonSettings,
    costs: JointCosts,
    *,
    trim: float = MOST_TRIMMED,
) -> Partition:
    """Group markers into bodies and join the bodies.

    Parameters
    ----------
    points : (n_sample, n, 3) m
        Markers worth grouping, in frames spread over the motion, at a person's size.
    settings
    limits
        What counts as an outlier and as a line, of a person.
    costs
        Of joints between these markers; filled on the way.
    trim
        Share of the frames left out of distances at either end.

    Raises
    ------
    BadRecording, DegenerateMotion
        As `kinesphere.skeleton.discovery.rigidity.measure_rigidity` does.
    """
    rigidity = measure_rigidity(points, costs.unit, trim=trim)
    clustering = _clustered(rigidity, settings)
    bodies = members_of(clustering.labels)
    loose: list[int] = []
    if settings.bodies is None:
        usual = usual_wander(rigidity.wander, bodies) or rigidity.noise
        labels = split_chains(clustering.labels, rigidity.wander, usual, settings.split_ratio)
        bodies, loose = resettle(
            rigidity, members_of(labels), costs, settings.shared_ratio, settings.split_ratio
        )
        bodies = to_the_steadiest(rigidity, bodies)
    forest = find_forest(costs, bodies)
    belonging = measure_belonging(
        rigidity, bodies, forest, limits.outlier_mm * 1e-3, limits.min_spread_mm * 1e-3
    )
    usual = usual_wander(rigidity.wander, bodies) or rigidity.noise
    return Partition(
        rigidity=rigidity,
        clustering=clustering,
        bodies=tuple(bodies),
        loose=tuple(loose),
        forest=forest,
        belonging=belonging,
        usual=usual,
        shared=tuple(map(int, belonging.shared(usual, settings.shared_ratio))),
        unit=costs.unit,
    )


def merged(
    partition: Partition,
    into: int,
    body: int,
    settings: DiscoverySettings,
    limits: SkeletonSettings,
) -> Partition:
    """Return the partition with a body's markers on its neighbour; the body is left empty."""
    bodies = list(partition.bodies)
    bodies[into] = np.sort(np.concatenate([bodies[into], bodies[body]]))
    bodies[body] = bodies[body][:0]
    sizes = tuple(len(members) for members in bodies)
    forest = contracted(partition.forest, into, body, sizes)
    rigidity = partition.rigidity
    usual = usual_wander(rigidity.wander, bodies) or rigidity.noise
    belonging = measure_belonging(
        rigidity, bodies, forest, limits.outlier_mm * 1e-3, limits.min_spread_mm * 1e-3
    )
    return replace(
        partition,
        bodies=tuple(bodies),
        forest=forest,
        belonging=belonging,
        usual=usual,
        shared=tuple(map(int, belonging.shared(usual, settings.shared_ratio))),
    )


def members_of(labels: Members) -> list[Members]:
    """Return the markers of each body, bodies in the order of their numbers."""
    return [np.flatnonzero(labels == body) for body in range(int(labels.max()) + 1)]


def _clustered(rigidity: Rigidity, settings: DiscoverySettings) -> Clustering:
    n = len(rigidity.mean)
    if settings.bodies is None and rigidity.is_one_body:
        return Clustering(np.zeros(n, dtype=np.intp), {1: 1.0})
    unlikeness = rigidity.unlikeness(settings.near_mm * 1e-3)
    return METHODS[settings.method](unlikeness, settings.bodies)
