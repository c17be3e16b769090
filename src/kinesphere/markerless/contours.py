"""The person's outline in a view, and which points of a model's rim it belongs to."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Array
from kinesphere.markerless.kernels.contour import NOWHERE
from kinesphere.markerless.kernels.levelset import contour_kernel
from kinesphere.markerless.kernels.votes import match_kernel
from kinesphere.markerless.levelset import Silhouette
from kinesphere.markerless.rim import Rim
from kinesphere.markerless.views import View

AGREE = 0.5
"""Least cosine between the normals of contour and rim."""
REJECT = 3.0
"""Matches farther apart than so many times the median are left out."""


@dataclass(frozen=True, eq=False)
class Contour:
    """The person's outline in one view."""

    points: Array
    """(n, 2) px."""
    normals: Array
    """(n, 2) outward."""


def contour_of(silhouette: Silhouette, view: View, spacing: int) -> Contour:
    """Return the outline of a silhouette, a point in each cell of ``spacing`` px."""
    h, w = silhouette.phi.shape
    taken = np.zeros((h // spacing + 1, w // spacing + 1), dtype=bool)
    points, normals = np.empty((taken.size, 2)), np.empty((taken.size, 2))
    n = contour_kernel(silhouette.phi, spacing, points, normals, taken)
    points = points[:n] + np.array([silhouette.left, silhouette.top])
    # where the person leaves the image the silhouette ends, but not the person
    inside = ((points > 4) & (points < [view.width - 5, view.height - 5])).all(axis=1)
    return Contour(points[inside], normals[:n][inside])


def matches(contour: Contour, rim: Rim, radius: float) -> tuple[NDArray[np.intp], Array, Array]:
    """Match a contour to the outer rim both ways.

    Inward, each contour point goes to the rim point of the limb it is voted to; outward, each rim
    point to its nearest contour point.

    Returns
    -------
    which, targets, normals : (n,), (n, 2), (n, 2)
        Rim points, and the contour points and normals they belong to.
    """
    outer = np.flatnonzero(rim.parts[:, 1] == NOWHERE)
    limbs = np.ascontiguousarray(rim.parts[outer, 0])
    which, target = match_kernel(
        contour.points,
        contour.normals,
        rim.pixels[outer],
        rim.normals[outer],
        limbs,
        radius,
        AGREE,
        REJECT,
    )
    return outer[which], contour.points[target], contour.normals[target]
