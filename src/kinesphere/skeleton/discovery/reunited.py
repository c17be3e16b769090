"""Trajectories of limbs all of whose markers were lost: joined by what their bodies are like."""

import numpy as np

from kinesphere.data import Array, Mask
from kinesphere.errors import BadRecording, DegenerateMotion
from kinesphere.geometry.even_frames import even_frames
from kinesphere.skeleton.discovery.breaks import STATISTICS
from kinesphere.skeleton.discovery.chains import split_chains
from kinesphere.skeleton.discovery.clustering import spectral
from kinesphere.skeleton.discovery.congruent import find_congruent
from kinesphere.skeleton.discovery.joint_costs import Members
from kinesphere.skeleton.discovery.places import SHOWN, measure_places, riding, same_places
from kinesphere.skeleton.discovery.rigidity import measure_rigidity
from kinesphere.skeleton.discovery.settings import DiscoverySettings
from kinesphere.skeleton.discovery.steadiness import usual_wander
from kinesphere.skeleton.settings import SkeletonSettings

ROUNDS = 6
"""At most; after each, bodies are seen for longer and know more."""
LOOKS = 3000
"""Frames that are looked at, at most."""


def reunite(
    tracks: list[list[int]], markers: Array, rate: float, limits: SkeletonSettings
) -> list[list[int]]:
    """Return tracks of one marker each, joined where bodies say that they are one.

    Where all of a limb is lost for a while no distance goes on. What moves together before and
    after is a body each, and one is the other again if its markers have the same places.

    Parameters
    ----------
    tracks, markers : (n_frames, n, 3) m
        As `follow` returns them, at a person's size.
    rate
        Hz.
    limits
    """
    looks = min(LOOKS, max(2, round(len(markers) / rate * STATISTICS)))
    points = np.ascontiguousarray(markers[even_frames(len(markers), looks)])
    for _ in range(ROUNDS):
        joined = _one_marker(points, limits)
        if not joined:
            break
        gone = [m for group in joined for m in group[1:]]
        tracks = [list(track) for track in tracks]
        for whole, *rest in joined:
            for m in rest:
                tracks[whole] += tracks[m]
                points[:, whole] = np.where(
                    np.isnan(points[:, whole]), points[:, m], points[:, whole]
                )
        kept = np.setdiff1d(np.arange(len(tracks)), gone)
        tracks, points = [tracks[m] for m in kept], np.ascontiguousarray(points[:, kept])
    return tracks


def _one_marker(points: Array, limits: SkeletonSettings) -> list[list[int]]:
    """Return groups of columns that are one marker, the one seen most first."""
    seen: Mask = np.asarray(np.isfinite(points).all(axis=2))
    try:
        bodies = _rigid(points)
    except (BadRecording, DegenerateMotion):
        return []
    places = measure_places(points, bodies, limits)
    same = same_places(places, riding(places), seen)
    links = [(group[0], m) for group in same for m in group[1:]]
    bodies = [part for body in bodies for part in _seen_together(body, seen)]
    places = measure_places(points, bodies, limits)
    links += [pair for match in find_congruent(places, bodies, seen) for pair in match.pairs]
    groups = {m: [m] for m in range(points.shape[1])}
    shown = {m: seen[:, m] for m in groups}
    for a, b in links:
        if groups[a] is groups[b] or (shown[a] & shown[b]).any():
            continue
        both, either = groups[a] + groups[b], shown[a] | shown[b]
        groups |= dict.fromkeys(both, both)
        shown |= dict.fromkeys(both, either)
    often = seen.sum(axis=0)
    distinct = {id(group): group for group in groups.values() if len(group) > 1}
    return [sorted(group, key=lambda m: (-often[m], m)) for group in distinct.values()]


def _rigid(points: Array) -> list[Members]:
    """Return what is rigid while it is seen: a limb may be several bodies, one after the other."""
    rigidity = measure_rigidity(points)
    settings = DiscoverySettings()
    labels = spectral(rigidity.unlikeness(settings.near_mm * 1e-3), None).labels
    bodies = [np.flatnonzero(labels == body) for body in np.unique(labels)]
    usual = usual_wander(rigidity.wander, bodies) or rigidity.noise
    labels = split_chains(labels, rigidity.wander, usual, settings.split_ratio)
    return [np.flatnonzero(labels == body) for body in np.unique(labels)]


def _seen_together(body: Members, seen: Mask) -> list[Members]:
    """Return parts of a body each two of whose markers are seen together; some are in several."""
    few = seen[:, body].astype(np.float32)
    together = few.T @ few >= SHOWN
    order = np.argsort(-few.sum(axis=0), kind="stable")
    left, parts = list(order), []
    while left:
        kept = [left[0]]
        for m in order:
            if m != left[0] and together[m, kept].all():
                kept.append(m)
        parts.append(np.sort(body[kept]))
        left = [m for m in left if m not in kept]
    return parts
