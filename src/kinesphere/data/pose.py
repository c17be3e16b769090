"""Parameters back into motion: the inverse of the whole second half of the line."""

import numpy as np

from kinesphere.data.motion import Motion, PoseFlag
from kinesphere.data.parameters import JointFlag, Parameters
from kinesphere.errors import BadModel
from kinesphere.geometry.chain import chain_poses, joint_rotations


def motion_from_parameters(parameters: Parameters) -> Motion:
    """Rebuild every pose from the root pose, the angles and the skeleton alone.

    Joints never come apart in the result. A twist that is NaN counts as zero; a limb whose angles
    are NaN, and every limb it carries, is unseen. What the parameters call filled or of unknown
    twist is so in the poses; the rest counts as measured.

    Raises
    ------
    BadModel
        If a joint has no axes or no rest orientation.
    """
    skeleton = parameters.skeleton
    relative = np.empty((parameters.n_frames, len(skeleton.joints), 3, 3))
    for j, joint in enumerate(skeleton.joints):
        if joint.axes is None or joint.rest is None:
            raise BadModel(f"joint {joint.name} has no movement axes yet: parameterize first")
        relative[:, j] = joint_rotations(
            joint.axes,
            joint.rest,
            skeleton.limbs[j + 1].long_axis,
            parameters.angles[:, j],
            parameters.twists[:, j],
        )
    rotations, origins = chain_poses(
        skeleton.parents,
        parameters.root_rotations,
        parameters.root_positions,
        relative,
        np.array([joint.centre_in_parent for joint in skeleton.joints]).reshape(-1, 3),
        np.array([joint.centre_in_child for joint in skeleton.joints]).reshape(-1, 3),
    )
    known = np.isfinite(rotations).all(axis=(2, 3)) & np.isfinite(origins).all(axis=2)
    flags = np.where(known, PoseFlag.MEASURED, PoseFlag.UNSEEN).astype(np.uint8)
    said = np.zeros_like(flags)
    said[:, 1:] = parameters.flags
    flags[known & ((said & JointFlag.FILLED) > 0)] = PoseFlag.FILLED
    # said last, for it says more: the twist is no measurement
    flags[known & ((said & JointFlag.TWIST_UNKNOWN) > 0)] = PoseFlag.TWIST_UNKNOWN
    return Motion(
        skeleton=skeleton,
        rotations=rotations,
        origins=origins,
        residuals=np.full(known.shape, np.nan),
        flags=flags,
        rate=parameters.rate,
        first_frame=parameters.first_frame,
        history=parameters.history,
    )
