"""A body's surface: triangles that ride on limbs."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from kinesphere.data.arrays import Array, frozen
from kinesphere.data.history import History
from kinesphere.errors import BadSurface

MESH = "mesh"
"""What a surface that nobody gave limbs rides on as a whole."""
_ADDS_UP = 1e-6  # weights of a vertex are shares; float32 files leave about 1e-7


@dataclass(frozen=True, eq=False)
class Surface:
    """Triangles, the limbs they ride on, and where those limbs meet while nothing is bent.

    In metres, y up. The bundled body stands on y = 0 and looks along x, its right side at z > 0;
    a surface bound to a skeleton lies as that skeleton's default position does.
    """

    vertices: Array
    """(n_vertices, 3) m, at rest."""
    faces: NDArray[np.intp]
    """(n_faces, 3) vertices of each triangle, counter-clockwise seen from outside."""
    limbs: tuple[str, ...]
    """Names of the limbs, parents first."""
    parents: NDArray[np.intp]
    """(n_limbs,) index of each limb's parent; −1 for the root, which comes first."""
    joint_centres: Array
    """(n_limbs, 3) m, where each limb hangs from its parent; of the root, its own middle."""
    ends: Array
    """(n_limbs, 3) m, the far end of each limb: the next joint, finger tips, toes, crown."""
    weights: Array
    """(n_vertices, n_limbs) share of each limb in each vertex; at most four are not zero."""
    shapes: tuple[str, ...] = ()
    """Names of the directions in which the shape can change, ``height`` among them."""
    shape_vertices: Array = field(default_factory=lambda: np.zeros((0, 0, 3)))
    """(n_shapes, n_vertices, 3) m, what one step along each adds to the vertices."""
    shape_joint_centres: Array = field(default_factory=lambda: np.zeros((0, 0, 3)))
    """(n_shapes, n_limbs, 3) m, the same of the joint centres."""
    shape_ends: Array = field(default_factory=lambda: np.zeros((0, 0, 3)))
    """(n_shapes, n_limbs, 3) m, the same of the ends."""
    history: History = ()

    def __post_init__(self) -> None:
        n_limbs, n_shapes, n_vertices = len(self.limbs), len(self.shapes), len(self.vertices)
        if not self.shapes:
            for name, count in (
                ("vertices", n_vertices),
                ("joint_centres", n_limbs),
                ("ends", n_limbs),
            ):
                object.__setattr__(self, f"shape_{name}", np.zeros((0, count, 3)))
        for name, *shape in (
            ("vertices", None, 3),
            ("joint_centres", n_limbs, 3),
            ("ends", n_limbs, 3),
            ("weights", n_vertices, n_limbs),
            ("shape_vertices", n_shapes, n_vertices, 3),
            ("shape_joint_centres", n_shapes, n_limbs, 3),
            ("shape_ends", n_shapes, n_limbs, 3),
        ):
            array = frozen(getattr(self, name), *shape, name=name)
            if np.isnan(array).any():
                raise BadSurface(f"{name} holds NaN; a surface has no gaps")
            object.__setattr__(self, name, array)
        object.__setattr__(self, "faces", _indices(self.faces, (None, 3), "faces"))
        object.__setattr__(self, "parents", _indices(self.parents, (n_limbs,), "parents"))
        self._check()

    def _check(self) -> None:
        if len(set(self.limbs)) != len(self.limbs) or not self.limbs:
            raise BadSurface("a surface needs limbs, each of a name of its own")
        if len(self.faces) and not (self.faces.min() >= 0 and self.faces.max() < self.n_vertices):
            raise BadSurface(
                f"a face names vertex {self.faces.max()}; there are {self.n_vertices}, from 0"
            )
        late = self.parents >= np.arange(len(self.limbs))
        if self.parents[0] != -1 or (self.parents[1:] < 0).any() or late.any():
            raise BadSurface("the first limb must be the root, every other come after its parent")
        total = self.weights.sum(axis=1)
        off = np.abs(total - 1)
        if (self.weights < 0).any() or (off > _ADDS_UP).any():
            raise BadSurface(
                "weights must not be negative and add up to 1 for every vertex; vertex "
                f"{np.argmax(off)} has {total[np.argmax(off)]:.3g}"
            )
        if (busiest := int((self.weights > 0).sum(axis=1).max(initial=0))) > 4:
            raise BadSurface(f"a vertex rides on {busiest} limbs; 4 are possible")

    @classmethod
    def without_limbs(
        cls, vertices: ArrayLike, faces: ArrayLike, history: History = ()
    ) -> "Surface":
        """Return a mesh as it comes: in any unit and axes, all of it on one limb, ``mesh``."""
        points = np.array(vertices, dtype=np.float64)
        middle = points.mean(axis=0, keepdims=True) if len(points) else np.zeros((1, 3))
        return cls(
            vertices=points,
            faces=np.asarray(faces),
            limbs=(MESH,),
            parents=np.array([-1]),
            joint_centres=middle,
            ends=middle,
            weights=np.ones((len(points), 1)),
            history=history,
        )

    @property
    def has_limbs(self) -> bool:
        """Whether it is known which limb carries what."""
        return self.limbs != (MESH,)

    @property
    def n_vertices(self) -> int:
        """Number of vertices."""
        return len(self.vertices)

    @cached_property
    def weight_limbs(self) -> NDArray[np.intp]:
        """(n_vertices, 4) the limbs each vertex rides on, heaviest first; 0 beyond the last."""
        order = np.argsort(-self.weights, axis=1, kind="stable")[:, :4]
        order = np.pad(order, ((0, 0), (0, 4 - order.shape[1])))
        order[self.weight_shares == 0] = 0
        return order

    @cached_property
    def weight_shares(self) -> Array:
        """(n_vertices, 4) the share of each of ``weight_limbs``."""
        share = -np.sort(-self.weights, axis=1)[:, :4]
        return np.ascontiguousarray(np.pad(share, ((0, 0), (0, 4 - share.shape[1]))))

    def normals(self, vertices: ArrayLike | None = None) -> Array:
        """Return outward unit normals, (..., n_vertices, 3), of these vertices or those at rest."""
        given = np.asarray(self.vertices if vertices is None else vertices, dtype=np.float64)
        points = np.moveaxis(given, -2, 0)
        a, b, c = points[self.faces.T]
        across = np.cross(b - a, c - a)  # as long as twice the area: large triangles count more
        summed = np.zeros_like(points)
        for corner in self.faces.T:
            np.add.at(summed, corner, across)
        length = np.linalg.norm(summed, axis=-1, keepdims=True)
        return np.moveaxis(summed / np.where(length > 0, length, 1.0), 0, -2)

    def shaped(self, steps: Mapping[str, float]) -> "Surface":
        """Return the surface so many steps along the named directions of shape.

        Raises
        ------
        BadSurface
            If there is no direction of that name.
        """
        if unknown := sorted(set(steps) - set(self.shapes)):
            known = ", ".join(self.shapes) or "none"
            raise BadSurface(f"no shape is called {', '.join(unknown)}; there are {known}")
        step = np.array([steps.get(name, 0.0) for name in self.shapes])
        return replace(
            self,
            vertices=self.vertices + np.tensordot(step, self.shape_vertices, 1),
            joint_centres=self.joint_centres + np.tensordot(step, self.shape_joint_centres, 1),
            ends=self.ends + np.tensordot(step, self.shape_ends, 1),
        )


def _indices(values: ArrayLike, shape: tuple[int | None, ...], name: str) -> NDArray[np.intp]:
    array = np.array(values, dtype=np.intp)
    fits = array.ndim == len(shape) and all(
        w is None or w == f for w, f in zip(shape, array.shape, strict=True)
    )
    if not fits:
        raise BadSurface(f"{name} have shape {array.shape}, {shape} is needed")
    array.flags.writeable = False
    return array
