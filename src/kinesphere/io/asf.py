"""ASF, Acclaim's skeleton: bones by direction and length, in their rest pose."""

from pathlib import Path

from kinesphere.data import Skeleton, Step
from kinesphere.io.asf_text import parse_asf
from kinesphere.io.bones import skeleton_of_bones
from kinesphere.io.bvh import BVH_FROM_BODY


def read_asf(path: str | Path) -> Skeleton:
    """Read a skeleton in its rest pose.

    Raises
    ------
    UnreadableFile
        Naming the line, what was found and what would be right.
    """
    path = Path(path)
    asf = parse_asf(path)
    skeleton = skeleton_of_bones(asf.as_bones(), asf.metres, BVH_FROM_BODY)
    step = Step(
        "read",
        {"format": "asf", "file": path.name},
        {"n_limbs": len(asf.bones), "metres_per_unit": asf.metres},
        asf.warnings,
    )
    return Skeleton(skeleton.limbs, skeleton.joints, (step,))
