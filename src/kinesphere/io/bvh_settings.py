"""What the BVH files we write are like."""

from dataclasses import dataclass

from kinesphere.data.settings import check_settings, setting
from kinesphere.io.bvh_names import NAMINGS

ORDERS = {"smooth": ("yxz", "zyx"), "zxy": ("zxy", "zxy"), "zyx": ("zyx", "zyx")}
"""Name → rotation channels of the root and of joints. YXZ of a root (heading, pitch, roll) is
singular only where it faces straight up or down; ZYX of joints only at ±90° of turning about the
vertical, so that knees and hips bend about x past 90° freely."""


@dataclass(frozen=True)
class BvhSettings:
    """Rest pose, names, channels and unit of ``motion.bvh``."""

    rest: str = setting(
        "standing",
        "Rest pose: standing with hanging arms, or with arms raised to the sides.",
        choices=("standing", "t-pose"),
    )
    names: str = setting(
        "kinesphere",
        "Joint names: as limbs are called here, Unity's human bones (LeftUpperLeg), or "
        "MotionBuilder's and Mixamo's (LeftUpLeg).",
        choices=tuple(NAMINGS),
    )
    channels: str = setting(
        "smooth",
        "Rotation channels: smooth (root YXZ, joints ZYX: knees and hips bend far from the "
        "singularity), or the same for all: zxy, as MotionBuilder writes them, or zyx.",
        choices=tuple(ORDERS),
    )
    unit: str = setting(
        "cm", "Unit of lengths, which the file cannot name.", choices=("cm", "m", "mm", "in")
    )

    def __post_init__(self) -> None:
        check_settings(self)
