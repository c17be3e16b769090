"""Left and right labels, and those of a foot's outer edge, by how they read."""

import re
from collections.abc import Sequence

_SIDES = (("left_", "right_"), ("left", "right"), ("Left", "Right"), ("L", "R"), ("l", "r"))
_BESIDE = re.compile(
    r"(?:.*:)?(?:[LR](?:EFT|IGHT)?[_. ]?)?"  # subject and side
    r"(?P<where>TOE5|MTP?5|FM5|SMALLTOE|VMH|NAV)(?:[_. ][LR])?",
    re.IGNORECASE,
)
_MIDFOOT = ("NAV",)


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


def lies_at_the_edge(labels: Sequence[str]) -> bool:
    """Return whether the markers of a foot's front are customary ones of its outer edge alone.

    Of the fifth ray (``LTOE5``, ``RMT5``, ``FM5``), whatever else is at the middle of the foot
    (``LNAV``). A label that says neither may be anywhere, and nothing is told then.
    """
    found = [_BESIDE.fullmatch(label) for label in labels]
    places = [match["where"].upper() for match in found if match is not None]
    return len(places) == len(labels) and any(place not in _MIDFOOT for place in places)
