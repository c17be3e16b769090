"""A known motion told about given axes: what the angles should be, by another way than the line's.

The line finds angles and twist in closed form; here they are found by Gauss–Newton steps on the
rotations, so that the two check each other.
"""

import numpy as np

from kinesphere.data import Array
from kinesphere.geometry.chain import joint_rotations
from kinesphere.geometry.rotations import rotation_about, rotation_log

_STEPS = 12
_RIDGE = 1e-12  # keeps a singular pose from throwing the step away
_LARGEST_STEP = 0.3  # rad, of one angle in one step
_CONVERGED = 1e-11  # rad


def angles_about_axes(
    relative: Array,
    axes: Array,
    rest: Array,
    long_axis: Array,
    start_angles: Array,
    start_twists: Array,
) -> tuple[Array, Array]:
    """Return the angles and twists that come closest to given orientations.

    Parameters
    ----------
    relative : (n_frames, 3, 3)
        ``parent_from_child``.
    axes : (n_axes, 3)
        One or two unit vectors in the parent frame, distal first.
    rest : (3, 3)
        ``parent_from_child`` where all angles are zero.
    long_axis : (3,)
        In the child frame.
    start_angles, start_twists : (n_frames, n_axes), (n_frames,) rad
        Where to start from: of the two solutions of a pair of axes, the nearer one is found.

    Returns
    -------
    angles, twists : (n_frames, n_axes), (n_frames,) rad
        NaN where ``relative`` is NaN.
    """
    n_axes = len(axes)
    found = np.column_stack([start_angles, start_twists])
    along = rest @ long_axis
    for _ in range(_STEPS):
        reached = joint_rotations(axes, rest, long_axis, found[:, :n_axes], found[:, n_axes])
        missing = rotation_log(relative @ np.swapaxes(reached, 1, 2))
        # the spatial Jacobian: each axis, carried by the rotations proximal to it
        columns = np.empty((len(found), 3, n_axes + 1))
        carried = np.broadcast_to(np.eye(3), relative.shape)
        for k in reversed(range(n_axes)):
            columns[:, :, k] = carried @ axes[k]
            carried = carried @ rotation_about(axes[k], found[:, k])
        columns[:, :, n_axes] = carried @ along
        transposed = np.swapaxes(columns, 1, 2)
        normal = transposed @ columns + _RIDGE * np.eye(n_axes + 1)
        step = np.linalg.solve(normal, transposed @ missing[..., None])[..., 0]
        found = found + np.clip(step, -_LARGEST_STEP, _LARGEST_STEP)
        if not np.nanmax(np.abs(step), initial=0.0) > _CONVERGED:
            break
    return found[:, :n_axes], found[:, n_axes]
