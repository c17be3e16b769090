"""The bundled body as a puppet: pose, proportions and shape from one vector of numbers."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from kinesphere.data import Array, Surface
from kinesphere.geometry.skinning import linear_blend

_UPRIGHT = ("pelvis", "trunk", "head")
_BENDS = {  # degrees, how far each limb is likely to be turned in its parent
    "trunk": 8.0,
    "head": 12.0,
    "upper_arm": 25.0,
    "forearm": 25.0,
    "hand": 15.0,
    "thigh": 12.0,
    "shank": 10.0,
    "foot": 15.0,
}
_LONGER, _THICKER, _SHAPE = 0.15, 0.2, 0.5  # shares and steps that bodies differ by, kept wide


@dataclass(frozen=True, eq=False)
class Puppet:
    """A body that a vector poses: where the root is, how limbs bend, how long and thick they are.

    The vector holds, one after another: ``shift`` (3) m and ``turn`` (3) rad of the root, ``size``
    (1, logarithm), ``bends`` (3 rad for every limb but the root), ``long``, ``deep``, ``wide``
    (logarithms, one for every kind of limb, left and right alike), ``shapes`` (steps).
    """

    body: Surface

    @cached_property
    def kinds(self) -> tuple[str, ...]:
        """The kinds of limbs, sides aside."""
        names = (n.removeprefix("left_").removeprefix("right_") for n in self.body.limbs)
        return tuple(dict.fromkeys(names))

    @cached_property
    def kind_of(self) -> NDArray[np.intp]:
        """(n_limbs,) index into ``kinds``."""
        names = [n.removeprefix("left_").removeprefix("right_") for n in self.body.limbs]
        return np.array([self.kinds.index(name) for name in names])

    @cached_property
    def parts(self) -> dict[str, slice]:
        """Where in the vector each part lies."""
        counts = {
            "shift": 3,
            "turn": 3,
            "size": 1,
            "bends": 3 * (len(self.body.limbs) - 1),
            **dict.fromkeys(("long", "deep", "wide"), len(self.kinds)),
            "shapes": len(self.body.shapes),
        }
        stops = np.cumsum(list(counts.values()))
        return {
            name: slice(int(stop) - count, int(stop))
            for (name, count), stop in zip(counts.items(), stops, strict=True)
        }

    @cached_property
    def spreads(self) -> Array:
        """(n,) how far each number is likely to be from zero; infinite where anything is."""
        bends = [_BENDS[self.kinds[k]] for k in self.kind_of[1:]]
        spread = np.full(self.parts["shapes"].stop, np.inf)
        spread[self.parts["bends"]] = np.repeat(np.radians(bends), 3)
        spread[self.parts["long"]] = _LONGER
        spread[self.parts["deep"]] = spread[self.parts["wide"]] = _THICKER
        spread[self.parts["shapes"]] = _SHAPE
        return spread

    @cached_property
    def _stretch(self) -> Array:
        """(3, n_limbs, 3, 3) what length, depth and width scale: projections that add up to one."""
        along = self.body.ends - self.body.joint_centres
        for limb, k in enumerate(self.kind_of):
            if self.kinds[k] in _UPRIGHT:
                along[limb] = [0.0, 1.0, 0.0]
        along = along / np.linalg.norm(along, axis=1, keepdims=True)
        deep = np.tile([1.0, 0.0, 0.0], (len(along), 1))
        deep -= np.einsum("li,li->l", deep, along)[:, None] * along
        for limb, k in enumerate(self.kind_of):
            if self.kinds[k] == "foot":  # forward is along it: its depth is its height
                deep[limb] = np.cross([0.0, 0.0, 1.0], along[limb])
        deep /= np.linalg.norm(deep, axis=1, keepdims=True)
        axes = np.stack([along, deep, np.cross(along, deep)])
        return np.asarray(axes[..., :, None] * axes[..., None, :])

    def maps(self, vectors: Array) -> tuple[Array, Array, Array]:
        """Return matrices, shifts and joint centres, (n, n_limbs, 3, 3), and twice (n, n_limbs, 3).

        Parameters
        ----------
        vectors : (n, n_numbers)
        """
        body, parts = self.body, self.parts
        n, limbs = len(vectors), len(body.limbs)
        steps = vectors[:, parts["shapes"]]
        centres = body.joint_centres + np.tensordot(steps, body.shape_joint_centres, 1)
        size = np.exp(vectors[:, parts["size"]])[:, :, None, None]
        scale = sum(
            np.exp(vectors[:, parts[name]][:, self.kind_of, None, None]) * self._stretch[k]
            for k, name in enumerate(("long", "deep", "wide"))
        )
        bends = np.concatenate([vectors[:, parts["turn"]], vectors[:, parts["bends"]]], axis=1)
        turns = Rotation.from_rotvec(bends.reshape(-1, 3)).as_matrix().reshape(n, limbs, 3, 3)
        world, places = turns.copy(), np.empty((n, limbs, 3))
        matrices = np.empty((n, limbs, 3, 3))
        for limb, parent in enumerate(body.parents):
            if parent < 0:
                places[:, limb] = centres[:, limb] + vectors[:, parts["shift"]]
            else:
                world[:, limb] = world[:, parent] @ turns[:, limb]
                way = centres[:, limb] - centres[:, parent]
                places[:, limb] = places[:, parent] + (matrices[:, parent] @ way[..., None])[..., 0]
            matrices[:, limb] = world[:, limb] @ (size[:, 0] * scale[:, limb])
        return matrices, places - (matrices @ centres[..., None])[..., 0], places

    def vertices(self, vector: Array, chosen: NDArray[np.intp] | slice = slice(None)) -> Array:
        """Return where (some of) the vertices are, (n_vertices, 3) m."""
        return np.asarray(self._placed(vector[None], vector[self.parts["shapes"]], chosen)[0])

    def slopes(self, vector: Array, chosen: NDArray[np.intp] | slice, step: float = 1e-5) -> Array:
        """Return how vertices move with each number, (n_numbers, n_vertices, 3), by differences."""
        n = len(vector)
        base = self.vertices(vector, chosen)
        moved = vector + step * np.eye(n)
        first = self.parts["shapes"].start
        found = np.empty((n, *base.shape))
        found[:first] = self._placed(moved[:first], vector[self.parts["shapes"]], chosen)
        for k in range(first, n):
            found[k] = self.vertices(moved[k], chosen)
        return np.asarray((found - base) / step)

    def _placed(self, vectors: Array, steps: Array, chosen: NDArray[np.intp] | slice) -> Array:
        body = self.body
        shaped = body.vertices[chosen] + np.tensordot(steps, body.shape_vertices[:, chosen], 1)
        matrices, shifts, _ = self.maps(vectors)
        shares = body.weight_limbs[chosen], body.weight_shares[chosen]
        moved: Array = linear_blend(shaped, *shares, matrices, shifts)
        return moved
