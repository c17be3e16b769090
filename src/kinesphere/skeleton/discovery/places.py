"""Pieces of markers told by their place on a body: whatever is lost between, it is the same."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Array, Mask
from kinesphere.geometry.pose_errors import mean_pose_covariance, point_covariance
from kinesphere.geometry.rigid import into_frame
from kinesphere.geometry.vectors import is_seen
from kinesphere.skeleton.averages import median_seen
from kinesphere.skeleton.body import measure_shape, robust_rms
from kinesphere.skeleton.discovery.joint_costs import Members
from kinesphere.skeleton.settings import SkeletonSettings

POSED = 3
"""Markers that a pose is told by."""
SHOWN = 12
"""Looks, a second of them, in which a piece must be seen beside a body's pose."""
RIGID = 2.0
"""A piece rides on a body where it strays at most so many times as much as is due to noise."""
CLEARLY = 0.6
"""And at most so much of what it does in any other body."""
ALIKE = 0.006
"""m, at a person's size: places nearer than that are one marker's. No two markers at hand are
nearer to each other than 0.007 m."""
ALONE = 3.0
"""What could be meant else must be so many times farther."""


class Places(NamedTuple):
    """Where every piece is in every body that tells a pose."""

    at: Array
    """(n_bodies, n, 3) m in the body's frame; NaN where too little is seen."""
    stray: Array
    """(n_bodies, n) m, how far it strays from there; infinite where too little is seen."""
    usual: Array
    """(n_bodies,) m, median of what a body's own markers do; NaN without a pose."""
    due: Array
    """(n_bodies, n) m, what noise makes a marker there stray: the pose shakes the more, the farther
    it is from the body's own."""


def measure_places(points: Array, bodies: Sequence[Members], limits: SkeletonSettings) -> Places:
    """Return where all that is seen is in each body.

    Parameters
    ----------
    points : (n_sample, n, 3) m
        At a person's size; NaN where not seen.
    bodies
        Columns of each; those of fewer than three tell no pose.
    limits
        What counts as an outlier and as a line.
    """
    n, known = points.shape[1], is_seen(points)
    at, stray = np.full((len(bodies), n, 3), np.nan), np.full((len(bodies), n), np.inf)
    usual, due = np.full(len(bodies), np.nan), np.full((len(bodies), n), np.nan)
    for b, members in enumerate(bodies):
        shows = np.flatnonzero(known[:, members].sum(axis=1) >= POSED)
        if len(members) < POSED or len(shows) < SHOWN:
            continue
        seen = points[shows]
        measured = measure_shape(
            seen[:, members], limits.outlier_mm * 1e-3, limits.min_spread_mm * 1e-3
        )
        if measured is None:
            continue
        shape, noise, pose = measured
        posed = np.isfinite(pose.shifts).all(axis=1)
        often = known[shows][posed].sum(axis=0) >= SHOWN
        local = into_frame(pose.rotations[posed], pose.shifts[posed], seen[posed][:, often])
        at[b, often] = median_seen(local)
        stray[b, often] = robust_rms(np.linalg.norm(local - at[b, often], axis=2))
        own = stray[b, members]
        usual[b] = np.median(own[np.isfinite(own)]) if np.isfinite(own).any() else np.nan
        size = float(np.sqrt(np.mean(noise**2)))
        shaky = mean_pose_covariance(
            shape, np.full(len(shape), size), np.isfinite(seen[posed][:, members, 0])
        )
        shakes = point_covariance(shaky, at[b, often]).trace(axis1=1, axis2=2) / 3
        due[b, often] = np.sqrt(shakes + size**2)
    return Places(at, stray, usual, due)


def riding(places: Places) -> NDArray[np.intp]:
    """Return which body each piece rides on, (n,); −1 for none."""
    n_bodies, n = places.stray.shape
    if not n_bodies:
        return np.full(n, -1)
    best = places.stray.argmin(axis=0)
    least = places.stray[best, np.arange(n)]
    others = places.stray.copy()
    others[best, np.arange(n)] = np.inf
    rides = np.isfinite(least) & (least <= RIGID * places.due[best, np.arange(n)])
    rides &= least <= CLEARLY * others.min(axis=0)
    return np.asarray(np.where(rides, best, -1))


def same_places(places: Places, on: NDArray[np.intp], seen: Mask) -> list[list[int]]:
    """Return groups of pieces that are one marker: at one place of one body, never at once.

    Parameters
    ----------
    places
    on : (n,)
        The body of each piece; −1 for none.
    seen : (n_frames, n)
    """
    often = seen.sum(axis=0)
    together = seen.T.astype(np.float32) @ seen.astype(np.float32) > 0
    groups: list[list[int]] = []
    for b in np.unique(on[on >= 0]):
        members = np.flatnonzero((on == b) & np.isfinite(places.stray[b]))
        members = members[np.argsort(-often[members], kind="stable")]
        found: list[list[int]] = []
        for m in members.tolist():
            away = [float(np.linalg.norm(places.at[b, m] - places.at[b, g[0]])) for g in found]
            order = np.argsort(away)
            if not len(order) or away[order[0]] > ALIKE:
                found.append([m])
                continue
            near = found[order[0]]
            doubtful = len(order) > 1 and away[order[1]] < ALONE * away[order[0]]
            if doubtful or together[m, near].any():
                found.append([m])
            else:
                near.append(m)
        groups += [g for g in found if len(g) > 1]
    return groups
