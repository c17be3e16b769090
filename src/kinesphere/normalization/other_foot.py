"""The line of a foot that lacks markers which the other foot has: as that one's, mirrored."""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from kinesphere.data import Array
from kinesphere.data.label_sides import mirror_pairs
from kinesphere.normalization.anatomy import Anatomy

_MIRROR = np.diag([1.0, 1.0, -1.0])  # of the body frame, left onto right
_ALIKE = 0.2
"""lengths of the foot: an error of markers (5 mm) beside how unlike two feet stand (10°)."""
_MISFIT = 0.2
"""lengths of the foot, rms, from which on labels that look alike are not of mirrored markers: it is
0.02 to 0.17 of real feet."""


@dataclass(frozen=True, eq=False)
class LentLine:
    """Where a foot points by the other one."""

    points: Array
    """(3,) unit vector in the body frame."""
    missing: tuple[str, ...]
    """Markers of the other foot that this one has none like."""
    open_end: bool
    """Whether one of them is the hindmost or the foremost, between which the line runs."""


def lent_line(
    anatomy: Anatomy, limb: int, pose: Array, other: int, other_pose: Array
) -> LentLine | None:
    """Return where a foot points by the other one, and what it lacks.

    The other foot, mirrored in the body's median plane, is turned about the ankle onto the markers
    that both have, by labels that differ in their side alone. What these leave open, a turn about
    the line from the ankle to the only one above all, is as in the other foot: the least turn
    (Tikhonov's term in the orthogonal Procrustes problem).

    Parameters
    ----------
    anatomy
    limb
        The foot's index.
    pose : (3, 3)
        Its mean ``body_from_limb`` in the default position.
    other, other_pose
        The same of the other foot.

    Returns
    -------
    LentLine or None
        None where they have no markers in common, or not all that this one has, or none is missing;
        and where the markers do not lie as their mirror images do, or are but numbered, which does
        not tell where on a foot one is.
    """
    own, theirs = (_from_ankle(anatomy, i, at) for i, at in ((limb, pose), (other, other_pose)))
    pairs = mirror_pairs((*own, *theirs))
    partner = {a: b for pair in pairs for a, b in (pair, pair[::-1]) if a in own and b in theirs}
    missing = tuple(label for label in theirs if label not in partner.values())
    if not own or len(partner) < len(own) or not missing or _numbered(theirs):
        return None
    goal = np.array([own[label] for label in partner])
    mirrored = np.array([theirs[label] for label in partner.values()]) @ _MIRROR
    length = float(np.linalg.norm(anatomy.distal_ends[other] - anatomy.proximal_ends[other]))
    points = _MIRROR @ other_pose @ anatomy.directions[other]
    if not np.isfinite([length, *points]).all():
        return None
    u, _, vt = np.linalg.svd(goal.T @ mirrored + (_ALIKE * length) ** 2 * np.eye(3))
    turn = u @ np.diag([1.0, 1.0, np.linalg.det(u @ vt)]) @ vt
    off = np.sqrt(np.square(goal - mirrored @ turn.T).sum(axis=1).mean())
    if off > _MISFIT * length:
        return None
    along = other_pose @ anatomy.directions[other]
    ahead = {label: float(place @ along) for label, place in theirs.items()}
    ends = {min(ahead, key=ahead.__getitem__), max(ahead, key=ahead.__getitem__)}
    return LentLine(turn @ points, missing, open_end=not ends.isdisjoint(missing))


def _numbered(labels: Iterable[str]) -> bool:
    """Return whether labels differ by a number alone, as those of a cluster do."""
    parts = [(label.rstrip("0123456789"), label) for label in labels]
    return len({stem for stem, _ in parts}) == 1 and all(stem != label for stem, label in parts)


def _from_ankle(anatomy: Anatomy, limb: int, pose: Array) -> dict[str, Array]:
    """Return where a foot's markers are from its ankle, label → (3,) m in the body frame."""
    foot = anatomy.skeleton.limbs[limb]
    places = (foot.marker_positions - anatomy.proximal_ends[limb]) @ pose.T
    return {
        label: place
        for label, place in zip(foot.markers, places, strict=True)
        if np.isfinite(place).all()
    }
