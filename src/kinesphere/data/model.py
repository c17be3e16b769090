"""The topological model: which markers sit on which segment, and which segments meet at a joint.

No pose, no sizes: it holds for every person who wears the layout (Huang & Xia 2010, section 3).
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from kinesphere.data.arrays import Array, frozen
from kinesphere.errors import BadModel


@dataclass(frozen=True)
class Segment:
    """A limb as the layout knows it."""

    name: str
    """A limb name of the conventions (``left_thigh``), or ``limb_01``… where nobody knows."""
    markers: tuple[str, ...]
    """Labels of the markers that move rigidly with this segment and no other."""
    shared: tuple[str, ...] = ()
    """Labels near a joint that a neighbour owns: landmarks here, never part of the rigid fit."""


@dataclass(frozen=True)
class Landmark:
    """Where a joint centre is expected, before the motion has its say.

    The point is ``sum(weight * marker)`` (weights add up to 1) moved by ``inward`` times the
    distance between the two ``scale`` labels, towards the middle of the body along its lateral
    axis; then by ``down`` and ``forward`` times that distance along the other two body axes. The
    axes are those of the body in the default position: standing, arms hanging, down is gravity.

    Where a ``plane`` of markers is named, the axes are its own, however the body stands: to the
    right from its first to its second label, forward within the plane, down across it. ``offset``
    is what a regression adds besides its shares, in metres.
    """

    weights: Mapping[str, float]
    """Label → weight."""
    scale: tuple[str, str] | None = None
    inward: float = 0.0
    down: float = 0.0
    forward: float = 0.0
    spread: float = 0.03
    """m, standard deviation of the true centre about this point."""
    source: str = ""
    """Paper or measurement the numbers come from."""
    plane: tuple[str, ...] = ()
    """Left and right label of one pair, and one or more of the middle behind those."""
    offset: tuple[float, float, float] = (0.0, 0.0, 0.0)
    """m, inward, down and forward, beside what is in proportion; only with a plane."""


@dataclass(frozen=True)
class JointModel:
    """Two segments that meet."""

    name: str
    parent: str
    child: str
    n_axes: int | None = None
    """Movement axes besides twist (paper section 4): 1, 2 or 3; None to find out."""
    landmarks: tuple[Landmark, ...] = ()
    """Best first; the first whose labels are all in the recording counts."""
    doubtful: bool = False
    """Whether the two may not meet at all: motion alone told so, and was not sure of it."""


@dataclass(frozen=True, eq=False)
class MarkerStatistics:
    """Distances between markers, learnt from recordings: what labelling compares with."""

    labels: tuple[str, ...]
    mean: Array
    """(n_labels, n_labels) m; NaN where two markers were never seen together."""
    deviation: Array
    """(n_labels, n_labels) m, standard deviation over time."""
    recording: str
    """A name for the recording it was learnt from, never a path."""
    quadruples: NDArray[np.int64] = field(default_factory=lambda: np.empty((0, 4), dtype=np.int64))
    """(n_quadruples, 4) four labels, by index, that turn the same way round nearly all the time;
    none in models learnt before there were any: left and right look alike then."""
    handedness: Array = field(default_factory=lambda: np.empty(0))
    """(n_quadruples,) −1…1: mean sign of the volume of each quadruple."""

    def __post_init__(self) -> None:
        n = len(self.labels)
        put = object.__setattr__
        put(self, "mean", frozen(self.mean, n, n, name="mean distances"))
        put(self, "deviation", frozen(self.deviation, n, n, name="deviations"))
        quadruples = np.array(self.quadruples, dtype=np.int64).reshape(-1, 4)
        if quadruples.size and not 0 <= quadruples.min() <= quadruples.max() < n:
            raise BadModel(
                f"statistics {self.recording}: a quadruple names label {quadruples.max()}; "
                f"there are {n} labels, numbered from 0"
            )
        quadruples.flags.writeable = False
        put(self, "quadruples", quadruples)
        handed = frozen(self.handedness, len(quadruples), name="handedness")
        put(self, "handedness", handed)


@dataclass(frozen=True, eq=False)
class TopologicalModel:
    """Segments, their markers, the joints between them, and what mirrors what."""

    name: str
    segments: tuple[Segment, ...]
    joints: tuple[JointModel, ...]
    root: str
    """Name of the segment every other hangs from."""
    required: tuple[str, ...] = ()
    """Labels that identify the layout; a recording that has 90 % of them is covered."""
    mirror: tuple[tuple[str, str], ...] = ()
    """Pairs (left label, right label)."""
    aliases: Mapping[str, str] = field(default_factory=dict)
    """Other spelling → label of this model (``RBAK`` → ``RBAC``)."""
    statistics: tuple[MarkerStatistics, ...] = ()
    description: str = ""

    def __post_init__(self) -> None:
        try:
            self._check_segments()
            self._check_joints()
            self._check_tree()
        except BadModel as error:
            raise BadModel(f"model {self.name}: {error}") from None

    def _check_segments(self) -> None:
        names = [segment.name for segment in self.segments]
        _check_once("segment", names)
        if self.root not in names:
            raise BadModel(f"root {self.root!r} is no segment; there are {', '.join(names)}")
        owners: dict[str, str] = {}
        for segment in self.segments:
            for label in segment.markers:
                if label in owners:
                    raise BadModel(
                        f"marker {label} belongs to both {owners[label]} and {segment.name}; "
                        "list it as shared in one of them"
                    )
                owners[label] = segment.name

    def _check_joints(self) -> None:
        names = [segment.name for segment in self.segments]
        _check_once("joint", [joint.name for joint in self.joints])
        for joint in self.joints:
            for end in (joint.parent, joint.child):
                if end not in names:
                    raise BadModel(
                        f"joint {joint.name} names segment {end!r}; there are {', '.join(names)}"
                    )

    def _check_tree(self) -> None:
        parents: dict[str, str] = {}
        for joint in self.joints:
            if joint.child in parents:
                raise BadModel(f"segment {joint.child} has two parents")
            parents[joint.child] = joint.parent
        for segment in self.segments:
            chain = [segment.name]
            while chain[-1] in parents and chain[-1] != self.root:
                chain.append(parents[chain[-1]])
                if chain[-1] in chain[:-1]:
                    raise BadModel(f"joints form a ring through {chain[-1]}")
            if chain[-1] != self.root:
                raise BadModel(f"no chain of joints leads from {segment.name} to the root")
        if self.root in parents:
            raise BadModel(f"root {self.root} hangs from {parents[self.root]}")

    @cached_property
    def labels(self) -> tuple[str, ...]:
        """Every label that a segment owns, in segment order."""
        return tuple(label for segment in self.segments for label in segment.markers)

    def segment(self, name: str) -> Segment:
        """Return the segment of that name; KeyError if there is none."""
        return {segment.name: segment for segment in self.segments}[name]

    @cached_property
    def joints_from_root(self) -> tuple[JointModel, ...]:
        """Joints ordered so that a parent comes before its children."""
        ordered: list[JointModel] = []
        reached = {self.root}
        left = list(self.joints)
        while left:
            ready = [joint for joint in left if joint.parent in reached]
            ordered += ready
            reached |= {joint.child for joint in ready}
            left = [joint for joint in left if joint.child not in reached]
        return tuple(ordered)


def _check_once(what: str, names: Sequence[str]) -> None:
    if twice := sorted({name for name in names if names.count(name) > 1}):
        raise BadModel(f"{what} {', '.join(twice)} is there twice")
