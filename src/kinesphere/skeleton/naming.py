"""Names the conventions give: joints by the limbs they join."""

JOINTS = {
    frozenset({"pelvis", "trunk"}): "lumbar",
    frozenset({"trunk", "head"}): "neck",
}
_SIDED = (
    ("trunk", "upper_arm", "shoulder"),
    ("upper_arm", "forearm", "elbow"),
    ("forearm", "hand", "wrist"),
    ("pelvis", "thigh", "hip"),
    ("trunk", "thigh", "hip"),
    ("thigh", "shank", "knee"),
    ("shank", "foot", "ankle"),
)
for _side in ("left", "right"):
    for _upper, _lower, _joint in _SIDED:
        _above = _upper if _upper in ("trunk", "pelvis") else f"{_side}_{_upper}"
        JOINTS[frozenset({_above, f"{_side}_{_lower}"})] = f"{_side}_{_joint}"


def joint_name(parent: str, child: str, number: int) -> str:
    """Return the joint's name by the conventions, or ``joint_01``… where they have none."""
    return JOINTS.get(frozenset({parent, child}), f"joint_{number:02d}")
