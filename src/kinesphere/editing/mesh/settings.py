"""Settings of the surface that rides on the skeleton."""

from dataclasses import dataclass

from kinesphere.data import check_settings, setting


@dataclass(frozen=True)
class SurfaceSettings:
    """How the body's surface is attached."""

    body: str = setting(
        "bundled",
        "which surface rides on the skeleton; none leaves it out",
        choices=("bundled", "none"),
    )
    fit_girths: bool = setting(True, "whether markers tell how thick the limbs are")
    marker_height: float = setting(
        10.0,
        "from the skin to the middle of a marker",
        unit="mm",
        low=0.0,
        high=50.0,
        source="markers of 14 to 16 mm on a base of 2 to 3 mm",
    )

    def __post_init__(self) -> None:
        check_settings(self)
