"""The parameters of a motion that was put on other limb lengths, about the same axes as before."""

from dataclasses import replace

import numpy as np

from kinesphere.data import JointFlag, Motion, Parameters, Solution
from kinesphere.geometry.chain import joint_rotations
from kinesphere.parameterization import ParameterizationSettings, parameterize
from kinesphere.parameterization.angles import solve_angles
from kinesphere.parameterization.measures import lever, mid_point_residuals

_ALIKE = 1e-12


def parameters_like(
    motion: Motion, source: Solution, settings: ParameterizationSettings
) -> Parameters:
    """Return parameters about the source's axes and from its rest positions.

    Where a joint turns as it did its parameters stay, to the bit; legs that reach for the ground
    have new ones, and frames that were gaps have those of the poses that bridge them. Of a
    skeleton with other joints they are found as of any motion.
    """
    old = source.parameters
    names = old.skeleton.joint_names
    if motion.skeleton.joint_names != names or motion.n_frames != old.n_frames:
        return parameterize(motion, settings, reuse=source.skeleton)
    relative, before = motion.relative_rotations(), source.motion.relative_rotations()
    angles, twists = np.array(old.angles), np.array(old.twists)
    residuals, flags = np.array(old.residuals), np.array(old.flags)
    joints = []
    for j, (joint, was) in enumerate(zip(motion.skeleton.joints, old.skeleton.joints, strict=True)):
        assert was.axes is not None
        assert was.rest is not None
        limb = motion.skeleton.limbs[j + 1]
        with np.errstate(invalid="ignore"):
            same = (np.abs(relative[:, j] - before[:, j]) <= _ALIKE).all(axis=(1, 2))
        gap = (flags[:, j] & JointFlag.UNSEEN) > 0
        if not same.all():
            known = (flags[:, j] & JointFlag.TWIST_UNKNOWN) == 0
            solved = solve_angles(
                relative[:, j],
                was.axes,
                was.rest,
                limb.long_axis,
                known,
                settings.angles,
                settings.twist,
                motion.rate,
            )
            angles[~same, j], twists[~same, j] = solved.angles[~same], solved.twists[~same]
            flags[gap & ~same, j] = JointFlag.FILLED
        rebuilt = joint_rotations(was.axes, was.rest, limb.long_axis, angles[:, j], twists[:, j])
        middle = lever(joint.centre_in_child, limb.length, limb.long_axis)
        residuals[:, j] = mid_point_residuals(relative[:, j], rebuilt, middle)
        joints.append(joint.with_axes_of(was))
    return Parameters(
        skeleton=replace(motion.skeleton, joints=tuple(joints)),
        root_positions=motion.origins[:, 0],
        root_rotations=motion.rotations[:, 0],
        angles=angles,
        twists=twists,
        residuals=residuals,
        flags=flags,
        moving=old.moving,
        rate=motion.rate,
        first_frame=motion.first_frame,
        history=motion.history,
    )
