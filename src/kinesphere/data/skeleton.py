"""The skeleton measured from the motion: limbs, joints, tree."""

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Literal, TypeAlias

import numpy as np

from kinesphere.data.arrays import Array, frozen
from kinesphere.data.history import History
from kinesphere.errors import BadModel

Observability: TypeAlias = Literal["determined", "hinge", "undetermined", "given"]
"""How well motion alone fixes a joint centre: in all directions, in all but one, not at all."""

AxesSource: TypeAlias = Literal["movement", "body", "given", "reused"]
"""Where a joint's axes come from: its own main movements, the body frame for want of them, the
user, or another recording of the same person."""


@dataclass(frozen=True, eq=False)
class Limb:
    """A rigid limb with its own coordinate system."""

    name: str
    parent: str | None
    markers: tuple[str, ...]
    marker_positions: Array
    """(n_markers, 3) m in the limb frame, in the order of ``markers``."""
    length: float
    """m, from the joint towards the parent to the far end; NaN where unknown."""
    long_axis: Array
    """(3,) unit vector in the limb frame, from the proximal to the distal end."""

    def __post_init__(self) -> None:
        put = object.__setattr__
        n = len(self.markers)
        put(
            self,
            "marker_positions",
            frozen(self.marker_positions, n, 3, name=f"{self.name} markers"),
        )
        put(self, "long_axis", frozen(self.long_axis, 3, name=f"{self.name} long axis"))


@dataclass(frozen=True, eq=False)
class Joint:
    """Where a child limb hangs from its parent, and how it moves there.

    A pose of the child is ``parent_from_child = R(axes[1], a2) @ R(axes[0], a1) @
    R(rest @ long_axis, twist) @ rest`` with all axes fixed in the parent: ``axes[1]`` is proximal,
    ``axes[0]`` distal at rest (paper section 4.4). Three axes read ``R(axes[2], a3) @ …``.
    """

    name: str
    parent: str
    child: str
    centre_in_parent: Array
    """(3,) m."""
    centre_in_child: Array
    """(3,) m."""
    residual: float
    """m, rms over time of the distance between the centre seen from parent and from child; NaN
    where no pose of the child is its markers' alone, so that nothing can come apart."""
    range_of_motion: float
    """rad, largest angle between two relative orientations (5–95 % of them)."""
    covariance: Array
    """(3, 3) m² of the centre in the parent frame; NaN where unknown."""
    observability: Observability
    axes: Array | None = None
    """(n_axes, 3) unit vectors in the parent frame; None before parameterization."""
    rest: Array | None = None
    """(3, 3) ``parent_from_child`` where all angles are zero; None before parameterization."""
    axes_source: AxesSource | None = None
    axes_assumed: tuple[bool, ...] = ()
    """For each axis whether it was put across those from ``axes_source``, near the body frame's,
    because nothing told it; empty where none was."""
    axes_reused_from: tuple[str, ...] = ()
    """For each axis the recording it was taken from; empty for an axis that is this recording's
    own or put across, and where none is from another."""
    axes_uncertainty: Array | None = None
    """(n_axes,) rad, standard deviation of each axis' direction; NaN where unknown."""
    note: str = ""
    """What a person should know: ``range of motion 8°, centre undetermined``."""

    def __post_init__(self) -> None:
        put = object.__setattr__
        put(self, "centre_in_parent", frozen(self.centre_in_parent, 3, name=f"{self.name} centre"))
        put(self, "centre_in_child", frozen(self.centre_in_child, 3, name=f"{self.name} centre"))
        put(self, "covariance", frozen(self.covariance, 3, 3, name=f"{self.name} covariance"))
        if self.axes is not None:
            put(self, "axes", frozen(self.axes, None, 3, name=f"{self.name} axes"))
            if not 1 <= len(self.axes) <= 3:
                raise BadModel(f"joint {self.name} has {len(self.axes)} axes; 1 to 3 are possible")
        if self.axes_assumed:
            put(self, "axes_assumed", tuple(map(bool, self.axes_assumed)))
            if len(self.axes_assumed) != self.n_axes or all(self.axes_assumed):
                raise BadModel(
                    f"joint {self.name} has {self.n_axes} axes; which of them are assumed must be "
                    f"told of each, and not be all of them, but is {self.axes_assumed}"
                )
        if self.axes_reused_from:
            put(self, "axes_reused_from", tuple(map(str, self.axes_reused_from)))
            if len(self.axes_reused_from) != self.n_axes:
                raise BadModel(
                    f"joint {self.name} has {self.n_axes} axes; where they were taken from must be "
                    f"told of each, but is {self.axes_reused_from}"
                )
        if self.rest is not None:
            put(self, "rest", frozen(self.rest, 3, 3, name=f"{self.name} rest"))
        if self.axes_uncertainty is not None:
            put(
                self,
                "axes_uncertainty",
                frozen(self.axes_uncertainty, self.n_axes, name=f"{self.name} axes uncertainty"),
            )

    @property
    def n_axes(self) -> int:
        """Number of movement axes; 0 before parameterization."""
        return 0 if self.axes is None else len(self.axes)

    def with_axes_of(self, other: "Joint") -> "Joint":
        """Return this joint with axes and rest of another, and where those are from."""
        return replace(
            self,
            axes=other.axes,
            rest=other.rest,
            axes_source=other.axes_source,
            axes_assumed=other.axes_assumed,
            axes_reused_from=other.axes_reused_from,
            axes_uncertainty=other.axes_uncertainty,
        )

    @property
    def without_axes(self) -> "Joint":
        """Itself as it is before parameterization."""
        return replace(
            self,
            axes=None,
            rest=None,
            axes_source=None,
            axes_assumed=(),
            axes_reused_from=(),
            axes_uncertainty=None,
        )

    @property
    def axes_sources(self) -> tuple[AxesSource, ...]:
        """Where each axis comes from, (n_axes,); empty where that is not told."""
        if self.axes_source is None:
            return ()
        return sources_of_axes(
            self.axes_source, self.n_axes, self.axes_assumed, self.axes_reused_from
        )


def sources_of_axes(
    source: AxesSource, n_axes: int, assumed: tuple[bool, ...], reused_from: tuple[str, ...]
) -> tuple[AxesSource, ...]:
    """Return where each axis of a joint comes from, (n_axes,).

    One that was put across others is the body's; beside reused ones, one that comes from no other
    recording was told by the movement here.
    """
    across = assumed or (False,) * n_axes
    own = tuple(source == "reused" and bool(reused_from) and not name for name in reused_from)
    here = own or (False,) * n_axes
    return tuple(
        "body" if put else "movement" if mine else source
        for put, mine in zip(across, here, strict=True)
    )


@dataclass(frozen=True, eq=False)
class Skeleton:
    """Limbs in an order where parents come first, and the joints between them.

    ``joints[i]`` joins ``limbs[i + 1]`` to its parent: one joint a limb, the root has none.
    """

    limbs: tuple[Limb, ...]
    joints: tuple[Joint, ...]
    history: History = ()

    def __post_init__(self) -> None:
        if len(self.joints) != len(self.limbs) - 1:
            raise BadModel(
                f"{len(self.limbs)} limbs need {len(self.limbs) - 1} joints, got {len(self.joints)}"
            )
        known = {self.limbs[0].name}
        if self.limbs[0].parent is not None:
            raise BadModel(f"the first limb must be the root; {self.limbs[0].name} has a parent")
        for limb, joint in zip(self.limbs[1:], self.joints, strict=True):
            if joint.child != limb.name or joint.parent != limb.parent:
                raise BadModel(f"joint {joint.name} does not join {limb.name} to {limb.parent}")
            if limb.parent not in known:
                raise BadModel(f"limb {limb.name} comes before its parent {limb.parent}")
            if limb.name in known:
                raise BadModel(f"limb {limb.name} is there twice")
            known.add(limb.name)
        if twice := sorted({n for n in self.joint_names if self.joint_names.count(n) > 1}):
            raise BadModel(f"joint {', '.join(twice)} is there twice")

    @cached_property
    def limb_names(self) -> tuple[str, ...]:
        """Names of the limbs, root first."""
        return tuple(limb.name for limb in self.limbs)

    @cached_property
    def joint_names(self) -> tuple[str, ...]:
        """Names of the joints, in the order of their children."""
        return tuple(joint.name for joint in self.joints)

    @cached_property
    def parents(self) -> np.ndarray[tuple[int], np.dtype[np.intp]]:
        """(n_limbs,) index of each limb's parent; −1 for the root."""
        at = {name: i for i, name in enumerate(self.limb_names)}
        return np.array([-1 if limb.parent is None else at[limb.parent] for limb in self.limbs])

    def limb(self, name: str) -> Limb:
        """Return the limb of that name; KeyError if there is none."""
        return {limb.name: limb for limb in self.limbs}[name]

    def joint(self, name: str) -> Joint:
        """Return the joint of that name; KeyError if there is none."""
        return {joint.name: joint for joint in self.joints}[name]
