"""What cameras saw: marker trajectories, and whatever else the file held."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, Literal, TypeAlias

import numpy as np

from kinesphere.data.arrays import Array, Mask, frozen
from kinesphere.data.directions import UpAxis
from kinesphere.data.history import History
from kinesphere.errors import BadRecording
from kinesphere.geometry.vectors import is_seen

OutputKind: TypeAlias = Literal[
    "angle", "force", "moment", "power", "scalar", "segment_frame", "centre_of_mass", "other"
]


@dataclass(frozen=True, eq=False)
class Output:
    """A point of the file that is no marker: an angle, a force, a segment frame of the vendor."""

    label: str
    kind: OutputKind
    values: Array
    """(n_frames, 3) in ``unit``, exactly as the file holds them: angles are never lengths."""
    unit: str
    residuals: Array | None = None
    """(n_frames,) as the file holds them."""

    def __post_init__(self) -> None:
        object.__setattr__(self, "values", frozen(self.values, None, 3, name=self.label))
        if self.residuals is not None:
            n_frames = len(self.values)
            object.__setattr__(
                self,
                "residuals",
                frozen(self.residuals, n_frames, name=f"residuals of {self.label}"),
            )


@dataclass(frozen=True, eq=False)
class Analog:
    """Analog channels sampled beside the markers."""

    values: Array
    """(n_samples, n_channels), in each channel's unit."""
    labels: tuple[str, ...]
    units: tuple[str, ...]
    rate: float
    """Hz; a whole multiple of the marker rate in C3D."""

    def __post_init__(self) -> None:
        object.__setattr__(
            self, "values", frozen(self.values, None, len(self.labels), name="analog values")
        )
        if len(self.units) != len(self.labels):
            raise BadRecording(
                f"{len(self.labels)} analog channels have {len(self.units)} units; "
                "each needs one, be it empty"
            )


@dataclass(frozen=True)
class Event:
    """Something that happened at an instant: a foot strike, a start."""

    time: float
    """s, on the clock of ``Recording.times``."""
    label: str
    context: str = ""
    """Left, Right, General, …"""
    subject: str = ""
    description: str = ""


@dataclass(frozen=True, eq=False)
class Recording:
    """Marker trajectories in metres, and everything else their file held.

    ``markers`` are in the axes of the file until a stage turns them; ``world_from_file`` is the
    rotation (or signed permutation) applied so far, so that a writer can undo it exactly.
    """

    markers: Array
    """(n_frames, n_markers, 3) m; NaN means not seen."""
    labels: tuple[str, ...]
    """Unique. Points nobody labelled are ``*0``, ``*1``…"""
    rate: float
    """Hz."""
    first_frame: int = 1
    """Number of the first stored frame in the file it came from."""
    residuals: Array | None = None
    """(n_frames, n_markers) m: the reconstruction residual of each point; NaN where unknown."""
    confidence: Array | None = None
    """(n_markers,) 0…1: how sure each label is that labelling gave; NaN for the others."""
    outputs: tuple[Output, ...] = ()
    analog: Analog | None = None
    events: tuple[Event, ...] = ()
    up: UpAxis | None = None
    """The direction that is up in ``markers``' axes, as far as known."""
    world_from_file: Array = field(default_factory=lambda: np.eye(3))
    """(3, 3): ``p_world = world_from_file @ p_file``."""
    details: Mapping[str, Any] = field(default_factory=dict)
    """What a format needs to write itself back without loss; private to ``io``."""
    history: History = ()

    def __post_init__(self) -> None:
        labels = tuple(self.labels)
        if len(set(labels)) != len(labels):
            twice = sorted({label for label in labels if labels.count(label) > 1})
            raise BadRecording(f"labels must be unique; more than once: {', '.join(twice)}")
        if not 0 < self.rate < np.inf:
            raise BadRecording(f"frame rate is {self.rate} Hz; it must be positive and finite")
        put = object.__setattr__
        put(self, "labels", labels)
        put(self, "markers", frozen(self.markers, None, len(labels), 3, name="markers"))
        if self.residuals is not None:
            shape = self.markers.shape[:2]
            put(self, "residuals", frozen(self.residuals, *shape, name="residuals"))
        if self.confidence is not None:
            put(self, "confidence", frozen(self.confidence, len(labels), name="confidence"))
        for output in self.outputs:
            if len(output.values) != self.n_frames:
                raise BadRecording(
                    f"output {output.label} has {len(output.values)} frames, "
                    f"the markers have {self.n_frames}"
                )
        put(self, "world_from_file", frozen(self.world_from_file, 3, 3, name="world_from_file"))

    @property
    def n_frames(self) -> int:
        """Number of frames."""
        return len(self.markers)

    @property
    def n_markers(self) -> int:
        """Number of markers, labelled or not."""
        return len(self.labels)

    @property
    def times(self) -> Array:
        """(n_frames,) s since the first stored frame."""
        return np.arange(self.n_frames) / self.rate

    @cached_property
    def seen(self) -> Mask:
        """(n_frames, n_markers) True where a marker has a position."""
        return is_seen(self.markers)

    def columns(self, labels: tuple[str, ...]) -> list[int]:
        """Return the column of each label.

        Raises
        ------
        BadRecording
            Naming the labels that are not there.
        """
        at = {label: i for i, label in enumerate(self.labels)}
        if missing := [label for label in labels if label not in at]:
            raise BadRecording(
                f"no marker is called {', '.join(missing)}; there are {', '.join(self.labels)}"
            )
        return [at[label] for label in labels]
