"""Which frames each joint's axes and rest come from."""

import numpy as np

from kinesphere.data import Mask, Motion
from kinesphere.errors import BadSetting
from kinesphere.parameterization.anatomy import without_side
from kinesphere.parameterization.per_joint import parse_counts, parse_windows
from kinesphere.parameterization.settings import AxesSettings
from kinesphere.parameterization.view import frames_within


def windows_of(
    motion: Motion, calibration: tuple[float, float] | None, axes: AxesSettings
) -> list[Mask]:
    """Return which frames each joint's axes and rest come from, masks (n_frames,)."""
    own = parse_windows(axes.windows)
    joints = motion.skeleton.joint_names
    kinds = {name: without_side(name) for name in joints}
    for setting, names in (("windows", own), ("counts", parse_counts(axes.counts))):
        if strange := [name for name in names if name not in {*joints, *kinds.values()}]:
            raise BadSetting(
                f"{setting} names {', '.join(strange)}; the joints are {', '.join(joints)}"
            )
    masks = []
    for name in joints:
        key = name if name in own else kinds[name]
        said = f"axes.windows gives {key}" if key in own else "calibration is"
        masks.append(_window(motion, own.get(key, calibration), said))
    return masks


def windows_beyond(motion: Motion, axes: AxesSettings) -> tuple[str, ...]:
    """Return a warning for each joint whose own window reaches beyond the recording."""
    length = motion.n_frames / motion.rate
    return tuple(
        f"the window of {name}, {start:g}:{end:g} s, reaches beyond the recording, which lasts "
        f"{length:.2f} s; what there is of it was used"
        for name, (start, end) in parse_windows(axes.windows).items()
        if end > length
    )


def _window(motion: Motion, calibration: tuple[float, float] | None, said: str) -> Mask:
    """Return which frames lie in a calibration window, (n_frames,), that somebody ``said``."""
    if calibration is None:
        return np.ones(motion.n_frames, dtype=bool)
    start, end = calibration
    window = frames_within(motion.n_frames, motion.rate, calibration)
    if not window.any():
        last = motion.times[-1] if motion.n_frames else 0.0
        raise BadSetting(f"{said} {start:g}–{end:g} s; the recording runs from 0 to {last:.2f} s")
    return window
