"""Every choice of the tracker, with its unit, range and source."""

from dataclasses import dataclass, replace

from kinesphere.data import check_settings, setting

_TRIED = "tried on rendered and real footage"
_PAPER = "Rosenhahn et al. 2006"


@dataclass(frozen=True)
class TrackSettings:
    """Settings of ``track``."""

    method: str = setting(
        "region",
        "how images move the model: colour statistics along lines across its rim; the paper's "
        "level set and contour; the same drawn towards the model, for clutter",
        choices=("region", "level-set", "coupled"),
        source=f"region: Stoiber et al. 2022, doi:10.1007/s11263-022-01579-8; {_PAPER}, 2.1, 3.1",
    )
    equations: str = setting(
        "image",
        "what contour points are brought to: the edge in the image, or the line of sight in space",
        choices=("image", "plucker"),
        source=f"{_PAPER}, equations 10 to 12",
    )
    largest: int = setting(960, "longer side of the images worked on", unit="px", low=64, high=4096)
    cell: int = setting(
        6, "one point of the rim is taken in a square of this side", unit="px", low=1, high=64
    )
    coarse: int = setting(3, "iterations at a quarter of the size", low=0, high=50, source=_TRIED)
    middle: int = setting(3, "iterations at half the size", low=0, high=50, source=_TRIED)
    fine: int = setting(2, "iterations at full size", low=0, high=50, source=_TRIED)
    trust: float = setting(
        0.43,
        "half the height of the step expected at the edge: below 0.5, as pixels may err",
        low=0.05,
        high=0.49,
        source="Stoiber et al. 2022",
    )
    steepness: float = setting(
        1.0, "samples over which that step rises", low=0.1, high=5.0, source=_TRIED
    )
    fine_trust: float = setting(
        0.43, "trust at full size", low=0.05, high=0.49, source="Stoiber et al. 2022"
    )
    fine_steepness: float = setting(1.0, "steepness at full size", low=0.1, high=5.0, source=_TRIED)
    mask_trust: float = setting(
        0.49, "trust at full size where masks of every frame are given: these err in places, not "
        "pixel by pixel", low=0.05, high=0.49, source=_TRIED,
    )  # fmt: skip
    mask_steepness: float = setting(
        0.5, "steepness at full size on given masks", low=0.1, high=5.0, source=_TRIED
    )
    mask_fine: int = setting(
        5, "iterations at full size on given masks", low=0, high=50, source=_TRIED
    )
    local: float = setting(
        0.7, "share of the surroundings in the background's colours", low=0.0, high=1.0,
        source=_TRIED,
    )  # fmt: skip
    learning: float = setting(
        0.05, "how much of the colours is renewed in each frame; of limbs, as far as the light has "
        "changed", low=0.0, high=1.0, source=_TRIED,
    )  # fmt: skip
    data_weight: float = setting(
        0.05, "weight of a line, as neighbouring lines say the same", low=1e-4, high=1.0,
        source=_TRIED,
    )  # fmt: skip
    turn_spread: float = setting(
        12.0, "how far a joint may be from its prediction", unit="deg", low=0.1, high=180.0,
        source=_TRIED,
    )  # fmt: skip
    shift_spread: float = setting(
        40.0, "how far the root may be from its prediction", unit="mm", low=0.1, high=1e4,
        source=_TRIED,
    )  # fmt: skip
    rest_spread: float = setting(
        4.0, "how far a joint may be from rest, in multiples of what is usual for it", low=0.1,
        high=1e3, source=_TRIED,
    )  # fmt: skip
    velocity: float = setting(
        0.8, "share of the last step that the prediction goes on by", low=0.0, high=1.0,
        source=_TRIED,
    )  # fmt: skip
    shape_frames: int = setting(
        60, "frames tracked to learn the person's proportions from", low=1, high=10000
    )
    shape_instants: int = setting(
        10, "of these, how many the proportions are fitted to", low=1, high=100
    )
    shape_rounds: int = setting(
        2, "times that is done, each with the proportions found before", low=0, high=10
    )
    recover: bool = setting(
        True, "whether arms and legs held lost are looked for elsewhere", source=_PAPER
    )
    least_support: float = setting(
        0.75,
        "a limb is held lost if less of the evidence along its rim speaks for it, and its gain is "
        "low, too",
        low=0.0,
        high=1.0,
        source="arms put wrong on rendered footage: 0.52 to 0.75; right ones: 0.82 to 0.99",
    )
    least_gain: float = setting(
        1.2,
        "… if its pixels are by less than this likelier the limb's than the background's",
        unit="nats",
        low=-10.0,
        high=10.0,
        source="forearms put wrong: -1.6 to 1.1; right ones: 2.1 to 2.6",
    )
    features: str = setting(
        "colour",
        "what the level set's regions are told apart by",
        choices=("grey", "colour", "texture"),
        source=f"{_PAPER}, 2.1",
    )
    densities: str = setting(
        "limbs",
        "what the coupled method tells person and background apart by: the colours of each limb "
        "and of what lies beside it, learnt from pose to pose; or features of the two regions as a "
        "whole, estimated anew in each image, as the plain level set does",
        choices=("limbs", "regions"),
        source=f"regions: {_PAPER}, 2.1; limbs: {_TRIED}",
    )
    blur: float = setting(
        3.0, "K_σ that smooths the level set's histograms of 256 values", low=0.5, high=50.0,
        source=f"{_PAPER}, 2.1, which gives no value; {_TRIED}",
    )  # fmt: skip
    length: float = setting(
        1.0, "ν, weight of the contour's length", low=0.0, high=100.0,
        source=f"{_PAPER}, equation 2, which gives no value; {_TRIED}",
    )  # fmt: skip
    shape: float = setting(
        0.03, "λ, weight of staying near the projected model", unit="1/px", low=0.0, high=1.0,
        source=f"{_PAPER}, equation 3, which gives no value; {_TRIED}",
    )  # fmt: skip
    shape_term: str = setting(
        "outside",
        "the shape's term of equation 4: outside H'(…), as the energy's derivative is, or inside "
        "it, as printed",
        choices=("outside", "inside"),
        source=_PAPER,
    )
    rounds: int = setting(4, "times the densities are estimated anew", low=1, high=100)
    evolution: int = setting(6, "steps of the contour between two estimates", low=1, high=100)
    margin: int = setting(
        40, "how far around the model the level set looks", unit="px", low=4, high=1000
    )
    alternations: int = setting(
        3, "times the coupled method goes from contour to pose", low=1, high=20
    )
    contour_iterations: int = setting(
        9, "Gauss-Newton steps of the pose on the contours", low=1, high=100
    )
    radius: float = setting(
        30.0, "how far a contour point may be from the rim at first", unit="px", low=1.0, high=500.0
    )

    def for_masks(self) -> "TrackSettings":
        """Return what holds where given masks are followed."""
        return replace(
            self,
            fine_trust=self.mask_trust,
            fine_steepness=self.mask_steepness,
            fine=self.mask_fine,
        )

    def __post_init__(self) -> None:
        check_settings(self)
