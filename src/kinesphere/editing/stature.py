"""How tall the figure of a motion stands."""

import numpy as np

from kinesphere.data import Motion
from kinesphere.data.figure import SIDES, find_figure
from kinesphere.editing.foot_contacts import find_ground
from kinesphere.editing.retarget_gaps import without_gaps
from kinesphere.editing.retarget_rest import rest_pose
from kinesphere.errors import BadModel


def stature(motion: Motion) -> float:
    """Return the height in m from the sole to the end of the head, standing in the rest pose.

    The end of the head is that of the limb: where its markers or its end site are.

    Raises
    ------
    BadModel
        If the motion is of no figure with legs and a head.
    """
    skeleton = motion.skeleton
    rest = rest_pose(skeleton, figure := find_figure(skeleton))
    if (head := figure.parts.get("head")) is None:
        raise BadModel("the figure has no head to measure its height by; name a scale instead")
    ankles = [figure.parts.get(f"{s}_foot", figure.parts[f"{s}_shank"]) for s in SIDES]
    limb = skeleton.limbs[head]
    way = limb.length * limb.long_axis if limb.length > 0 else np.zeros(3)
    up = rest.rest_from_body[:, 1]
    top = float((rest.places[head] + way) @ up)
    filled, _ = without_gaps(motion)
    joints = np.concatenate([filled.origins[:, :1], filled.joint_centres()], axis=1)
    ground = find_ground(joints[:, ankles], rest.leg)
    return top - float(np.mean(rest.places[ankles] @ up)) + ground.ankle
