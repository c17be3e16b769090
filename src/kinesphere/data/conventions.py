"""What numbers in our files mean, in a few sentences for files that have a place for them."""

from kinesphere import __version__

WORLD = "World: right-handed, y up, metres; times in seconds from the first stored frame."
LIMBS = (
    "Limb frames: body axes after ISB (x anterior, y superior, z to the right), parallel in the "
    "default position (standing, arms hanging), each at the middle of its limb."
)
POSE = (
    "Joint pose: parent_from_child = R(axes[-1], angle n) ... R(axes[0], angle 1) "
    "R(rest long_axis, twist) rest; axes are fixed in the parent's limb frame, angles right-handed."
)
ANGLES = (
    "Joint angles: X is the angle about axis 1, Y about axis 2 (0 where there is none), Z the "
    "twist about the limb (about axis 3 where there are three); a twist nobody saw is 0."
)
WRITTEN_BY = f"Kinesphere {__version__}"
CONVENTIONS = {"world": WORLD, "limbs": LIMBS, "pose": POSE}
