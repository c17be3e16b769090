"""Settings of the surface that rides on the skeleton."""

from dataclasses import dataclass

from kinesphere.data import check_settings, setting

AXES = ("+x", "-x", "+y", "-y", "+z", "-z")


@dataclass(frozen=True)
class SurfaceSettings:
    """How the body's surface is attached."""

    body: str = setting(
        "bundled",
        "which surface rides on the skeleton: bundled, none, or a mesh in a file (OBJ, PLY, STL, "
        "glTF, GLB)",
    )
    up: str = setting(
        "auto",
        "which axis of a given mesh points up; auto finds it by its shape or joints",
        choices=("auto", *AXES),
    )
    facing: str = setting(
        "auto",
        "which axis of a given mesh its front looks along; auto finds it by its shape or joints",
        choices=("auto", *AXES),
    )
    pose: str = setting(
        "auto",
        "how a given mesh without joints stands: arms out (T), half down (A), down (standing)",
        choices=("auto", "T", "A", "standing"),
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
