"""A camera of a scene with its files open."""

from dataclasses import dataclass
from pathlib import Path

from kinesphere.data import Image
from kinesphere.errors import BadScene
from kinesphere.io.calibration import CalibratedCamera
from kinesphere.io.scene.footage import median_plate
from kinesphere.io.scene.image_folder import ImageFolder
from kinesphere.io.scene.spec import CameraSpec
from kinesphere.io.scene.streams import Stream, open_stream


@dataclass(frozen=True)
class OpenedCamera:
    """Images and masks as streams, none of them decoded yet."""

    spec: CameraSpec
    calibrated: CalibratedCamera
    stream: Stream
    masks: Stream | None
    reference: Stream | None


def open_camera(camera: CameraSpec, calibrated: CalibratedCamera, folder: Path) -> OpenedCamera:
    """Open the files that a scene names for a camera; UnreadableFile where one cannot be read."""
    stream = open_stream(folder / camera.images)
    step = stream.step if isinstance(stream, ImageFolder) else 1
    masks = None if camera.masks is None else open_stream(folder / camera.masks, step)
    reference = camera.reference_masks
    return OpenedCamera(
        spec=camera,
        calibrated=calibrated,
        stream=stream,
        masks=masks,
        reference=None if reference is None else open_stream(folder / reference, step),
    )


def plate_of(one: OpenedCamera, folder: Path) -> Image | None:
    """Return the image of the empty scene; None where none is named.

    Raises
    ------
    BadScene
        If it is of another size than the camera's images.
    """
    if one.spec.plate is None:
        return None
    stream = open_stream(folder / one.spec.plate)
    plate = median_plate(stream)
    if plate.shape[:2] != (one.stream.size[1], one.stream.size[0]):
        raise BadScene(
            f"{stream.path} is {plate.shape[1]} × {plate.shape[0]} pixels, but the images of "
            f"{one.spec.name} are {one.stream.size[0]} × {one.stream.size[1]}"
        )
    return plate
