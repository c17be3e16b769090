"""``isb_angles.csv``: clinical angles after the ISB, a row a frame."""

from pathlib import Path

import numpy as np

from kinesphere.data.isb import IsbAngles
from kinesphere.io.csv import TIME_FORMAT, write_columns


def write_isb_angles(angles: IsbAngles, path: str | Path) -> None:
    """Write ``JOINT.ANGLE_deg`` of every joint, and ``JOINT.gimbal``.

    ``gimbal`` is 1 where the pose is so close to the singular one of its sequence that the angles
    are ill-conditioned (`kinesphere.data.isb.GIMBAL_MARGIN_DEG`), else 0. NaN becomes a blank cell.
    """
    names, columns, formats = ["time_s"], [angles.times[:, None]], [TIME_FORMAT]
    for j, joint in enumerate(angles.joints):
        names += [f"{joint.name}.{angle}_deg" for angle in joint.angle_names]
        names.append(f"{joint.name}.gimbal")
        columns += [np.degrees(angles.angles[:, j]), angles.gimbal[:, j, None].astype(np.float64)]
        formats += ["%.6f", "%d"]
    write_columns(path, names, columns, formats)
