"""What may be chosen when bodies and joints are found from motion alone."""

from dataclasses import dataclass
from typing import Literal

from kinesphere.data import check_settings, setting
from kinesphere.geometry.lifetimes import GHOST


@dataclass(frozen=True)
class DiscoverySettings:
    """Settings of the stage ``discovery``; it runs only where no model says which marker is where.

    Lengths are those of a person; a smaller or larger subject is looked at as if it were as large.
    """

    method: Literal["spectral", "linkage"] = setting(
        "spectral",
        "how markers are grouped into bodies: self-tuning spectral clustering, or average linkage, "
        "good for rigid plates of three and more markers alone: on four recordings of 41 sparse "
        "markers it reaches an adjusted Rand index of 0.13 to 0.47, and two people are two bodies",
        choices=("spectral", "linkage"),
        source="docs/results/skeleton.md: far better on sparse markers and on several people",
    )
    bodies: int | None = setting(
        None,
        "how many marker bodies there are; none finds it",
        low=1,
        high=500,
    )
    tree: int = setting(
        1,
        "which of the bodies that move independently is solved: 1 has the most markers",
        low=1,
        high=100,
    )
    names: bool = setting(True, "name limbs where tree, proportions and motion show a person")
    sample_frames: int = setting(
        1500,
        "frames that distances are compared on, spread evenly over the way the markers travel",
        low=10,
        high=100_000,
        source="200 to 1500 give the same bodies on seven of eight recordings; all frames of the "
        "eighth weigh its rests more and do worse",
    )
    near_mm: float = setting(
        75.0,
        "distance at which steadiness counts 0.7 of what it does for neighbours: what is near is "
        "likelier one body",
        unit="mm",
        low=1.0,
        high=10_000.0,
        source="38 to 75 mm give the same bodies on seventeen cases; at 150 mm a recording of 41 "
        "markers loses limbs",
    )
    ghost_s: float = setting(
        GHOST,
        "a marker never around for so long, nor in half of the frames, is a reflection; breaks up "
        "to a tenth of it do not count. So much of the recording, 5 % at most, is left out of "
        "every distance at either end",
        unit="s",
        low=0.0,
        high=60.0,
        source="Kirk, O'Brien, Forsyth 2005 as told in docs/papers.md",
    )
    split_ratio: float = setting(
        3.0,
        "a body falls in two where that makes its least steady distance so many times steadier",
        low=1.0,
        high=100.0,
        source="an F of 9; unstructured deviations give up to 1.5",
    )
    shared_ratio: float = setting(
        2.0,
        "a marker is at a joint if it wanders in the neighbour less than so many times what it "
        "does in its own body",
        low=1.0,
        high=100.0,
    )

    def __post_init__(self) -> None:
        check_settings(self)
