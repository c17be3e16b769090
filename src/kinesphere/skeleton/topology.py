"""Which limbs meet at a joint, found from how they move: a minimum spanning tree of joint costs.

In the spirit of Hornung, Sar-Dessai, Kobbelt (IEEE VR 2005) and of Kirk, O'Brien, Forsyth (CVPR
2005), whose spanning tree it takes; the cost of a pair is the best of what can be had for it.
"""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from kinesphere.data import Array
from kinesphere.geometry.algebraic_centres import score_centre, sphere_centre
from kinesphere.geometry.rigid import RigidFit, into_frame
from kinesphere.skeleton.body import measure_shape

NEARNESS = 0.01
"""Cost in m of each metre between a joint and the nearest markers: limbs meet where they are."""
OUTLIER = 0.003
"""m, residual at which a sighting within its limb starts to be doubted."""
MIN_SPREAD = 0.005
"""m, least extent of a limb's markers beside a line for the limb to have an orientation."""


def limb_poses(clouds: Mapping[str, Array]) -> dict[str, RigidFit]:
    """Return the poses of the limbs that have one of their own.

    Parameters
    ----------
    clouds
        Limb → (n_frames, n_markers, 3) m.
    """
    poses = {}
    for limb, points in clouds.items():
        if points.shape[1] > 2 and (measured := measure_shape(points, OUTLIER, MIN_SPREAD)):
            poses[limb] = measured[2]
    return poses


def joint_cost(a: Array, b: Array, pose_a: RigidFit | None, pose_b: RigidFit | None) -> float:
    """Return how badly two limbs look like neighbours, in m; infinite if never seen together.

    Unsteadiness and a share of the way of `joint_view`.

    Parameters
    ----------
    a, b : (n_frames, n_markers, 3) m
    pose_a, pose_b
        Poses of the limbs; None for a limb with too few markers.
    """
    return joint_view(a, b, pose_a, pose_b).cost


class JointView(NamedTuple):
    """How two limbs look as neighbours."""

    unsteady: float
    """m, how far apart the joint's two images are in each direction; infinite if unknown."""
    way: float
    """m, from marker to marker by the joint."""

    @property
    def cost(self) -> float:
        """How badly they look so, m."""
        return self.unsteady + NEARNESS * self.way


UNSEEN = JointView(np.inf, 0.0)
"""Of limbs that are never seen together."""


def joint_view(a: Array, b: Array, pose_a: RigidFit | None, pose_b: RigidFit | None) -> JointView:
    """Return how two limbs look as neighbours.

    The better of two views: how far apart the joint's two images are in each direction (SCoRE where
    both limbs have poses, spheres about a common centre where one has), and how steady one marker's
    distances to the other limb are (an acromion near an upper arm). Both grow with the way from
    marker to marker by the joint.

    Parameters
    ----------
    a, b : (n_frames, n_markers, 3) m
    pose_a, pose_b
        Poses of the limbs; None for a limb with too few markers.
    """
    centre = _centre_view(a, b, pose_a, pose_b)
    if pose_a is not None and pose_b is not None:
        return centre
    views = (centre, _distance_view(a, b), _distance_view(b, a))
    return min(views, key=lambda view: view.cost)


def _centre_view(a: Array, b: Array, pose_a: RigidFit | None, pose_b: RigidFit | None) -> JointView:
    if pose_a is None:
        return UNSEEN if pose_b is None else _centre_view(b, a, pose_b, None)
    by_a = into_frame(pose_a.rotations, pose_a.shifts, b)
    if pose_b is None:
        known = by_a[np.isfinite(by_a).all(axis=2)]
        if len(known) == 0:
            return UNSEEN
        centre = sphere_centre(by_a, np.median(known, axis=0), ridge=1e-2)
        off = robust_deviations(np.linalg.norm(by_a - centre, axis=2))
        own = into_frame(pose_a.rotations, pose_a.shifts, a)
        far = _nearest(own, centre) + _nearest(by_a, centre)
        return JointView(float(np.sqrt(np.mean(off**2))), far)
    relative = np.swapaxes(pose_a.rotations, 1, 2) @ pose_b.rotations
    shifts = into_frame(pose_a.rotations, pose_a.shifts, pose_b.shifts[:, None])[:, 0]
    in_a, in_b, rms = score_centre(relative, shifts)
    if not np.isfinite(rms):
        return UNSEEN
    own_a = into_frame(pose_a.rotations, pose_a.shifts, a)
    own_b = into_frame(pose_b.rotations, pose_b.shifts, b)
    return JointView(rms / 3**0.5, _nearest(own_a, in_a) + _nearest(own_b, in_b))


def _nearest(points: Array, centre: Array) -> float:
    """Return the median distance from a point to the nearest marker, m."""
    distance = np.linalg.norm(points - centre, axis=2)
    usual = [np.median(d[np.isfinite(d)]) for d in distance.T if np.isfinite(d).any()]
    return float(min(usual, default=np.inf))


def _distance_view(a: Array, b: Array) -> JointView:
    """Return how unsteady and long the distances to ``b`` are, for the best marker of ``a``."""
    best = UNSEEN
    for m in range(a.shape[1]):
        distance = np.linalg.norm(b - a[:, m : m + 1], axis=2)
        if not np.isfinite(distance).any(axis=0).all():
            continue
        usual = min(float(np.median(d[np.isfinite(d)])) for d in distance.T)
        view = JointView(float(robust_deviations(distance).mean()), usual)
        best = min(best, view, key=lambda view: view.cost)
    return best


def robust_deviations(distances: Array) -> Array:
    """Return the standard deviation of each column, its outer tenth left out, (n, m) m → (m,) m."""
    out = np.zeros(distances.shape[1])
    for i, column in enumerate(distances.T):
        d = np.sort(column[np.isfinite(column)])
        cut = len(d) // 20
        out[i] = np.std(d[cut : len(d) - cut]) if len(d) > 2 else 0.0
    return out


def spanning_tree(
    names: tuple[str, ...], costs: Mapping[tuple[str, str], float]
) -> list[tuple[str, str]]:
    """Return the edges of the minimum spanning tree (Kruskal 1956), cheapest first.

    Ties go by the order of ``names``. Pairs of infinite cost stay apart.
    """
    group = {name: name for name in names}

    def top(name: str) -> str:
        while group[name] != name:
            name = group[name]
        return name

    at = {name: i for i, name in enumerate(names)}
    ordered = sorted(costs, key=lambda pair: (costs[pair], at[pair[0]], at[pair[1]]))
    edges = []
    for a, b in ordered:
        if np.isfinite(costs[a, b]) and top(a) != top(b):
            group[top(a)] = top(b)
            edges.append((a, b))
    return edges
