"""What the limbs around a limb tell about it: where they are, and how a hinge bends."""

import numpy as np

from kinesphere.data import Array, JointModel
from kinesphere.skeleton.averages import mean_seen
from kinesphere.skeleton.body_axes import unit
from kinesphere.skeleton.tree import Tree

HINGE_SIGN = {"elbow": 1.0, "knee": -1.0}
"""cross(upper limb, lower limb), both pointing away from the body, times this points to the right:
elbows flex to the front, knees to the back."""


def cloud(labels: tuple[str, ...], markers: dict[str, Array]) -> Array:
    """Return markers side by side, label → (n_frames, 3) m to (n_frames, n_labels, 3) m."""
    points = np.empty((len(markers[labels[0]]), len(labels), 3))
    for i, label in enumerate(labels):
        for k in range(3):  # along frames: three numbers at a time take six times as long
            points[:, i, k] = markers[label][:, k]
    return points


def hinge_sign(joint: JointModel) -> float | None:
    """Return which way the joint's flexion axis points, +1 for right; None if nobody knows."""
    return next((sign for part, sign in HINGE_SIGN.items() if joint.name.endswith(part)), None)


def next_normals(
    limb: str, towards: Array, end: Array, tree: Tree, markers: dict[str, Array]
) -> Array:
    """Return ``cross`` of the directions of a limb and the one limb beyond it, (n, 3).

    Parameters
    ----------
    towards : (n, 3)
        Unit direction of the limb, in the world.
    end : (n, 3) m
        Its far end.

    Returns
    -------
    (n, 3)
        As long as the sine of the flexion, towards the body's right where the joint's name tells;
        NaN where unknown.
    """
    beyond = [joint for joint in tree.joints if joint.parent == limb]
    if len(beyond) != 1:
        return np.full(towards.shape, np.nan)
    sign = hinge_sign(beyond[0]) or 1.0
    lower = mean_seen(cloud(tree.markers[beyond[0].child], markers), axis=1) - end
    normals: Array = sign * np.cross(towards, unit(lower))
    return normals


def flexed_normals(normals: Array, flexed: float) -> Array:
    """Return the normals as long as the sine of ``flexed`` (rad) at least, NaN for the others."""
    enough = np.linalg.norm(normals, axis=1) > np.sin(flexed)
    return np.where(enough[:, None], normals, np.nan)
