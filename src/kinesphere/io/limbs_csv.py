"""The normalized frame of every limb in every frame of the recording, as a table."""

from pathlib import Path

import numpy as np

from kinesphere.data import Motion
from kinesphere.geometry.rotations import canonical_quaternions
from kinesphere.io.csv import TIME_FORMAT, write_columns

_POSE = ("x_m", "y_m", "z_m", "qx", "qy", "qz", "qw", "flag")


def write_limbs(motion: Motion, path: str | Path) -> None:
    """Write origin and orientation of every limb frame in the world, and how each came about.

    ``LIMB.x_m … z_m`` is the frame's origin, the limb's mid point once it is normalized;
    ``LIMB.qx … qw`` the unit quaternion of ``world_from_limb`` with w ≥ 0; ``LIMB.flag`` the
    number of its `kinesphere.data.PoseFlag`. NaN becomes a blank cell.
    """
    names, columns, formats = ["time_s"], [motion.times[:, None]], [TIME_FORMAT]
    quaternions = canonical_quaternions(motion.rotations)
    for i, limb in enumerate(motion.skeleton.limb_names):
        names += [f"{limb}.{what}" for what in _POSE]
        flags = motion.flags[:, i, None].astype(np.float64)
        columns += [motion.origins[:, i], quaternions[:, i], flags]
        formats += ["%.9f", "%.12f", "%d"]
    write_columns(path, names, columns, formats)
