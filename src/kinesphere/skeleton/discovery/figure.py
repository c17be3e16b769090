"""Bodies and joints as points in the world: what proportions and postures are read off."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, TypeAlias

import numpy as np

from kinesphere.data import Array
from kinesphere.geometry.algebraic_centres import score_centre, sphere_centre
from kinesphere.geometry.even_frames import every_nth
from kinesphere.geometry.rigid import RigidFit, into_frame, out_of_frame
from kinesphere.skeleton.averages import mean_seen, median_seen
from kinesphere.skeleton.discovery.joint_costs import JointCosts, Members
from kinesphere.skeleton.topology import robust_deviations

Point: TypeAlias = tuple[Any, ...]
"""A point by what it is: ("joint", a, b), ("far", body, neighbour), ("body", a) or ("amid", point,
point…)."""
RIDGE = 1e-2
"""How firmly a joint is held where its markers are, as a share of the motion: below a tenth of a
radian the motion says less."""


THINNED = 3
"""About every third frame of those joints were found on make a figure: a median needs no more."""


@dataclass(frozen=True, eq=False)
class Figure:
    """Bodies and where they meet, in some frames of the recording."""

    beside: tuple[tuple[int, ...], ...]
    """Of each body, those it meets."""
    middles: Array
    """(n_sample, n_bodies, 3) m, middle of each body's markers that are seen."""
    markers: tuple[Array, ...]
    """Of each body, (n_sample, n_markers, 3) m."""
    joints: Mapping[frozenset[int], Array]
    """Two bodies that meet → (n_sample, 3) m."""
    unit: float = 1.0
    """How many times larger the subject is than the person that all lengths here are of."""
    known: dict[tuple[Point, Point], float] = field(default_factory=dict)
    """Lengths that were asked for: many readings of a tree ask for the same ones."""

    def joint(self, a: int, b: int) -> Array:
        """Return where two bodies meet, (n_sample, 3) m."""
        return self.joints[frozenset((a, b))]

    def chain(self, start: int, towards: int) -> tuple[int, ...]:
        """Return the longest way outward from one body through a neighbour, the latter first."""
        beyond = [other for other in self.beside[towards] if other != start]
        ways = [self.chain(towards, other) for other in beyond]
        # of equal ways the one with more markers: toes before a loose strap
        best = max(ways, key=lambda way: (len(way), sum(self._size(b) for b in way)), default=())
        return (towards, *best)

    def _size(self, body: int) -> int:
        return int(self.markers[body].shape[1])

    def far_end(self, body: int, towards: int) -> Array:
        """Return the marker of a body that is farthest from a joint of it, (n_sample, 3) m."""
        away = np.linalg.norm(self.markers[body] - self.joint(body, towards)[:, None], axis=2)
        usual = median_seen(away)
        return self.markers[body][:, int(np.nan_to_num(usual, nan=-1.0).argmax())]

    def ends(self, root: int, chain: tuple[int, ...]) -> list[Point]:
        """Return the joints along a chain and its far end, len(chain) + 1 points."""
        before = (root, *chain[:-1])
        joints: list[Point] = [("joint", *pair) for pair in zip(before, chain, strict=True)]
        return [*joints, ("far", chain[-1], before[-1])]

    def place(self, point: Point) -> Array:
        """Return where a point is, (n_sample, 3) m."""
        kind, *of = point
        if kind == "amid":
            return np.asarray(np.mean([self.place(p) for p in of], axis=0))
        if kind == "body":
            return self.middles[:, of[0]]
        return self.joint(*of) if kind == "joint" else self.far_end(*of)

    def length(self, a: Point, b: Point) -> float:
        """Return the median distance of two points in m."""
        if (a, b) not in self.known:
            self.known[a, b] = usual_distance(self.place(a), self.place(b))
        return self.known[a, b]


def make_figure(
    costs: JointCosts,
    bodies: Sequence[Members],
    edges: Sequence[tuple[int, int]],
    shared: Mapping[frozenset[int], Sequence[int]],
    places: dict[frozenset[int], Array] | None = None,
) -> Figure:
    """Return the figure that edges make of bodies.

    Parameters
    ----------
    costs
        Knows the markers and the poses.
    bodies
        Columns of each body's markers.
    edges
        Pairs of bodies that meet.
    shared
        Two bodies → columns of the markers at their joint.
    places
        Two bodies → where they meet, as far as it is known from other figures; added to.
    """
    places = {} if places is None else places
    few = every_nth(len(costs.points), THINNED)
    beside: list[list[int]] = [[] for _ in bodies]
    joints = {}
    for a, b in edges:
        beside[a].append(b)
        beside[b].append(a)
        pair = frozenset((a, b))
        if pair not in places:
            over = shared.get(pair, ())
            places[pair] = joint_place(costs, bodies[a], bodies[b], over)[few]
        joints[pair] = places[pair]
    clouds = tuple(costs.points[few][:, members] for members in bodies)
    return Figure(
        beside=tuple(tuple(sorted(others)) for others in beside),
        middles=np.stack([mean_seen(cloud, axis=1) for cloud in clouds], axis=1),
        markers=clouds,
        joints=joints,
        unit=costs.unit,
    )


def joint_place(costs: JointCosts, a: Members, b: Members, over: Sequence[int] = ()) -> Array:
    """Return about where two bodies meet, (n_sample, 3) m; good to centimetres, for proportions.

    Amid the markers over the joint or, where there is none, midway between the nearest ones of both
    bodies, unless the motion says better: by the common point of both poses (SCoRE), or by the
    spheres that one body's markers are on in the other's pose. Where neither has a pose, at the
    marker that is steadiest with the other body: midway between knee and shin is no knee.
    """
    pose_a, pose_b = costs.pose(a), costs.pose(b)
    if pose_a is None and pose_b is not None:
        return joint_place(costs, b, a, over)
    if pose_a is None:
        return mean_seen(costs.points[:, list(over) or [_steadiest(costs.points, a, b)]], axis=1)
    middle = mean_seen(costs.points[:, list(over) or list(_nearest(costs.points, a, b))], axis=1)
    from_a = _seen_by(pose_a, middle)
    if not np.isfinite(from_a).all():
        return middle
    if pose_b is None:
        local = into_frame(pose_a.rotations, pose_a.shifts, costs.points[:, b])
        centre = sphere_centre(local, from_a, ridge=RIDGE)
        return out_of_frame(pose_a.rotations, pose_a.shifts, centre[None])[:, 0]
    from_b = _seen_by(pose_b, middle)
    relative = np.swapaxes(pose_a.rotations, 1, 2) @ pose_b.rotations
    other = out_of_frame(pose_b.rotations, pose_b.shifts, from_b[None])
    shifts = into_frame(pose_a.rotations, pose_a.shifts, other)[:, 0] - from_a
    in_a, in_b, _ = score_centre(relative, shifts, ridge=RIDGE)
    carried = (
        out_of_frame(pose.rotations, pose.shifts, centre[None])
        for pose, centre in ((pose_a, from_a + in_a), (pose_b, from_b + in_b))
    )
    return mean_seen(np.concatenate(list(carried), axis=1), axis=1)


def _seen_by(pose: RigidFit, point: Array) -> Array:
    """Return the usual place of a moving point in a body's frame, (n_sample, 3) m → (3,) m."""
    return median_seen(into_frame(pose.rotations, pose.shifts, point[:, None])[:, 0])


def _nearest(points: Array, a: Members, b: Members) -> tuple[int, int]:
    """Return the two markers of two bodies that are nearest to each other."""
    ways = {(int(i), int(j)): usual_distance(points[:, i], points[:, j]) for i in a for j in b}
    return min(ways, key=lambda pair: (np.nan_to_num(ways[pair], nan=np.inf), pair))


def _steadiest(points: Array, a: Members, b: Members) -> int:
    """Return the marker of two bodies whose distances to the other body wander least."""
    apart = np.linalg.norm(points[:, a, None] - points[:, None, b], axis=3)
    wander = robust_deviations(apart.reshape(len(apart), -1)).reshape(len(a), len(b))
    unsteady = {int(m): float(np.mean(row)) for m, row in zip(a, wander, strict=True)}
    unsteady |= {int(m): float(np.mean(column)) for m, column in zip(b, wander.T, strict=True)}
    return min(unsteady, key=lambda m: (unsteady[m], m))


def usual_distance(a: Array, b: Array) -> float:
    """Return the median distance of two moving points in m, NaN if they are never seen together."""
    return float(median_seen(np.linalg.norm(a - b, axis=-1)))
