"""Kinematic chains: which limb hangs where, and about which axes it may turn."""

from dataclasses import dataclass
from functools import cached_property
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Array, Mask
from kinesphere.errors import BadModel

SLIDE, BALL, HINGE = 0, 1, 2
"""Kinds of a degree of freedom: the root's shift, one of three turns of a ball, one axis."""


@dataclass(frozen=True, eq=False)
class Link:
    """A limb and the joint that carries it, in the pose the surface was made in (bind pose).

    The axes of every limb's frame are the world's there, so every vector below may be read in the
    parent's frame or in the limb's own.
    """

    name: str
    parent: str | None
    centre: Array
    """(3,) m, the joint's centre; of the root any point."""
    kind: Literal["free", "ball", "axes"]
    axes: Array
    """(n, 3) unit vectors, the parent's first; of a ball and of the root (0, 3)."""
    low: Array
    """(n,) rad, the least angles, counted from the bind pose."""
    high: Array
    """(n,) rad."""
    long_axis: Array
    """(3,) unit vector along the limb; a ball's twist is about it."""
    towards: Array
    """(3,) unit vector, the middle of where a ball lets the long axis point."""
    swing: float = np.pi
    """rad, how far from ``towards`` it may point."""
    twist: float = np.pi
    """rad, how far a ball may twist to either side."""
    stiffness: float = 1.0
    """rad, how far the joint usually is from its rest."""


@dataclass(frozen=True, eq=False)
class Chain:
    """Limbs in an order where parents come first; the first is the root."""

    links: tuple[Link, ...]

    def __post_init__(self) -> None:
        known: set[str] = set()
        for i, link in enumerate(self.links):
            if (link.parent is None) != (i == 0) or (link.kind == "free") != (i == 0):
                raise BadModel(f"limb {link.name}: the first limb, and no other, is the root")
            if i and link.parent not in known:
                raise BadModel(f"limb {link.name} comes before its parent {link.parent}")
            known.add(link.name)

    @cached_property
    def limb_names(self) -> tuple[str, ...]:
        """Names of the limbs, root first."""
        return tuple(link.name for link in self.links)

    @cached_property
    def parents(self) -> NDArray[np.intp]:
        """(n_limbs,) index of each limb's parent; −1 for the root."""
        at = {name: i for i, name in enumerate(self.limb_names)}
        return np.array([-1 if k.parent is None else at[k.parent] for k in self.links])

    @cached_property
    def centres(self) -> Array:
        """(n_limbs, 3) m, joint centres in the bind pose."""
        return np.array([link.centre for link in self.links])

    @cached_property
    def dof_limbs(self) -> NDArray[np.intp]:
        """(n_dofs,) the limb that each degree of freedom turns."""
        count = {"free": 6, "ball": 3}
        each = [count.get(link.kind, len(link.axes)) for link in self.links]
        return np.repeat(np.arange(len(self.links)), each)

    @cached_property
    def dof_kinds(self) -> NDArray[np.intp]:
        """(n_dofs,) SLIDE, BALL or HINGE."""
        kinds = {"free": [SLIDE] * 3 + [BALL] * 3, "ball": [BALL] * 3}
        each = [kinds.get(link.kind, [HINGE] * len(link.axes)) for link in self.links]
        return np.array([k for kinds_of_limb in each for k in kinds_of_limb], dtype=np.intp)

    @cached_property
    def slides(self) -> Mask:
        """(n_dofs,) which degrees of freedom are the root's shifts."""
        return np.asarray(self.dof_kinds == SLIDE)

    @cached_property
    def turns(self) -> Mask:
        """(n_dofs,) which belong to balls."""
        return np.asarray(self.dof_kinds == BALL)

    @cached_property
    def hinges(self) -> Mask:
        """(n_dofs,) which are hinges."""
        return np.asarray(self.dof_kinds == HINGE)

    @cached_property
    def turned(self) -> NDArray[np.intp]:
        """(n_balls,) the limbs that hang on balls, the root among them."""
        return np.ascontiguousarray(self.dof_limbs[self.turns][::3])

    @cached_property
    def cones(self) -> tuple[Array, Array, Array, Array]:
        """Limits of balls by limb: long axes, middles, (n_limbs, 3); swings, twists, (n_limbs,)."""
        links = self.links
        return (
            np.array([link.long_axis for link in links], dtype=np.float64),
            np.array([link.towards for link in links], dtype=np.float64),
            np.array([link.swing for link in links], dtype=np.float64),
            np.array([link.twist for link in links], dtype=np.float64),
        )

    @cached_property
    def limited(self) -> NDArray[np.intp]:
        """The limbs on balls that have limits."""
        return np.array(
            [
                i
                for i, link in enumerate(self.links)
                if link.kind == "ball" and (link.swing < np.pi or link.twist < np.pi)
            ],
            dtype=np.intp,
        )

    @cached_property
    def dof_axes(self) -> Array:
        """(n_dofs, 3) unit vectors, in the parent's frame in the bind pose."""
        eye = np.eye(3)
        stacks = {"free": np.concatenate([eye, eye]), "ball": eye}
        return np.concatenate([stacks.get(link.kind, link.axes) for link in self.links])

    @cached_property
    def limits(self) -> tuple[Array, Array]:
        """Least and greatest angle of every degree of freedom, (n_dofs,) rad; infinite if none."""
        low, high = np.full(self.n_dofs, -np.inf), np.full(self.n_dofs, np.inf)
        jointed = [link for link in self.links if link.kind == "axes"]
        if jointed:
            low[self.hinges] = np.concatenate([link.low for link in jointed])
            high[self.hinges] = np.concatenate([link.high for link in jointed])
        return low, high

    @cached_property
    def moves(self) -> NDArray[np.bool_]:
        """(n_dofs, n_limbs) whether the degree of freedom moves the limb."""
        carries = np.eye(len(self.links), dtype=bool)
        for limb, parent in enumerate(self.parents):
            if parent >= 0:
                carries[:, limb] |= carries[:, parent]
        return carries[self.dof_limbs]

    @property
    def n_dofs(self) -> int:
        """Number of degrees of freedom."""
        return len(self.dof_limbs)
