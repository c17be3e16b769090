"""How much of an edit each frame gets."""

import numpy as np

from kinesphere.data import Array
from kinesphere.data.edits import Edit
from kinesphere.errors import BadSetting

ROUNDING = 1e-9  # s


def edit_weights(edit: Edit, n_frames: int, rate: float, first_frame: int) -> Array:
    """Return how much of an edit each frame gets, (n_frames,) from 0 to 1.

    All of it within the edit's span; before and after it falls to nothing over ``blend_s``, by the
    polynomial whose speed and acceleration are zero at both ends.

    Parameters
    ----------
    edit
    n_frames
    rate
        Hz.
    first_frame
        Number of the first stored frame.

    Raises
    ------
    BadSetting
        If the span lies outside the motion.
    """
    times = np.arange(n_frames) / rate
    last_frame = first_frame + n_frames - 1
    if edit.frames is not None:
        start, end = ((frame - first_frame) / rate for frame in edit.frames)
        if edit.frames[0] < first_frame or edit.frames[1] > last_frame:
            raise BadSetting(
                f"frames {list(edit.frames)} lie outside the motion, frames {first_frame} to "
                f"{last_frame}"
            )
    elif edit.seconds is not None:
        start, end = edit.seconds
        if end > times[-1] + ROUNDING:
            raise BadSetting(
                f"seconds {list(edit.seconds)} lie outside the motion, 0 to {times[-1]:.3f} s"
            )
    else:
        return np.ones(n_frames)
    away = np.maximum(start - times, times - end)
    inside = away <= ROUNDING
    if edit.blend_s == 0:
        return inside.astype(np.float64)
    t = np.clip(1 - away / edit.blend_s, 0.0, 1.0)
    return np.asarray(np.where(inside, 1.0, t**3 * (10 - 15 * t + 6 * t**2)))
