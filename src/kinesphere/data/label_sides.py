"""Left and right labels, by how they read."""

_SIDES = (("left_", "right_"), ("left", "right"), ("Left", "Right"), ("L", "R"), ("l", "r"))


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
