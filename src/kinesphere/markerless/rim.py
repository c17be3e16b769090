"""What a camera would see of a posed body: parts of the image, and the visible rim."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Array
from kinesphere.kernels.raster import visible_faces_kernel
from kinesphere.markerless.body import Body
from kinesphere.markerless.kernels.contour import (
    NOWHERE,
    parts_kernel,
    project_kernel,
    rim_kernel,
)
from kinesphere.markerless.kernels.jacobian import image_directions_kernel, jacobian_kernel
from kinesphere.markerless.pose import Posed
from kinesphere.markerless.views import View

BEHIND = 0.03
"""m; what is seen beside a rim must be this much farther away, or the rim is a fold."""


@dataclass(frozen=True, eq=False)
class Parts:
    """Which limb each pixel of a view shows."""

    limbs: NDArray[np.int32]
    """(height, width) limb of the chain, NOWHERE for none."""
    nearness: NDArray[np.float32]
    """(height, width) 1/depth in 1/m, 0 where no limb is."""


@dataclass(frozen=True, eq=False)
class Rim:
    """Visible rim points of a body in a view."""

    pairs: NDArray[np.int32]
    """(n, 2) the vertices each point lies between."""
    shares: Array
    """(n,) how far it is from the first to the second."""
    pixels: Array
    """(n, 2) px."""
    normals: Array
    """(n, 2) outward unit normals in the image."""
    parts: NDArray[np.int32]
    """(n, 2) limb inside; limb seen outside, NOWHERE for the background."""


class Canvas:
    """Buffers of one view, used again for every frame."""

    def __init__(self, view: View, body: Body, cell: int) -> None:
        self.view, self.body, self.cell = view, body, cell
        h, w = view.height, view.width
        self._nearness = np.zeros((h, w), dtype=np.float32)
        self._faces = np.full((h, w), NOWHERE, dtype=np.int32)
        self._parts = np.full((h, w), NOWHERE, dtype=np.int32)
        self._box = slice(0, h), slice(0, w)
        self._taken = np.zeros((h // cell + 1, w // cell + 1), dtype=bool)
        most = self._taken.size
        self._rim = (
            np.empty(most, dtype=np.int32),
            np.empty(most),
            np.empty((most, 2)),
            np.empty((most, 2)),
            np.empty((most, 2), dtype=np.int32),
        )
        self._pixels, self._depths = np.empty((len(body.bind), 2)), np.empty(len(body.bind))

    @property
    def drawn(self) -> Parts:
        """What was drawn last."""
        return Parts(self._parts, self._nearness)

    def draw(self, points: Array) -> Parts:
        """Draw the surface, (n_vertices, 3) m in the world; the buffers are this canvas' own."""
        view = self.view
        for buffer, nothing in (
            (self._nearness, 0),
            (self._faces, NOWHERE),
            (self._parts, NOWHERE),
        ):
            buffer[self._box] = nothing
        left, top, right, bottom = project_kernel(
            points, view.rotation, view.shift, view.lens, self._pixels, self._depths
        )
        self._box = _within(top, bottom, view.height), _within(left, right, view.width)
        visible_faces_kernel(
            self._pixels, self._depths, self.body.faces, True, self._nearness, self._faces
        )
        parts_kernel(self._faces[self._box], self.body.part_of_face, self._parts[self._box])
        return self.drawn

    def rim(self, points: Array, normals: Array, parts: Parts) -> Rim:
        """Return the visible rim of a posed surface, by what ``draw`` showed."""
        view, body = self.view, self.body
        edges, shares, pixels, directions, limbs = self._rim
        n = rim_kernel(
            points,
            normals,
            body.edges,
            view.centre,
            view.rotation,
            view.shift,
            view.lens,
            parts.limbs,
            parts.nearness,
            body.limb_of_vertex,
            self.cell,
            BEHIND,
            self._taken,
            edges,
            shares,
            pixels,
            directions,
            limbs,
        )
        return Rim(
            body.edges[edges[:n]],
            shares[:n].copy(),
            pixels[:n].copy(),
            directions[:n].copy(),
            limbs[:n].copy(),
        )


def _within(first: float, last: float, size: int) -> slice:
    """Return the rows or columns of an image from one pixel to another, and one more."""
    if not first <= last:
        return slice(0, 0)
    return slice(int(min(max(first - 1, 0), size)), int(min(max(last + 2, 0), size)))


def derivatives(
    body: Body, at: Posed, pairs: NDArray[np.int32], shares: Array, directions: Array
) -> tuple[Array, Array]:
    """Return surface points in the world and how they move along directions.

    Parameters
    ----------
    pairs, shares : (n, 2), (n,)
        As in `Rim`.
    directions : (n, n_rows, 3)

    Returns
    -------
    points, rows : (n, 3) m, (n, n_rows, n_dofs)
    """
    chain = body.chain
    points = np.empty((len(pairs), 3))
    rows = np.empty((len(pairs), directions.shape[1], chain.n_dofs))
    jacobian_kernel(
        body.bind,
        body.influences,
        body.weights,
        pairs,
        shares,
        chain.centres,
        at.rotations,
        at.centres,
        at.axes,
        chain.dof_limbs,
        chain.dof_kinds,
        chain.moves,
        directions,
        points,
        rows,
    )
    return points, rows


def image_directions(
    view: View, points: Array, pairs: NDArray[np.int32], shares: Array, normals: Array
) -> Array:
    """Return the world directions whose components move pixels along normals, (n, 3) px/m.

    Parameters
    ----------
    points : (n_vertices, 3) m
        The surface in the world.
    pairs, shares : (n, 2), (n,)
        As in `Rim`.
    normals : (n, 2)
        Unit vectors in the image.
    """
    directions = np.empty((len(pairs), 3))
    image_directions_kernel(
        points, pairs, shares, normals, view.rotation, view.shift, view.lens, directions
    )
    return directions
