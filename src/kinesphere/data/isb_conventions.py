"""Clinical joint angles: which sequence, which names, which sign, per kind of joint.

Wu et al. 2002, doi:10.1016/S0021-9290(01)00222-6 (hip, ankle, spine); Grood & Suntay 1983,
doi:10.1115/1.3138397 (knee); Wu et al. 2005, doi:10.1016/j.jbiomech.2004.05.042 (shoulder, elbow,
wrist); Baker 2001, doi:10.1016/S0966-6362(00)00083-7 (pelvis in the laboratory).
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal, TypeAlias

Sequence: TypeAlias = Literal["ZXY", "YXY", "YXZ"]
"""Order in which the child is turned about its own axes, x anterior, y superior, z to the right."""


@dataclass(frozen=True)
class Convention:
    """How the three angles of a kind of joint are read from ``parent_from_child``."""

    sequence: Sequence
    angles: tuple[tuple[str, int, int], ...]
    """Clinical name, which angle of the sequence (0, 1, 2), and its sign on the right side."""
    hinged: bool = False
    """Whether the joint's own flexion axis, where it was measured, says which way z points."""
    palm_turn_deg: float = 0.0
    """deg by which z is turned forward about the parent's long axis."""
    source: str = ""


def _cardan(flexion: str, sign: int, second: str, third: str) -> tuple[tuple[str, int, int], ...]:
    return ((flexion, 0, sign), (second, 1, 1), (third, 2, 1))


_TRUNK = _cardan("flexion", -1, "right_bending", "left_rotation")
CONVENTIONS: Mapping[str, Convention] = {
    "hip": Convention(
        "ZXY", _cardan("flexion", 1, "adduction", "internal_rotation"), source="Wu 2002"
    ),
    "knee": Convention(
        "ZXY",
        _cardan("flexion", -1, "adduction", "internal_rotation"),
        hinged=True,
        source="Grood & Suntay 1983",
    ),
    "ankle": Convention(
        "ZXY", _cardan("dorsiflexion", 1, "inversion", "internal_rotation"), source="Wu 2002"
    ),
    "shoulder": Convention(
        "YXY",
        (("plane_of_elevation", 0, 1), ("elevation", 1, -1), ("internal_rotation", 2, 1)),
        source="Wu 2005",
    ),
    "elbow": Convention(
        "ZXY",
        (("flexion", 0, 1), ("valgus", 1, -1), ("pronation", 2, 1)),
        hinged=True,
        source="Wu 2005",
    ),
    # the person hangs the arms with the palms to the thighs, not forward: see docs/conventions.md
    "wrist": Convention(
        "ZXY",
        _cardan("flexion", 1, "ulnar_deviation", "pronation"),
        palm_turn_deg=90.0,
        source="Wu 2005",
    ),
    "lumbar": Convention("ZXY", _TRUNK, source="Wu 2002"),
    "neck": Convention("ZXY", _TRUNK, source="Wu 2002"),
}
"""Kind of joint (``knee`` of ``left_knee``) → convention."""

ROOT_CONVENTION = Convention(
    "YXZ",
    (("anterior_tilt", 2, -1), ("right_up_obliquity", 1, -1), ("left_rotation", 0, 1)),
    source="Baker 2001",
)
"""Of the root limb in the laboratory: tilt and obliquity do not ask where x of the world points."""
ROOTS = ("pelvis", "trunk")


def without_side(name: str) -> str:
    """Return ``hip`` for ``left_hip``; other names as they are."""
    return name.removeprefix("left_").removeprefix("right_")
