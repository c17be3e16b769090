"""Calibrations brought into the scene's world: metres, y up, pixels as the images have them."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from kinesphere.data import DIRECTIONS, Array, Camera, UpAxis, vector_from_direction
from kinesphere.errors import BadScene
from kinesphere.io.calibration import CalibratedCamera
from kinesphere.io.scene.spec import PixelMap
from kinesphere.io.units import metres_from_unit

_FAR = 100.0
"""Cameras stand nearer together than this in metres, and farther apart in millimetres."""
_NEAREST = 0.02
"""m; cameras nearer to their middle cannot tell how far away a person is."""
_SURE = 0.35
"""Mean cosine of the cameras' own up to an axis, and its lead over the next, to be believed."""
_UPRIGHT = 0.8
"""The same, to be believed against what is said."""


@dataclass(frozen=True)
class Units:
    """How many metres one unit of the calibration is, and who said so."""

    metres: float
    name: str
    warnings: tuple[str, ...]


def settle_unit(said: str, cameras: Sequence[CalibratedCamera], where: str) -> Units:
    """Return the unit of a calibration, guessed aloud from the cameras' distances if unsaid.

    Raises
    ------
    BadScene
        If nobody knows the unit that is said.
    """
    centres = np.array([-c.rotation.T @ c.translation for c in cameras])
    apart = np.linalg.norm(centres - centres.mean(axis=0), axis=1).max()
    span = float(apart if len(cameras) > 1 else np.linalg.norm(centres[0]))
    if said:
        metres = metres_from_unit(said)
        if metres is None:
            raise BadScene(f'{where}: unit {said!r} is unknown; write unit = "m" or "mm"')
        if not _NEAREST <= span * metres <= _FAR:
            raise BadScene(
                f'{where}: with unit = "{said}" the cameras stand {span * metres:.3g} m from their '
                f'middle; unit = "{"mm" if span * metres > _FAR else "m"}" may be meant'
            )
        return Units(metres, said, ())
    guess = "mm" if span > _FAR else "m"
    warning = (
        f"{where} names no unit; {guess} is guessed, as the cameras stand {span:.3g} from their "
        f'middle; write unit = "{guess}" in the scene to settle it'
    )
    return Units(1e-3 if guess == "mm" else 1.0, guess, (warning,))


def settle_up(
    said: str, cameras: Sequence[CalibratedCamera], where: str
) -> tuple[UpAxis, tuple[str, ...]]:
    """Return which axis of the calibration is up, guessed aloud from the cameras if unsaid.

    Raises
    ------
    BadScene
        If it is not said and the cameras do not stand upright enough to tell, or what is said is
        no axis.
    """
    # the image's up, as people hold cameras; what cameras look down by cancels around the person
    ups = np.mean([-c.rotation[1] for c in cameras], axis=0)
    share = {d: float(vector_from_direction(d) @ ups) for d in DIRECTIONS}
    ranked = sorted(DIRECTIONS, key=lambda d: -share[d])
    best, second = ranked[0], ranked[1]
    if said:
        known = {str(d): d for d in DIRECTIONS}
        if said not in known:
            names = ", ".join(DIRECTIONS)
            raise BadScene(f"{where}: up = {said!r} is no axis; write one of {names}")
        direction = known[said]
        if direction != best and share[best] > _UPRIGHT:
            return direction, (
                f"{where}: up is {direction}, but the cameras' images have {best} upwards; unless "
                f'they hang like that, write up = "{best}"',
            )
        return direction, ()
    if share[best] - share[second] < _SURE:
        raise BadScene(
            f"{where} does not say which axis is up, and the cameras do not tell ({best} or "
            f'{second}); write up = "{best}" in the scene'
        )
    return best, (
        f"{where} does not say which axis is up; {best} is guessed, as the cameras stand that way; "
        f'write up = "{best}" in the scene to settle it',
    )


def camera_in_world(
    found: CalibratedCamera,
    image_size: tuple[int, int],
    pixel_map: PixelMap | None,
    metres: float,
    turn: Array,
) -> tuple[Camera, tuple[str, ...]]:
    """Return a camera in metres and the scene's world, for images of that size.

    Parameters
    ----------
    image_size
        Width and height of the images.
    pixel_map
        How image pixels become the calibration's.
    turn : (3, 3)
        ``world_from_file``.

    Raises
    ------
    BadScene
        If the calibration is for another size of image, and no map is given.
    """
    matrix = found.matrix
    warnings: tuple[str, ...] = ()
    if pixel_map is not None:
        (right, down), scale = pixel_map.shift, pixel_map.scale
        matrix = np.array([[1, 0, -right], [0, 1, -down], [0, 0, scale]]) / scale @ matrix
        matrix = matrix / matrix[2, 2]
    elif found.size is not None and found.size != image_size:
        matrix = _scaled(found, image_size) @ matrix
        warnings = (
            f"{found.name} was calibrated at {_by(found.size)} pixels and its images are "
            f"{_by(image_size)}; the calibration is scaled to fit",
        )
    camera = Camera(
        name=found.name,
        width=image_size[0],
        height=image_size[1],
        matrix=matrix,
        distortion=found.distortion,
        rotation=found.rotation,
        translation=found.translation * metres,
    )
    return camera.turned(turn, np.zeros(3)), warnings


def _scaled(found: CalibratedCamera, image_size: tuple[int, int]) -> Array:
    assert found.size is not None
    across, down = image_size[0] / found.size[0], image_size[1] / found.size[1]
    uneven = abs(image_size[0] - found.size[0] * down)
    if uneven > 1.0 or abs(across - 1) < 0.02:
        raise BadScene(
            f"{found.name}: its images are {_by(image_size)} pixels, but it was calibrated at "
            f"{_by(found.size)}; say how a pixel of the image becomes one of the calibration: "
            "calibration_pixel = { scale = 1.0, shift = [0, 0] }"
        )
    # corners of images coincide, pixel centres are half a pixel further in
    return np.array([[across, 0, (across - 1) / 2], [0, down, (down - 1) / 2], [0, 0, 1.0]])


def _by(size: tuple[int, int]) -> str:
    return f"{size[0]} × {size[1]}"
