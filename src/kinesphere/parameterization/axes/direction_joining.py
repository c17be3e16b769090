"""Direction Joining: consecutive steps of one direction are joined, then alike groups (4.2)."""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from kinesphere.data import Array
from kinesphere.parameterization.axes.stratify import windowed
from kinesphere.parameterization.samples import JointSamples
from kinesphere.parameterization.settings import AxesSettings

MOST_GROUPS = 400  # the longest groups; raw noise makes thousands of two samples each
SMALLEST_CLUSTER = 0.1  # of all representatives


@dataclass(eq=False)
class Group:
    """Samples oriented along one direction."""

    size: int
    centre: Array
    """(3,)"""
    direction: Array
    """(3,) mean displacement, not normalized: long steps weigh more."""

    @property
    def normal(self) -> Array:
        """(3,) unit normal of the axis plane, spanned by direction, centre and joint."""
        normal = np.cross(self.direction, self.centre)
        return np.asarray(normal / max(float(np.linalg.norm(normal)), 1e-300))


def direction_joining(samples: JointSamples, n_axes: int, settings: AxesSettings) -> Array:
    """Find movement axes as the paper does, from the order of positions.

    What the paper leaves open is read so: steps never cross a gap between phases; the angle
    between axis planes is directed while grouping (a reversal opens a group) and axial while
    clustering (forward and backward strokes are one movement); the most alike clusters join first;
    clusters of less than 10 % of the representatives are dropped. Great circles are assumed: a
    limb at angle φ to its axis biases it by about ``|90° − φ|``.

    Returns
    -------
    (n_found, 3)
    """
    delta = np.deg2rad(settings.joining_angle)
    groups: list[Group] = []
    n_samples = 0
    for start, stop in samples.phases:
        points = windowed(samples.positions[start:stop], np.deg2rad(settings.cell))
        if len(points) >= 2:
            groups += _group(points, np.cos(delta))
            n_samples += len(points)
    clusters = _cluster(groups, np.cos(delta))
    large = [g for g in clusters if g.size >= SMALLEST_CLUSTER * n_samples]
    large.sort(key=lambda g: -g.size)
    return np.array([group.normal for group in large[:n_axes]]).reshape(-1, 3)


def _group(points: Array, cos_delta: float) -> list[Group]:
    groups: list[Group] = []
    for before, after in pairwise(points):
        step, middle = after - before, (before + after) / 2
        fresh = Group(2, middle, step)
        if groups and float(fresh.normal @ groups[-1].normal) >= cos_delta:
            g = groups[-1]
            g.direction = (g.size * g.direction + step) / (g.size + 1)
            g.centre = (g.size * g.centre + after) / (g.size + 1)
            g.size += 1
        else:
            groups.append(fresh)
    return groups


def _cluster(groups: list[Group], cos_delta: float) -> list[Group]:
    """Join the most alike pair until the threshold forbids it (axial: d and −d are one)."""
    clusters = sorted(groups, key=lambda g: -g.size)[:MOST_GROUPS]
    if not clusters:
        return []
    normals = np.array([g.normal for g in clusters])
    alike = np.abs(normals @ normals.T)
    np.fill_diagonal(alike, -1)
    while True:
        i, j = np.unravel_index(int(alike.argmax()), alike.shape)
        if alike[i, j] < cos_delta:
            return clusters
        a, b = clusters[i], clusters[j]
        sign = 1.0 if a.normal @ b.normal >= 0 else -1.0
        total = a.size + b.size
        joined = Group(
            total,
            (a.size * a.centre + b.size * b.centre) / total,
            (a.size * a.direction + b.size * sign * b.direction) / total,
        )
        clusters[i] = joined
        normals[i] = joined.normal
        del clusters[j]
        normals = np.delete(normals, j, axis=0)
        alike = np.delete(np.delete(alike, j, axis=0), j, axis=1)
        k = i if i < j else i - 1
        alike[k] = alike[:, k] = np.abs(normals @ normals[k])
        alike[k, k] = -1
