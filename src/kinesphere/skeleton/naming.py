"""Names the conventions give: joints by the limbs they join, left and right by how labels read."""

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

_SIDES = (("left_", "right_"), ("left", "right"), ("Left", "Right"), ("L", "R"), ("l", "r"))


def joint_name(parent: str, child: str, number: int) -> str:
    """Return the joint's name by the conventions, or ``joint_01``… where they have none."""
    return JOINTS.get(frozenset({parent, child}), f"joint_{number:02d}")


def mirror_pairs(labels: tuple[str, ...]) -> tuple[tuple[str, str], ...]:
    """Return pairs (left label, right label) of labels that differ in their side alone.

    The side is a prefix or a suffix: ``LSHO``/``RSHO``, ``left_knee``/``right_knee``,
    ``knee_l``/``knee_r``. A label that starts with L by chance (``LBUL``) has no partner, or the
    wrong one, only if the layout has that label too.
    """
    known = set(labels)
    pairs: list[tuple[str, str]] = []
    taken: set[str] = set()
    for label in labels:
        for left, right in _SIDES:
            candidates = []
            if label.startswith(left):
                candidates.append(right + label[len(left) :])
            for joint in ("_", "."):
                if label.endswith(joint + left):
                    candidates.append(label[: -len(left)] + right)
            partner = next((c for c in candidates if c in known and c not in taken), None)
            if partner is not None and label not in taken:
                pairs.append((label, partner))
                taken |= {label, partner}
                break
    return tuple(pairs)
