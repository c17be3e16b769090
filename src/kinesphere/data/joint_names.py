"""What the joint is called by which a limb of the house hangs."""

_JOINTS = {
    "trunk": "lumbar",
    "head": "neck",
    "upper_arm": "shoulder",
    "forearm": "elbow",
    "hand": "wrist",
    "thigh": "hip",
    "shank": "knee",
    "foot": "ankle",
}


def joint_above(limb: str) -> str:
    """Return the name of the joint between a limb and its parent; the limb's own where unknown."""
    for side in ("left_", "right_"):
        if limb.startswith(side):
            return side + _JOINTS.get(limb.removeprefix(side), limb.removeprefix(side))
    return _JOINTS.get(limb, limb)
