"""What several calibrated cameras saw at the same times, and who is to be found there."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Protocol, TypeAlias

import numpy as np
from numpy.typing import NDArray

from kinesphere.data.arrays import Array, Mask, frozen
from kinesphere.data.camera import Camera
from kinesphere.data.history import History
from kinesphere.data.keypoints import PlacedKeypoints, SeenKeypoints
from kinesphere.data.surface import Surface
from kinesphere.errors import BadScene

Image: TypeAlias = NDArray[np.uint8]
"""(height, width, 3), red, green, blue; a grey camera's three are equal."""


@dataclass(frozen=True, eq=False)
class Frame:
    """One instant, as every camera saw it."""

    index: int
    """From 0, the scene's first frame."""
    images: tuple[Image | None, ...]
    """One a camera; None where it has none at this instant."""
    masks: tuple[Mask | None, ...]
    """(height, width) True on the person, one a camera; None where nobody gave one."""
    references: tuple[Mask | None, ...] = ()
    """The same, to be compared with only."""

    def __post_init__(self) -> None:
        if not self.references:
            object.__setattr__(self, "references", (None,) * len(self.images))


class Footage(Protocol):
    """Where the images come from: files that are decoded as they are asked for, or a renderer."""

    def frames(self, start: int, stop: int, step: int) -> Iterator[Frame]:
        """Yield frames ``start``, ``start + step``, … before ``stop``."""
        ...


@dataclass(frozen=True)
class BodyChoice:
    """Which surface is to be found."""

    model: str = "full"
    """``full``, ``upper`` (the paper's 21 degrees of freedom), or the path of a rigged glTF."""
    mesh: str = "average"
    """Which of the bundled bodies to begin with."""
    height: float | None = None
    """m, if known."""
    fit: bool = True
    """Whether size, girth and limb lengths are fitted to the person."""


@dataclass(frozen=True)
class StartChoice:
    """What is known of the first pose."""

    pose: str = "auto"
    """``auto``, ``standing``, ``t-pose``, ``a-pose``, or ``given`` by ``values``."""
    frame: int = 0
    """In which frame of the scene the person is found first."""
    position: tuple[float, float, float] | None = None
    """m, about where the pelvis is, in the scene's world."""
    facing: tuple[float, float, float] | None = None
    """About where the person looks, in the scene's world."""
    values: Mapping[str, float] = field(default_factory=dict)
    """Values of the body model's own pose parameters by name, in m and rad."""
    keypoints: SeenKeypoints | PlacedKeypoints | None = None
    """Where a pose estimator found the person in that frame; they replace the search."""


@dataclass(frozen=True, eq=False)
class Scene:
    """Synchronised cameras in one world (y up, right-handed, metres), and their images."""

    name: str
    cameras: tuple[Camera, ...]
    rate: float
    """Hz."""
    n_frames: int
    """Instants that every camera covers."""
    footage: Footage
    plates: tuple[Image | None, ...]
    """The empty scene, one a camera; None where there is none."""
    offsets: tuple[int, ...]
    """Which frame of each camera's own images is the scene's frame 0."""
    world_from_file: Array
    """(3, 3) rotation from the calibration's axes to the scene's world."""
    body: BodyChoice = field(default_factory=BodyChoice)
    start: StartChoice = field(default_factory=StartChoice)
    surface: Surface | None = None
    """The person's own body model; the bundled one serves where there is none."""
    has_masks: bool = False
    """Whether masks of the person are given: they then stand in for segmentation."""
    first_frame: int = 0
    """Which frame of the first camera's own images frame 0 is, as people count: for labels only."""
    history: History = ()

    def __post_init__(self) -> None:
        put = object.__setattr__
        put(self, "world_from_file", frozen(self.world_from_file, 3, 3, name="world_from_file"))
        n = len(self.cameras)
        if n == 0:
            raise BadScene("the scene has no camera")
        names = [camera.name for camera in self.cameras]
        if twice := sorted({name for name in names if names.count(name) > 1}):
            raise BadScene(f"camera {', '.join(twice)} is there twice")
        if len(self.plates) != n or len(self.offsets) != n:
            raise BadScene(f"{n} cameras need {n} plates (None for no plate) and {n} offsets")
        if not (np.isfinite(self.rate) and self.rate > 0):
            raise BadScene(f"the rate is {self.rate} Hz; it must be positive")
        if self.n_frames < 1:
            raise BadScene("the scene has no frame that every camera covers")
        for camera, plate in zip(self.cameras, self.plates, strict=True):
            if plate is not None and plate.shape != (camera.height, camera.width, 3):
                raise BadScene(
                    f"the plate of {camera.name} is {plate.shape[1]} × {plate.shape[0]} pixels, "
                    f"its camera {camera.width} × {camera.height}"
                )

    def frames(self, start: int = 0, stop: int | None = None, step: int = 1) -> Iterator[Frame]:
        """Yield frames from ``start`` to before ``stop`` (the last one, if None), in order."""
        stop = self.n_frames if stop is None else min(stop, self.n_frames)
        return self.footage.frames(start, stop, step)

    def frame(self, index: int) -> Frame:
        """Return one frame."""
        return next(iter(self.frames(index, index + 1)))

    @property
    def notes(self) -> tuple[str, ...]:
        """What went wrong while reading images so far, a sentence each."""
        return tuple(getattr(self.footage, "notes", ()))

    @property
    def times(self) -> Array:
        """(n_frames,) s since frame 0."""
        return np.arange(self.n_frames) / self.rate
