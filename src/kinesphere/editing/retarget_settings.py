"""How a motion is put on another skeleton."""

from dataclasses import dataclass

from kinesphere.data.settings import check_settings, setting


@dataclass(frozen=True)
class RetargetSettings:
    """Feet and ground; everything else follows from the two skeletons."""

    feet: str = setting(
        "planted",
        "What feet do on the ground: planted (they stay where they stand), or free (as the limbs' "
        "directions have them; they slide where legs have other proportions).",
        choices=("planted", "free"),
    )
    contact_speed: float = setting(
        0.2,
        "Heel or ball slower than this, and low, stands; for legs of 0.85 m, else in proportion.",
        unit="m/s",
        low=0.01,
        high=2.0,
        source="docs/results/retargeting.md",
    )
    contact_height: float = setting(
        50.0,
        "Heel or ball less than this above its lowest level (5 % of frames) may stand.",
        unit="mm",
        low=1.0,
        high=500.0,
    )
    shortest_contact: float = setting(
        0.08,
        "A shorter contact is none; a shorter gap in one neither.",
        unit="s",
        low=0.0,
        high=1.0,
    )
    blend: float = setting(
        0.25,
        "Before and after a contact the correction comes and goes over at most this.",
        unit="s",
        low=0.02,
        high=2.0,
    )
    reach: float = setting(
        0.99,
        "Share of a leg's length beyond which the pelvis goes down and the knee stays bent.",
        low=0.9,
        high=1.0,
        source="docs/results/retargeting.md; a knee straighter than 16° turns by more than 1° for "
        "each mm that hip or ankle moves. Legs that are straighter in the recording may be so.",
    )

    def __post_init__(self) -> None:
        check_settings(self)
