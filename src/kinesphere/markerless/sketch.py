"""Silhouettes so small that thousands of poses can be held against them."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import cv2
import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Array
from kinesphere.kernels.raster import silhouette_kernel
from kinesphere.markerless.body import Body
from kinesphere.markerless.evidence import MOST
from kinesphere.markerless.kernels.contour import project_kernel
from kinesphere.markerless.kernels.sketch import Values, worth_kernel
from kinesphere.markerless.pose import Pose, posed
from kinesphere.markerless.views import View, view_of

_SIDE = 200
"""px, the longer side."""
_STRAIN = 5.0
"""nats that a joint costs whose distance from rest is usual for it: about two pixels."""
_COARSE = 0.045
"""m, about the edges of the triangles drawn there."""


def coarsened(body: Body, side: float = _COARSE) -> Body:
    """Return a body of fewer triangles: vertices of one limb in one cube of ``side`` m are one.

    The vertex nearest to their mean stays, so that the surface hardly shrinks.
    """
    cubes = np.floor(body.bind / side).astype(np.int64)
    keys = np.column_stack([body.limb_of_vertex, cubes])
    _, of_vertex = np.unique(keys, axis=0, return_inverse=True)
    of_vertex = of_vertex.ravel()
    n = int(of_vertex.max()) + 1
    means = np.zeros((n, 3))
    np.add.at(means, of_vertex, body.bind)
    means /= np.bincount(of_vertex)[:, None]
    order = np.argsort(np.linalg.norm(body.bind - means[of_vertex], axis=1), kind="stable")
    kept = np.empty(n, dtype=np.int64)
    kept[of_vertex[order[::-1]]] = order[::-1]
    faces = of_vertex[body.faces].astype(np.int32)
    a, b, c = faces.T
    faces = faces[(a != b) & (b != c) & (c != a)]
    return replace(body, bind=body.bind[kept], faces=faces, shares=body.shares[kept])


@dataclass(frozen=True, eq=False)
class Sketch:
    """A body before small silhouettes of one instant."""

    body: Body
    """Of few triangles."""
    views: tuple[View, ...]
    values: tuple[Values, ...]
    """(height, width) nats by which each pixel is likelier the person's than the background's."""

    def with_body(self, body: Body) -> "Sketch":
        """Return another body before the same silhouettes."""
        return replace(self, body=coarsened(body))

    def worth(self, pose: Pose) -> float:
        """Return how much a pose explains, nats: what it covers of the person less of the rest.

        Less a little for joints far from rest: it decides where silhouettes do not.
        """
        points = self.body.skinned(posed(self.body.chain, pose))
        return -self.strain(pose) + sum(
            worth_kernel(_drawn(view, points, self.body.faces), values)
            for view, values in zip(self.views, self.values, strict=True)
        )

    @cached_property
    def _stiffness(self) -> tuple[NDArray[np.intp], Array, Array]:
        """Return the balls but the root, their stiffness, and that of every degree of freedom."""
        links, chain = self.body.chain.links, self.body.chain
        balls = np.array([i for i, link in enumerate(links) if link.kind == "ball"], dtype=np.intp)
        of_dofs = np.array([links[i].stiffness for i in chain.dof_limbs])
        return balls, np.array([links[i].stiffness for i in balls]), of_dofs

    def strain(self, pose: Pose) -> float:
        """Return what a pose's distance from rest costs, nats."""
        balls, of_balls, of_dofs = self._stiffness
        cosine = (np.trace(pose.balls[balls], axis1=1, axis2=2) - 1) / 2
        turned = np.arccos(np.clip(cosine, -1, 1)) / of_balls
        bent = pose.angles / of_dofs
        return float(_STRAIN * (turned @ turned + bent @ bent))

    def worth_beside(self, pose: Pose, limbs: Sequence[int]) -> Callable[[Pose], float]:
        """Return what tells the worth of poses that differ from one in some limbs alone.

        All that does not hang from these limbs is drawn once.
        """
        chain = self.body.chain
        moving = np.zeros(len(chain.links), dtype=bool)
        for limb, parent in enumerate(chain.parents):
            moving[limb] = limb in limbs or (parent >= 0 and moving[parent])
        on = moving[self.body.part_of_face]
        faces, fixed = self.body.faces[on], self.body.faces[~on]
        points = self.body.skinned(posed(chain, pose))
        base, left = 0.0, []
        for view, values in zip(self.views, self.values, strict=True):
            drawn = _drawn(view, points, fixed)
            base += worth_kernel(drawn, values)
            left.append(np.where(drawn, np.float32(0), values))

        def worth(other: Pose) -> float:
            skin = self.body.skinned(posed(chain, other))
            return (
                base
                - self.strain(other)
                + sum(
                    worth_kernel(_drawn(view, skin, faces), values)
                    for view, values in zip(self.views, left, strict=True)
                )
            )

        return worth


def sketch_of(
    body: Body, views: Sequence[View], masks: Sequence[NDArray[np.uint8] | None], side: int = _SIDE
) -> Sketch:
    """Return a body before silhouettes, 0 to 255 at the views' sizes; None where there is none."""
    small, values = [], []
    for view, mask in zip(views, masks, strict=True):
        if mask is None:
            continue
        less = view_of(view.camera, min(side, max(view.width, view.height)))
        resized = cv2.resize(mask, (less.width, less.height), interpolation=cv2.INTER_AREA)
        p = 0.02 + 0.96 * resized.astype(np.float32) / 255
        small.append(less)
        values.append(np.clip(np.log(p / (1 - p)), -MOST, MOST).astype(np.float32))
    return Sketch(coarsened(body), tuple(small), tuple(values))


def _drawn(view: View, points: Array, faces: NDArray[np.int32]) -> NDArray[np.bool_]:
    pixels, depths = np.empty((len(points), 2)), np.empty(len(points))
    project_kernel(points, view.rotation, view.shift, view.lens, pixels, depths)
    drawn = np.zeros((view.height, view.width), dtype=bool)
    silhouette_kernel(pixels, faces, True, drawn)
    return drawn
