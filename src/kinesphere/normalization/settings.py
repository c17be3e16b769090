"""Every choice of the normalization stage, with its unit, range and source."""

from dataclasses import dataclass

from kinesphere.data import check_settings, setting

_PAPER = "Sar Dessai et al. 2006, section 3"
_TRIED = "tried on recordings of CMU, Plug-in-Gait and functional trials"


@dataclass(frozen=True)
class NormalizationSettings:
    """Settings of ``normalize``."""

    position: str = setting(
        "posture",
        "what makes a frame a default position: the posture of named limbs, or the paper's three "
        "measures of the joints",
        choices=("posture", "paper"),
        source=f"{_PAPER}; posture: {_TRIED}",
    )
    template: str = setting(
        "standing",
        "the pose looked for: arms hanging, or arms stretched out sideways",
        choices=("standing", "t-pose"),
    )
    frames: str = setting(
        "many",
        "average the limb frames over all good frames, or use the best one alone as the paper does",
        choices=("many", "single"),
        source=_PAPER,
    )
    body: str = setting(
        "lateral",
        "body frame from the pairs of shoulders and hips, or from the plane through the joints",
        choices=("lateral", "plane"),
        source=f"{_PAPER}; lateral: {_TRIED}",
    )
    vertical: str = setting(
        "trunk",
        "vertical of the lateral body frame: from the hips to the shoulders, or the world's up",
        choices=("trunk", "up"),
        source=_TRIED,
    )
    limbs: str = setting(
        "minimal",
        "limb frames by the least rotation from the body frame, or by the paper's projection of "
        "two body normals (which jumps when a limb passes 45 deg)",
        choices=("minimal", "paper"),
        source=_PAPER,
    )
    sampling: float = setting(
        10.0, "frames looked at, at most", unit="Hz", low=0.1, high=1000.0, source=_TRIED
    )
    fewest: int = setting(
        600,
        "a recording of no more frames is looked at in all of them, of a longer one in as many at "
        "least; in a short one nothing hangs on which frames are looked at",
        low=1,
        high=1_000_000,
        source=_TRIED,
    )
    smoothing: float = setting(
        0.3, "window over which the cost is averaged", unit="s", low=0.0, high=10.0
    )
    speed_window: float = setting(
        0.2, "time over which the speed of the joints is taken", unit="s", low=0.0, high=10.0
    )
    trunk_tilt: float = setting(
        15.0, "tilt of the trunk that costs 1", unit="deg", low=0.1, high=180.0, source=_TRIED
    )
    arm_angle: float = setting(
        30.0,
        "angle of an arm to the template that costs 1",
        unit="deg",
        low=0.1,
        high=180.0,
        source=_TRIED,
    )
    thigh_angle: float = setting(
        30.0,
        "angle of a thigh from the vertical that costs 1",
        unit="deg",
        low=0.1,
        high=180.0,
        source="keeps sitting with straight knees apart from standing",
    )
    knee_flexion: float = setting(
        20.0, "flexion of a knee that costs 1", unit="deg", low=0.1, high=180.0, source=_TRIED
    )
    plane_distance: float = setting(
        0.085,
        "rms distance of the joints to their plane that costs 1, as a share of the body's span",
        low=1e-3,
        high=1.0,
        source=f"{_TRIED}: 0.04 of the summed bones",
    )
    speed: float = setting(
        0.11,
        "median speed of the joints that costs 1, in body spans a second: 200 mm/s for an adult",
        unit="1/s",
        low=1e-3,
        high=10.0,
        source=_TRIED,
    )
    posture_margin: float = setting(
        0.5, "cost above the best up to which a frame is averaged in", low=0.0, high=100.0
    )
    paper_margin: float = setting(
        0.25,
        "the same for the paper's cost, in median absolute deviations",
        low=0.0,
        high=100.0,
    )

    def __post_init__(self) -> None:
        check_settings(self)
