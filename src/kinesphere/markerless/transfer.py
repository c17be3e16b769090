"""A pose of one chain taken over by another of the same limbs."""

from dataclasses import replace

import numpy as np

from kinesphere.data import Array
from kinesphere.geometry.rotations import rotation_log
from kinesphere.markerless.chain import Chain
from kinesphere.markerless.pose import Pose, bind_pose, limited, posed


def taken_over(source: Chain, pose: Pose, target: Chain) -> Pose:
    """Return the pose of ``target`` that turns its limbs most like ``source``'s.

    A limb the source lacks stays with its parent. What hinges cannot do is left out: each takes
    the part of the turn that is about its axis.
    """
    at = posed(source, pose)
    turns: list[Array] = []
    out = bind_pose(target)
    balls, angles = out.balls.copy(), out.angles.copy()
    for i, link in enumerate(target.links):
        parent = target.parents[i]
        above = turns[parent] if parent >= 0 else np.eye(3)
        if link.name not in source.limb_names:
            turns.append(above)
            continue
        wanted = above.T @ at.rotations[source.limb_names.index(link.name)]
        if link.kind == "axes":
            dofs = np.flatnonzero(target.dof_limbs == i)
            if link.name in source.limb_names:
                same = np.flatnonzero(source.dof_limbs == source.limb_names.index(link.name))
                axes = source.dof_axes[same]
                if len(same) == len(dofs) and np.allclose(axes, link.axes, atol=0.05):
                    angles[dofs] = pose.angles[same]
                else:
                    angles[dofs] = link.axes @ rotation_log(wanted)
            now = posed(target, replace(out, balls=balls, angles=angles))
            turns.append(above @ now.rotations[parent].T @ now.rotations[i])
        else:
            balls[i] = wanted
            turns.append(above @ wanted)
    position = at.centres[source.limb_names.index(target.limb_names[0])]
    return limited(target, Pose(position.copy(), balls, angles))
