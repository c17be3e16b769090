"""A body: a closed surface on a kinematic chain, posed by linear blend skinning."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Array
from kinesphere.errors import BadModel
from kinesphere.geometry.rotations import rotation_log
from kinesphere.geometry.twists import twist_exp
from kinesphere.markerless.chain import BALL, HINGE, SLIDE, Chain
from kinesphere.markerless.kernels.posing import skin_kernel, vertex_normals_kernel
from kinesphere.markerless.pose import Pose, Posed, posed

INFLUENCES = 4
"""Limbs that move one vertex, at most; the heaviest are kept."""


@dataclass(frozen=True, eq=False)
class Body:
    """A surface in the bind pose: y up, x ahead, z to the right, metres."""

    chain: Chain
    bind: Array
    """(n_vertices, 3) m."""
    faces: NDArray[np.int32]
    """(n_faces, 3) counter-clockwise seen from outside."""
    shares: Array
    """(n_vertices, n_limbs) how much each limb moves a vertex; rows sum to one."""
    ends: Array
    """(n_limbs, 3) m, the far end of each limb in the bind pose."""
    house_limbs: tuple[str, ...]
    """The house's limbs, root first; each is a limb of the chain."""

    def __post_init__(self) -> None:
        put = object.__setattr__
        put(self, "bind", np.ascontiguousarray(self.bind, dtype=np.float64))
        put(self, "faces", np.ascontiguousarray(self.faces, dtype=np.int32))
        n = len(self.bind)
        if self.shares.shape != (n, len(self.chain.links)):
            raise BadModel(
                f"shares must be ({n}, {len(self.chain.links)}): vertices by limbs, "
                f"got {self.shares.shape}"
            )
        if self.faces.size and not (self.faces.min() >= 0 and self.faces.max() < n):
            raise BadModel(f"faces name vertices beyond the {n} there are")
        if not np.allclose(self.shares.sum(axis=1), 1, atol=1e-3):
            raise BadModel("a vertex's shares do not sum to one: every vertex needs a limb")

    @cached_property
    def influences(self) -> NDArray[np.int32]:
        """(n_vertices, INFLUENCES) the limbs that move a vertex most."""
        k = min(INFLUENCES, self.shares.shape[1])
        order = np.argsort(-self.shares, axis=1, kind="stable")[:, :k]
        return np.ascontiguousarray(order, dtype=np.int32)

    @cached_property
    def weights(self) -> Array:
        """(n_vertices, INFLUENCES) their shares, summing to one."""
        kept = np.take_along_axis(self.shares, self.influences.astype(np.intp), axis=1)
        return np.ascontiguousarray(kept / kept.sum(axis=1, keepdims=True))

    @cached_property
    def edges(self) -> NDArray[np.int32]:
        """(n_edges, 2) vertices of each edge, once."""
        pairs = self.faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
        unique = np.unique(np.sort(pairs, axis=1), axis=0)
        return np.ascontiguousarray(unique, dtype=np.int32)

    @cached_property
    def limb_of_vertex(self) -> NDArray[np.int32]:
        """(n_vertices,) the chain's limb that moves it most."""
        return np.ascontiguousarray(self.influences[:, 0])

    @cached_property
    def part_of_face(self) -> NDArray[np.int32]:
        """(n_faces,) the chain's limb a face belongs to."""
        total = self.shares[self.faces].sum(axis=1)
        return np.asarray(total.argmax(axis=1), dtype=np.int32)

    @cached_property
    def house_of_limb(self) -> NDArray[np.int32]:
        """(n_limbs,) index among ``house_limbs`` of each limb of the chain, or of its parents."""
        at = {name: i for i, name in enumerate(self.house_limbs)}
        house = np.zeros(len(self.chain.links), dtype=np.int32)
        for i, link in enumerate(self.chain.links):
            house[i] = at.get(link.name, house[self.chain.parents[i]])
        return house

    @cached_property
    def limb_of_face(self) -> NDArray[np.int32]:
        """(n_faces,) which of ``house_limbs`` a face belongs to."""
        return np.asarray(self.house_of_limb[self.part_of_face], dtype=np.int32)

    @cached_property
    def parameter_names(self) -> tuple[str, ...]:
        """Name of every pose parameter: shifts in m, the rest in rad."""
        count: dict[str, int] = {}
        names = []
        words = {SLIDE: "shift", BALL: "turn", HINGE: "angle"}
        for limb, kind in zip(self.chain.dof_limbs, self.chain.dof_kinds, strict=True):
            stem = f"{self.chain.limb_names[limb]}.{words[kind]}"
            count[stem] = count.get(stem, 0) + 1
            names.append(f"{stem}{count[stem]}")
        return tuple(names)

    def parameters(self, pose: Pose) -> Array:
        """Return a pose as numbers, (n_dofs,): balls as rotation vectors."""
        kinds, limbs = self.chain.dof_kinds, self.chain.dof_limbs
        values = pose.angles.copy()
        values[kinds == SLIDE] = pose.position
        values[kinds == BALL] = rotation_log(pose.balls[limbs[kinds == BALL][::3]]).ravel()
        return values

    def pose(self, parameters: Array) -> Pose:
        """Return the pose of such numbers."""
        kinds, limbs = self.chain.dof_kinds, self.chain.dof_limbs
        balls = np.tile(np.eye(3), (len(self.chain.links), 1, 1))
        turns = parameters[kinds == BALL].reshape(-1, 3)
        balls[limbs[kinds == BALL][::3]] = twist_exp(np.pad(turns, ((0, 0), (3, 0))))[:, :3, :3]
        angles = np.where(kinds == HINGE, parameters, 0.0)
        return Pose(parameters[kinds == SLIDE].copy(), balls, angles)

    def vertices(self, parameters: Array) -> Array:
        """Return the surface in the world, (n_dofs,) → (n_vertices, 3) m."""
        return self.skinned(posed(self.chain, self.pose(parameters)))

    def skinned(self, at: Posed) -> Array:
        """Return the surface of a pose worked out, (n_vertices, 3) m."""
        points = np.empty_like(self.bind)
        skin_kernel(
            self.bind,
            self.influences,
            self.weights,
            self.chain.centres,
            at.rotations,
            at.centres,
            points,
        )
        return points

    def normals(self, points: Array) -> Array:
        """Return outward normals of the vertices, not of unit length, (n_vertices, 3)."""
        normals = np.empty_like(points)
        vertex_normals_kernel(points, self.faces, normals)
        return normals
