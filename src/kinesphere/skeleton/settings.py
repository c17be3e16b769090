"""What may be chosen when the skeleton is measured."""

from dataclasses import dataclass

from kinesphere.data import check_settings, setting


@dataclass(frozen=True)
class SkeletonSettings:
    """Settings of the stage ``skeleton``; lengths here are in the units people read."""

    sample_frames: int = setting(
        600,
        "frames that shapes and joint centres are measured on, half spread evenly over time, half "
        "over what the joints do",
        low=10,
        high=100_000,
        source="more frames change joint centres by less than their uncertainty",
    )
    outlier_mm: float = setting(
        3.0,
        "residual at which a sighting within its limb starts to be doubted",
        unit="mm",
        low=0.01,
        high=1000.0,
    )
    min_spread_mm: float = setting(
        8.0,
        "least extent of a limb's markers beside a line for them to give an orientation",
        unit="mm",
        low=0.01,
        high=1000.0,
    )
    soft_tissue: float = setting(
        3.0,
        "how many times larger errors are that move with the pose, and that a joint centre's fit "
        "absorbs, than those it leaves as residuals",
        low=1.0,
        high=100.0,
        source="centres of one person from nine functional trials differ by about four times what "
        "their residuals predict",
    )
    hinge: float = setting(
        10.0,
        "how many times tighter a landmark holds a hinge's centre along its axis than across",
        low=1.0,
        high=1000.0,
        source="on 41-marker recordings elbows and knees end up at the lateral marker without it",
    )
    undetermined_mm: float = setting(
        20.0,
        "a joint centre that motion alone knows worse than this in a direction is open there",
        unit="mm",
        low=0.1,
        high=1000.0,
        source="regression estimates of the hip have spreads of 15 to 25 mm",
    )
    min_range_deg: float = setting(
        15.0,
        "a joint that moves less than this leaves its centre undetermined",
        unit="deg",
        low=0.0,
        high=180.0,
        source="Ehrig et al. 2006, doi:10.1016/j.jbiomech.2005.10.002: errors of every method grow "
        "steeply below 20 degrees",
    )
    flexed_deg: float = setting(
        20.0,
        "flexion above which a hinge tells its axis and a limb may borrow its twist",
        unit="deg",
        low=5.0,
        high=90.0,
    )
    fill_gap_s: float = setting(
        0.5,
        "longest gap of a limb's pose that is bridged from its neighbours in time",
        unit="s",
        low=0.0,
        high=10.0,
    )
    link_limbs: bool = setting(
        True,
        "fit limbs without a pose of their own together with the limbs on either side, where no "
        "landmark tells their joints",
    )
    even_hips_mm: float = setting(
        0.0,
        "of people known to be even: how unlike a hip and the other one's mirror image in the "
        "pelvis' markers may be, in each direction, say 7; 0 leaves both to themselves",
        unit="mm",
        low=0.0,
        high=1000.0,
        source="5 mm of either marker of a pair shift and tilt the plane by 5 and 4 mm at the hip, "
        "beside a few mm that people's sides differ by",
    )
    weigh_anatomy: bool = setting(
        True,
        "weigh hips by the motion with where the pelvis' spines have them, each as sure as it is; "
        "false leaves to anatomy what motion leaves open: for hips unlike other people's",
        source="Harrington et al. 2007, doi:10.1016/j.jbiomech.2006.02.003: regression within 3 to "
        "5 mm in each direction; with skin and markers 8 to 9",
    )
    adopt_markers: bool = setting(
        True, "let markers the model does not know join the limb they are rigid with"
    )
    adopt_mm: float = setting(
        8.0,
        "most a marker may wander in a limb, rms, to be adopted by it",
        unit="mm",
        low=0.01,
        high=100.0,
    )

    fill_markers: bool = setting(
        False,
        "put hidden markers where their limb's pose says they are, in the recording that is "
        "written",
    )

    def __post_init__(self) -> None:
        check_settings(self)
