"""The body model and the start that a scene asks for."""

import math
from pathlib import Path

from kinesphere.data import Array, BodyChoice, StartChoice
from kinesphere.errors import BadScene
from kinesphere.io.scene.spec import SceneSpec

_LENGTHS_END = "_m"
"""Start values of parameters so named are lengths, the others angles."""

_LEVEL = 0.1
"""Share of a facing that must lie along the floor; what is steeper leaves the heading open."""


def body_choice(spec: SceneSpec, folder: Path) -> BodyChoice:
    """Return the body model; BadScene where it is neither a name nor a file."""
    body = spec.body
    model = body.model
    if model not in ("full", "upper"):
        if not (folder / model).is_file():
            raise BadScene(
                f"body.model = {model!r}: neither 'full' nor 'upper', and no file {folder / model}"
            )
        model = str(folder / model)
    return BodyChoice(model, body.mesh, body.height_m, body.fit)


def start_choice(spec: SceneSpec, turn: Array, first: int, n_frames: int) -> StartChoice:
    """Return the start in the scene's world and frames, values in m and rad.

    Parameters
    ----------
    turn : (3, 3)
        ``world_from_file``.
    first, n_frames
        Which frames the scene has.

    Raises
    ------
    BadScene
        If the start lies outside them, or is to be given and is not, or its facing is no way
        that a person looks.
    """
    start = spec.start
    frame = max(start.frame, first)
    if frame >= first + n_frames:
        raise BadScene(
            f"start.frame = {start.frame}, but the scene has frames {first} to "
            f"{first + n_frames - 1}"
        )
    if start.pose == "given" and not start.values:
        raise BadScene('start.pose = "given" needs start.values, the body model\'s parameters')
    if start.pose == "given" and start.keypoints is not None:
        raise BadScene('start.pose = "given" needs no start.keypoints; leave one of them out')
    if start.facing is not None:
        along = turn @ start.facing
        if math.hypot(along[0], along[2]) <= _LEVEL * math.hypot(*along):
            raise BadScene(
                f"start.facing = {list(start.facing)} points nowhere along the floor; it is the "
                "way the person looks, like [1.0, 0.0, 0.0], in the calibration's axes"
            )
    where = None if start.position_m is None else tuple((turn @ start.position_m).tolist())
    facing = None if start.facing is None else tuple((turn @ start.facing).tolist())
    values = {
        name: value if name.endswith(_LENGTHS_END) else math.radians(value)
        for name, value in start.values.items()
    }
    return StartChoice(start.pose, frame - first, where, facing, values)
