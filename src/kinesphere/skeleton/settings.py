"""What may be chosen when the skeleton is measured."""

from dataclasses import dataclass

from kinesphere.data import check_settings, setting


@dataclass(frozen=True)
class SkeletonSettings:
    """Settings of the stage ``skeleton``; lengths here are in the units people read."""

    sample_frames: int = setting(
        800,
        "frames that shapes and joint centres are measured on, spread evenly over the way the "
        "markers travel",
        low=10,
        high=100_000,
        source="800 frames give the centres of 24,000 to 0.1 mm on synthetic motion",
    )
    outlier_mm: float = setting(
        3.0,
        "residual at which a sighting within its limb starts to be doubted",
        unit="mm",
        low=0.01,
        high=1000.0,
    )
    min_spread_mm: float = setting(
        5.0,
        "least extent of a limb's markers beside a line for them to give an orientation",
        unit="mm",
        low=0.01,
        high=1000.0,
    )
    undetermined_mm: float = setting(
        10.0,
        "a joint centre that motion alone knows worse than this in a direction counts as open there",
        unit="mm",
        low=0.1,
        high=1000.0,
        source="half the spread of regression estimates of the hip, Harrington et al. 2007, "
        "doi:10.1016/j.jbiomech.2006.02.003",
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
        "flexion above which a hinge tells the direction of its axis and a limb may borrow its twist",
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

    def __post_init__(self) -> None:
        check_settings(self)
