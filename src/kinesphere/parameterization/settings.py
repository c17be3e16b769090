"""What can be chosen about the parameterization, one group of settings for each of its steps."""

from dataclasses import dataclass, field, fields

from kinesphere.data import Json, check_settings, setting, settings_as_json
from kinesphere.errors import BadSetting
from kinesphere.parameterization.axes_settings import PAPER
from kinesphere.parameterization.axes_settings import AxesSettings as AxesSettings


@dataclass(frozen=True)
class FilterSettings:
    """How moving and stationary phases are told apart (paper section 4.1)."""

    method: str = setting(
        "bounded-valley",
        "how the threshold speed is found",
        choices=("bounded-valley", "log-speed", "paper"),
        source=f"{PAPER}, section 4.1 for 'paper'; the other two are measured rules",
    )
    window: float = setting(
        0.2,
        "time over which a speed is taken (not by 'paper')",
        unit="s",
        low=0.01,
        high=2.0,
        source="recordings run from 12 to 300 Hz: never frames",
    )
    cutoff: float = setting(
        4.0,
        "low-pass of the orientations the axes are found from; 0 for none (never by 'paper')",
        unit="Hz",
        low=0.0,
        high=50.0,
        source="zero phase, calibration only; delivered angles are never smoothed",
    )
    slowest: float = setting(
        4.0, "lowest threshold speed of 'bounded-valley'", unit="deg/s", low=0.0, high=1000.0
    )
    fastest: float = setting(
        60.0, "highest threshold speed of 'bounded-valley'", unit="deg/s", low=0.0, high=1000.0
    )
    fallback: float = setting(
        12.6,
        "threshold speed where the histogram has no valley; where hardly anything passes it, yet "
        "the limb goes as far as an axis needs, it comes down to three times the speed of noise "
        "(not by 'paper')",
        unit="deg/s",
        low=0.0,
        high=1000.0,
        source="middle of 4 and 40 deg/s on a logarithmic scale; measured on real recordings",
    )
    bridge: float = setting(
        0.24, "shorter rests inside a movement belong to it (not by 'paper')", unit="s", low=0.0
    )
    shortest: float = setting(
        0.16, "shorter movements are none (not by 'paper')", unit="s", low=0.0
    )

    def __post_init__(self) -> None:
        check_settings(self)
        if self.slowest >= self.fastest:
            raise BadSetting(
                f"slowest is {self.slowest} deg/s; it must be below fastest, {self.fastest} deg/s"
            )


@dataclass(frozen=True)
class RestSettings:
    """Where all angles are zero (paper section 4.3)."""

    method: str = setting(
        "robust",
        "rest orientation: mean of slow samples, or the paper's single nearest sample",
        choices=("robust", "paper"),
        source=f"{PAPER}, section 4.3 for 'paper'",
    )
    zero: str = setting(
        "anatomical",
        "zero of a one-axis joint: limb aligned with the body frame, or the samples' middle",
        choices=("anatomical", "centre-of-gravity"),
    )
    radius: float = setting(
        5.0, "samples this close to the rest position are averaged", unit="deg", low=0.1, high=45.0
    )

    def __post_init__(self) -> None:
        check_settings(self)


@dataclass(frozen=True)
class AngleSettings:
    """How the angles about the axes are chosen (paper section 4.4)."""

    branch: str = setting(
        "viterbi",
        "which of the two solutions counts: the smoothest path, the rest position's side, or "
        "the smaller twist",
        choices=("viterbi", "default-sign", "smallest-twist"),
        source=f"{PAPER}, section 4.4, 'a smooth and valid limb trajectory'; Viterbi 1967",
    )
    twist_cost: float = setting(
        0.1, "weight of the squared twist in 'viterbi'", unit="1/rad", low=0.0, high=10.0
    )
    unreachable: float = setting(
        2.0, "a limb farther than this from its reach is flagged", unit="deg", low=0.0, high=90.0
    )
    singular: float = setting(
        5.0, "a limb closer than this to the axes' plane is flagged", unit="deg", low=0.0, high=90.0
    )
    unwrap: bool = setting(
        False,
        "deliver angles and twists that run on beyond a half turn, for limbs that turn on and on, "
        "instead of jumping from 180 to -180 deg; poses are the same, but the size of a twist no "
        "longer tells the branches apart: under soft tissue in swings of 140 deg a quarter of the "
        "frames of a joint can be half a turn off",
    )

    def __post_init__(self) -> None:
        check_settings(self)


@dataclass(frozen=True)
class TwistSettings:
    """How the twist about the limb is found (paper section 4.5)."""

    method: str = setting(
        "closed-form",
        "the exact least-squares twist, or the paper's sampling",
        choices=("closed-form", "sampled"),
        source=f"{PAPER}, section 4.5 for 'sampled'",
    )
    step: float = setting(1.0, "step of 'sampled'", unit="deg", low=0.01, high=30.0)

    def __post_init__(self) -> None:
        check_settings(self)


@dataclass(frozen=True)
class ParameterizationSettings:
    """Everything that can be chosen about the parameterization."""

    filter: FilterSettings = field(default_factory=FilterSettings)
    axes: AxesSettings = field(default_factory=AxesSettings)
    rest: RestSettings = field(default_factory=RestSettings)
    angles: AngleSettings = field(default_factory=AngleSettings)
    twist: TwistSettings = field(default_factory=TwistSettings)

    def as_json(self) -> dict[str, Json]:
        """Return every setting as ``group.key``, the way the command line addresses it."""
        return {
            f"{group.name}.{key}": value
            for group in fields(self)
            for key, value in settings_as_json(getattr(self, group.name)).items()
        }
