"""Bodies of the same shape that are never seen at once: one limb, all of it lost and found."""

from collections.abc import Sequence
from itertools import combinations
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Array, Mask
from kinesphere.geometry.rigid import fit_rigid, into_frame
from kinesphere.skeleton.discovery.joint_costs import Members
from kinesphere.skeleton.discovery.places import POSED, Places

STEADY = 3.0
"""Markers of a body that stray more than so many times as its others do are none of its shape."""
TIGHT, LOOSEST = 2.5, 0.004
"""Distances differ by at most so many times what markers stray, and so much, m at a person's size:
of three markers by chance hardly ever."""
MANY = 9
"""Markers of either body that are compared: those that are seen most."""
SURE = 4
"""So many markers alike need not be the whole of either body."""
CLEARLY = 2.5
"""Where markers are alike in another way, too, that one fits so many times worse at least."""
TOO_MANY = 24
"""Ways to be alike: of what is so regular nothing is told."""


class Match(NamedTuple):
    """Two bodies that may be one, and which of their markers then are."""

    bodies: tuple[int, int]
    pairs: tuple[tuple[int, int], ...]
    """Columns of the first and of the second body."""
    off: float
    """m, rms by which one does not fit on the other."""


def find_congruent(places: Places, bodies: Sequence[Members], seen: Mask) -> list[Match]:
    """Return which bodies are one limb, the surest first.

    They have three markers at least, those of either never seen beside the same of the other. Their
    distances are alike in one way that fits far better than others, and mirrored they are none. A
    body that fits as well on either of two that are seen at once is left alone.

    Parameters
    ----------
    places
        As `measure_places` found them for ``bodies``.
    bodies
    seen : (n_frames, n)
        Frames that are looked at.
    """
    shapes = {b: _shape(places, b, members, seen) for b, members in enumerate(bodies)}
    shown = {b: seen[:, kept].sum(axis=1) >= POSED for b, kept in shapes.items()}
    there = [b for b, members in shapes.items() if len(members) >= POSED]
    found = []
    for a, b in combinations(there, 2):
        match = _match(places, (a, b), shapes[a], shapes[b])
        if match and not any((seen[:, i] & seen[:, j]).any() for i, j in match.pairs if i != j):
            found.append(match)
    found.sort(key=lambda match: (-len(match.pairs), match.off))
    return [match for match in found if not _rivalled(match, found, shown)]


def _shape(places: Places, b: int, members: Members, seen: Mask) -> NDArray[np.intp]:
    steady = places.stray[b, members] <= STEADY * places.usual[b]
    kept = members[steady]
    often = seen[:, kept].sum(axis=0)
    return np.asarray(kept[np.argsort(-often, kind="stable")][:MANY])


def _match(
    places: Places, both: tuple[int, int], first: NDArray[np.intp], second: NDArray[np.intp]
) -> Match | None:
    a, b = both
    tolerance = min(LOOSEST, TIGHT * float(np.hypot(places.usual[a], places.usual[b])))
    at, to = places.at[a, first], places.at[b, second]
    ways = alike(_distances(at), _distances(to), tolerance)
    pairs = len(ways[0]) if ways else 0
    if pairs < POSED or (pairs < SURE and pairs < min(len(first), len(second))):
        return None
    offs = np.array([_off(at, to, way) for way in ways])
    best = int(offs.argmin())
    if not offs[best] <= tolerance or (np.delete(offs, best) < CLEARLY * offs[best]).any():
        return None  # mirrored, or as like in another way
    i, j = np.array(ways[best]).T
    return Match(
        both, tuple(zip(first[i].tolist(), second[j].tolist(), strict=True)), float(offs[best])
    )


def _off(at: Array, to: Array, way: Sequence[tuple[int, int]]) -> float:
    """Return by how much points do not fit on others, m rms; inf where they tell no pose."""
    i, j = np.array(way).T
    fit = fit_rigid(at[i], to[j][None])
    off = into_frame(fit.rotations, fit.shifts, to[j][None])[0] - at[i]
    rms = float(np.sqrt((off**2).sum(axis=1).mean()))
    return rms if np.isfinite(rms) else np.inf


def alike(a: Array, b: Array, tolerance: float) -> list[list[tuple[int, int]]]:
    """Return the most points of two sets that have the same distances, in all ways there are.

    Three at least; nothing otherwise.

    Parameters
    ----------
    a, b : (n, n), (m, m)
        Distances within each.
    tolerance
        By how much two may differ.
    """
    i, j = (x.ravel() for x in np.indices((len(a), len(b))))
    fits = np.abs(a[i[:, None], i] - b[j[:, None], j]) <= tolerance
    fits &= (i[:, None] != i) & (j[:, None] != j)
    best: list[list[int]] = []

    def grow(chosen: list[int], left: list[int]) -> None:
        nonlocal best
        most = len(best[0]) if best else 0
        if not left:
            if len(chosen) > most:
                best = [chosen]
            elif len(chosen) == most:
                best.append(chosen)
            return
        for k, node in enumerate(left):
            most = len(best[0]) if best else 0
            if len(best) > TOO_MANY or len(chosen) + len(left) - k < max(most, POSED):
                return
            grow([*chosen, node], [other for other in left[k + 1 :] if fits[node, other]])

    grow([], list(range(len(i))))
    return [[(int(i[k]), int(j[k])) for k in way] for way in best if len(way) >= POSED]


def _rivalled(match: Match, others: Sequence[Match], shown: dict[int, Mask]) -> bool:
    """Return whether one of both is as like a third, which is seen beside the other."""
    for other in others:
        one = set(match.bodies) & set(other.bodies)
        if len(one) != 1 or len(other.pairs) < len(match.pairs):
            continue
        (mine,), (its,) = set(match.bodies) - one, set(other.bodies) - one
        if (shown[mine] & shown[its]).any():
            return True
    return False


def _distances(points: Array) -> Array:
    return np.asarray(np.linalg.norm(points[:, None] - points, axis=2))
