"""What a ``SCENE.toml`` may say, checked key by key."""

from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field, StringConstraints

from kinesphere.data import UpAxis

Name = Annotated[str, StringConstraints(min_length=1)]
Finite = Annotated[float, Field(allow_inf_nan=False)]
Vector = Annotated[tuple[Finite, Finite, Finite], Field(strict=False)]
Count = Annotated[int, Field(ge=0)]


class _Table(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True, strict=True)


class PixelMap(_Table):
    """How video pixels become those of the calibration, where the video was cropped or scaled."""

    scale: Annotated[float, Field(gt=0, allow_inf_nan=False)] = 1.0
    shift: Annotated[tuple[Finite, Finite], Field(strict=False)] = (0.0, 0.0)
    """calibration pixel = scale × video pixel + shift, in (right, down)."""


class CameraSpec(_Table):
    """One camera: its images, and how they relate to its calibration and to the others."""

    name: Name
    """As the calibration calls it."""
    images: Name
    """A video, a folder of images, one image, or a pattern with ``*``; from the scene's folder."""
    calibration: Name | None = None
    """A file for this camera alone."""
    calibration_pixel: PixelMap | None = None
    offset: int = 0
    """Which of its images shows frame 0 of the scene: 5, if it began 5 frames before."""
    plate: Name | None = None
    """The scene without the person: an image, or images or a video whose median is taken."""
    masks: Name | None = None
    """White where the person is: images or a video; segmentation is then left out."""
    reference_masks: Name | None = None
    """The same, to be compared with only."""
    first_mask: int | None = None
    """The number of the mask that belongs to the camera's first image."""


class BodySpec(_Table):
    """Which surface is to be found."""

    model: Name = "full"
    """``full``, ``upper``, or a rigged glTF from the scene's folder."""
    mesh: Name = "average"
    height_m: Annotated[float, Field(gt=0.3, lt=3.0)] | None = None
    fit: bool = True


class StartSpec(_Table):
    """What is known of the first pose."""

    pose: Literal["auto", "standing", "t-pose", "a-pose", "given"] = "auto"
    frame: Count = 0
    position_m: Vector | None = None
    """About where the pelvis is, in the calibration's axes."""
    facing: Vector | None = None
    """About where the person looks, in the calibration's axes."""
    values: dict[Name, Finite] = Field(default_factory=dict)
    """The body model's own pose parameters by name: m and deg."""
    keypoints: Name | None = None
    """A folder of OpenPose's JSON files, a folder in it for each camera; or a TRC file."""
    keypoints_axes: Literal["calibration", "y-up"] | None = None
    """Of a TRC file: the calibration's, or y up where the calibration has z up (z, x, y there)."""


class SceneSpec(_Table):
    """A whole ``SCENE.toml``."""

    name: Name | None = None
    calibration: Name | None = None
    """A file for all cameras."""
    unit: Name | None = None
    """Of the calibration's lengths, where it does not say."""
    up: UpAxis | None = None
    """Which axis of the calibration points up."""
    rate_hz: Annotated[float, Field(gt=0, allow_inf_nan=False)] | None = None
    frames: Annotated[tuple[Count, Count], Field(strict=False)] | None = None
    """First and last frame of the scene to be used, counted after the offsets."""
    camera: Annotated[tuple[CameraSpec, ...], Field(min_length=1, strict=False)]
    body: BodySpec = BodySpec()
    start: StartSpec = StartSpec()
