"""Where the vertices of a bound surface are, frame by frame."""

from typing import Literal, TypeAlias

import numpy as np
from numpy.typing import NDArray

from kinesphere.data import (
    Array,
    Motion,
    Surface,
    TwistJoints,
    default_origins,
    poses_without_gaps,
)
from kinesphere.errors import BadSetting, BadSurface
from kinesphere.geometry.skinning import dual_quaternion_blend, linear_blend

Blend: TypeAlias = Literal["linear", "dual-quaternion", "twist-joints"]
BLENDS = ("linear", "dual-quaternion", "twist-joints")


def skin(
    surface: Surface,
    motion: Motion,
    frames: NDArray[np.intp] | None = None,
    blend: Blend = "dual-quaternion",
) -> Array:
    """Return the vertices of a surface that rides on a moving skeleton.

    Parameters
    ----------
    surface
        Bound to the motion's skeleton by `attach_surface`: in its default position.
    motion
        Normalized. A limb that is not seen keeps its last place in its parent.
    frames : (n,)
        Which; all by default.
    blend
        ``"linear"``, the weighted mean of the limbs; ``"dual-quaternion"``, which keeps the volume
        of what twists; ``"twist-joints"``, linear with twist spread along the limbs, as
        ``motion.glb`` has it.

    Returns
    -------
    (n, n_vertices, 3) m, in the world.

    Raises
    ------
    BadSurface
        If the surface rides on other limbs.
    BadSetting
        If there is no such blend.
    """
    if blend not in BLENDS:
        raise BadSetting(f"blend is {blend!r}; known are {', '.join(BLENDS)}")
    rotations, shifts = bind_transforms(surface, motion, frames)
    if blend == "twist-joints":
        joints = TwistJoints(surface)
        return linear_blend(surface.vertices, *joints.weights, *joints.maps(rotations, shifts))
    moved = linear_blend if blend == "linear" else dual_quaternion_blend
    return moved(surface.vertices, surface.weight_limbs, surface.weight_shares, rotations, shifts)


def bind_transforms(
    surface: Surface, motion: Motion, frames: NDArray[np.intp] | None = None
) -> tuple[Array, Array]:
    """Return what takes each limb from the default position into the world.

    ``rotation @ p + shift`` of a point ``p`` of the default position.

    Returns
    -------
    rotations, shifts : (n, n_limbs, 3, 3), (n, n_limbs, 3) m
    """
    if surface.limbs != motion.skeleton.limb_names:
        raise BadSurface(
            f"the surface rides on {', '.join(surface.limbs)}; the skeleton has "
            f"{', '.join(motion.skeleton.limb_names)}: attach it first"
        )
    rotations, origins = poses_without_gaps(motion)
    if frames is not None:
        rotations, origins = rotations[frames], origins[frames]
    rest = default_origins(motion.skeleton)
    return rotations, origins - (rotations @ rest[:, :, None])[..., 0]
