"""Markers at joints, which are steady in two bodies; and bodies that are one marker."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from kinesphere.data import Array
from kinesphere.geometry.rigid import into_frame
from kinesphere.skeleton.body import measure_shape, robust_rms
from kinesphere.skeleton.discovery.forest import Forest
from kinesphere.skeleton.discovery.joint_costs import JointCosts, Members
from kinesphere.skeleton.discovery.joint_tree import find_forest
from kinesphere.skeleton.discovery.rigidity import Rigidity

FRAMES = 300
"""Frames that a marker's wandering in a body is judged on."""
SIGNIFICANT = 3.0
"""Standard errors by which two deviations must differ to count as different."""
OWN_POSE = 3
"""Markers from which on a body has a pose of its own."""


def owners(bodies: Sequence[Members], n: int) -> Members:
    """Return the body of each of ``n`` markers, −1 for none."""
    owner = np.full(n, -1)
    for b, members in enumerate(bodies):
        owner[members] = b
    return owner


def steadiness(wander: Array, bodies: Sequence[Members]) -> Array:
    """Return the rms wander of each marker's distances to each body, (n, n_bodies) m.

    The marker itself left out; NaN for a loner's own body.
    """
    square = wander**2 + np.diag(np.full(len(wander), np.nan))
    steady = np.full((len(wander), len(bodies)), np.nan)
    for b, members in enumerate(bodies):
        to_members = square[:, members]
        known = np.isfinite(to_members)
        count = known.sum(axis=1)
        total = np.where(known, to_members, 0.0).sum(axis=1)
        steady[:, b] = np.sqrt(np.where(count > 0, total / np.maximum(count, 1), np.nan))
    return steady


def usual_wander(wander: Array, bodies: Sequence[Members]) -> float:
    """Return the median wander of a distance within a body, m; 0 where no body has two markers."""
    inner = [wander[np.ix_(b, b)][np.triu_indices(len(b), 1)] for b in bodies]
    known = np.concatenate([*inner, np.empty(0)])
    known = known[np.isfinite(known)]
    return float(np.median(known)) if len(known) else 0.0


def resettle(
    rigidity: Rigidity,
    bodies: Sequence[Members],
    costs: JointCosts,
    ratio: float,
    chain_ratio: float,
) -> tuple[list[Members], list[int]]:
    """Find each body of one marker company, or let it fall out.

    A single marker between two joints (a shin's) takes the marker of the farther joint from the
    limb beyond, if it is steady with that and not with the rest there: markers over knee, elbow and
    ankle sit on the bone above. Any other joins the neighbour whose markers it is steady with all
    in all, or is loose.

    Returns
    -------
    bodies
    loose
        Markers that belong to none.
    """
    kept = _without_strays(rigidity, bodies, chain_ratio)
    loose: list[int] = []
    for _ in range(2 * len(rigidity.mean)):
        alone = [b for b, members in enumerate(kept) if len(members) == 1]
        if not alone:
            break
        usual = usual_wander(rigidity.wander, kept) or rigidity.noise
        forest = find_forest(costs, kept)
        moves = [
            move
            for b in alone
            if (move := _linked(b, kept, forest, rigidity.wander, usual, chain_ratio))
            or (move := _joined(b, kept, forest, rigidity.wander, usual, ratio))
        ]
        if moves:
            _, marker, source, target = min(moves)
            kept[source] = kept[source][kept[source] != marker]
            kept[target] = np.sort(np.append(kept[target], marker))
        else:  # the least steady one first: it may have been in the way of others
            steady = steadiness(rigidity.wander, kept)
            out = max(alone, key=lambda b: _least(steady[kept[b][0]]))
            loose.append(int(kept[out][0]))
            kept[out] = kept[out][:0]
        kept = [members for members in kept if len(members)]
    return kept, sorted(loose)


def to_the_steadiest(rigidity: Rigidity, bodies: Sequence[Members]) -> list[Members]:
    """Let markers near a joint go where they are steadiest, among bodies rigid to the noise.

    Where nothing but noise moves a body's markers against each other, noise tells which of two
    bodies a marker rides on, though nearness did not: it is as steady there as the body's own
    markers are, and not at home. Where skin moves them that says nothing, so a body counts only
    if it is no less steady than the recording's steadiest distances.
    """
    wander, kept = rigidity.wander, [members.copy() for members in bodies]
    same = 1 + SIGNIFICANT / np.sqrt(2 * len(rigidity.points))
    for _ in range(len(kept)):
        steady = steadiness(wander, kept)
        inner = np.array([_rms(steady[members, b]) for b, members in enumerate(kept)])
        moves = [
            (steady[m, target] / steady[m, home], int(m), home, target)
            for home, members in enumerate(kept)
            if len(members) > OWN_POSE
            for m in members
            for target in range(len(kept))
            if target != home
            and len(kept[target]) >= OWN_POSE
            and inner[target] < same * rigidity.noise
            and steady[m, target] < same * inner[target]
            and steady[m, target] * same < steady[m, home]
        ]
        if not moves:
            break
        _, m, home, target = min(moves)
        kept[home] = kept[home][kept[home] != m]
        kept[target] = np.sort(np.append(kept[target], m))
    return kept


_Move = tuple[float, int, int, int]
"""(wander in m, marker, from body, to body)"""


def _without_strays(
    rigidity: Rigidity, bodies: Sequence[Members], chain_ratio: float
) -> list[Members]:
    """Make bodies of their own of markers that are far from steady with all of a steady body."""
    usual = usual_wander(rigidity.wander, bodies) or rigidity.noise
    kept: list[Members] = []
    for members in bodies:
        body = members
        while len(body) > 2:
            inner = rigidity.wander[np.ix_(body, body)] + np.diag(np.full(len(body), np.nan))
            reach = np.array([_least(row) for row in inner])
            worst = int(reach.argmax())
            rest = np.delete(np.delete(inner, worst, 0), worst, 1)
            rest = rest[np.isfinite(rest)]
            if reach[worst] <= chain_ratio * max(usual, float(rest.max(initial=0.0))):
                break
            kept.append(body[worst : worst + 1])
            body = np.delete(body, worst)
        kept.append(body)
    return sorted(kept, key=lambda body: int(body[0]))


def _linked(
    b: int,
    bodies: Sequence[Members],
    forest: Forest,
    wander: Array,
    usual: float,
    chain_ratio: float,
) -> _Move | None:
    """Return the marker that a loner between two joints takes from the limb beyond."""
    (m,) = (int(marker) for marker in bodies[b])
    if forest.parent(b) is None:
        return None
    takes = []
    for child in forest.children(b):
        there = wander[m, bodies[child]]
        known = there[np.isfinite(there)]
        if len(known) > 1 and known.max() > chain_ratio * max(usual, float(known.min())):
            takes.append((float(known.min()), int(bodies[child][np.nanargmin(there)]), child, b))
    return min(takes, default=None)


def _joined(
    b: int, bodies: Sequence[Members], forest: Forest, wander: Array, usual: float, ratio: float
) -> _Move | None:
    """Return the neighbour that a loner is steady with, as steady as its markers are."""
    (m,) = (int(marker) for marker in bodies[b])
    steady = steadiness(wander, bodies)
    joins = []
    for other in forest.neighbours(b):
        inner = steady[bodies[other], other]
        inner = inner[np.isfinite(inner)]
        own = float(np.sqrt(np.mean(inner**2))) if len(inner) else 0.0
        if steady[m, other] < ratio * max(usual, own):
            joins.append((float(steady[m, other]), m, b, other))
    return min(joins, default=None)


def _rms(values: Array) -> float:
    known = values[np.isfinite(values)]
    return float(np.sqrt(np.mean(known**2))) if len(known) else np.inf


def _least(values: Array) -> float:
    known = values[np.isfinite(values)]
    return float(known.min()) if len(known) else np.inf


@dataclass(frozen=True, eq=False)
class Belonging:
    """How much markers wander in their own body and in those it meets."""

    own: Array
    """(n,) m, rms wander of a marker's distances to the others of its body; NaN for a loner."""
    next: Array
    """(n,) m, the least it wanders in a neighbouring body: of its distances, and of its place seen
    from that body's frame where it has one; infinite without neighbours."""
    neighbour: Members
    """(n,) which body that is; −1 for none."""

    def shared(self, noise: float, ratio: float) -> Members:
        """Return the markers at joints: steady next door to ``ratio`` times what they are here."""
        home = np.hypot(np.nan_to_num(self.own), noise)
        return np.flatnonzero((self.neighbour >= 0) & (np.hypot(self.next, noise) < ratio * home))

    def confidence(self, noise: float) -> Array:
        """Return (n,) 0…1: 1 where another body is out of the question, ½ where it fits as well."""
        home, there = np.hypot(np.nan_to_num(self.own), noise), np.hypot(self.next, noise)
        with np.errstate(invalid="ignore"):
            share = there**2 / (there**2 + home**2)
        return np.where(np.isfinite(there), share, 1.0)


def measure_belonging(
    rigidity: Rigidity,
    bodies: Sequence[Members],
    forest: Forest,
    outlier: float,
    min_spread: float,
) -> Belonging:
    """Return how much every marker wanders at home and next door.

    Parameters
    ----------
    outlier, min_spread
        m, as `kinesphere.geometry.rigid.fit_shape` takes them.
    """
    n = len(rigidity.mean)
    owner, steady = owners(bodies, n), steadiness(rigidity.wander, bodies)
    own = np.where(owner >= 0, steady[np.arange(n), owner], np.nan)
    least, neighbour = np.full(n, np.inf), np.full(n, -1)
    count = min(FRAMES, len(rigidity.points))
    points = rigidity.points[np.unique(np.linspace(0, len(rigidity.points) - 1, count).astype(int))]
    for b, members in enumerate(bodies):
        near = forest.neighbours(b)
        if not near:
            continue
        visitors = np.concatenate([bodies[other] for other in near])
        wanders = steady[visitors, b]
        if len(members) >= OWN_POSE and (
            measured := measure_shape(points[:, members], outlier, min_spread)
        ):
            pose = measured[2]
            local = into_frame(pose.rotations, pose.shifts, points[:, visitors])
            wanders = np.fmax(wanders, _straying(local))
        nearer = wanders < least[visitors]
        least[visitors[nearer]], neighbour[visitors[nearer]] = wanders[nearer], b
    return Belonging(own, least, neighbour)


def _straying(local: Array) -> Array:
    """Return how far points stray from their usual places, (n_frames, n, 3) m → (n,) m.

    As the distance between two points that stray alike would wander.
    """
    strays = np.zeros(local.shape[1])
    for i, place in enumerate(np.moveaxis(local, 1, 0)):
        known = place[np.isfinite(place).all(axis=1)]
        if len(known):
            off = np.linalg.norm(known - np.median(known, axis=0), axis=1)
            strays[i] = np.sqrt(2) * robust_rms(off[:, None])[0]
    return strays
