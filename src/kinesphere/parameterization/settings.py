"""What can be chosen about the parameterization, one group of settings for each of its steps."""

from dataclasses import dataclass, field, fields

from kinesphere.data import Json, check_settings, setting, settings_as_json
from kinesphere.errors import BadSetting
from kinesphere.parameterization.per_joint import parse_counts, parse_windows

PAPER = "Sar Dessai, Hornung & Kobbelt 2006"


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
        "threshold speed where the histogram has no valley",
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


HINGE = 1.5  # times as uncertain may the axis of a hinge be: the body's is 16° off at knees
AXES_METHODS = (
    "phase-log-pca",
    "direction-joining",
    "pca",
    "em",
    "em-restarts",
    "sara",
    "small-circle",
    "universal-joint",
)


@dataclass(frozen=True)
class AxesSettings:
    """How the axes a limb moves about are found (paper section 4.2)."""

    method: str = setting(
        "phase-log-pca",
        "axis extraction; 'body' takes the axes of the body frame",
        choices=(*AXES_METHODS, "body"),
        source=f"{PAPER}, section 4.2: pca, em, direction-joining",
    )
    counts: str = setting(
        "",
        "number of axes by joint, e.g. 'left_wrist=1, hip=2'; a name without side means both; "
        "others by the joint's name, or by the data where it has none, and a third where the limb "
        "turns about itself on purpose",
    )
    windows: str = setting(
        "",
        "where in time a joint does its main movements, in s, e.g. 'left_hip=0:12, knee=12:24'; "
        "a name without side means both; others take the whole calibration",
    )
    refine: bool = setting(
        True,
        "make the axes of 'phase-log-pca' and 'sara' robust to twist",
        source="10 deg of twist while moving: axis error 3.2 deg without, 0.3 deg with it",
    )
    purest: float = setting(
        0.9,
        "share of a phase's movement about one axis that makes it a main movement; where such "
        "phases are there for every axis, the others are left out",
        low=0.5,
        high=1.0,
    )
    on_doubt: str = setting(
        "body",
        "what serves where the main movements are missing: body axes, or the doubtful ones",
        choices=("body", "movement"),
    )
    largest_disagreement: float = setting(
        10.0,
        "angle between axes from two halves of the data, from which on that is said",
        unit="deg",
        low=0.0,
        high=90.0,
    )
    largest_uncertainty: float = setting(
        10.0,
        "standard deviation of an axis, half of that angle, from which on the body's axis serves; "
        "of a hinge, whose axis the body's tells less well, 1.5 times that, and three times, where "
        "its axis in free motion foretells the movement clearly better than the body's",
        unit="deg",
        low=0.0,
        high=45.0,
        source="the body's axes are 3-6 deg from those of hips and lumbar, 4-26 from those of knees "
        "(16 rms), 8-37 from those of elbows",
    )
    smallest_range: float = setting(
        12.0,
        "range of motion about an axis, below which it is doubted",
        unit="deg",
        low=0.0,
        high=180.0,
        source="at 15-20 deg and 3 deg of correlated noise every estimator fails",
    )
    smallest_explained: float = setting(
        0.8,
        "share of the movement that rotations about one axis at a time must explain",
        low=0.0,
        high=1.0,
        source="main movements 0.9 and more, free motion 0.5-0.8",
    )
    largest_spread: float = setting(
        10.0,
        "how far a limb may leave the cone about its only axis, rms over the calibration",
        unit="deg",
        low=0.0,
        high=90.0,
        source="functional knees 1-2 deg, walking knees 2-4, wrong elbow axes 15-25",
    )
    smallest_angle: float = setting(
        20.0, "two axes closer than this are one", unit="deg", low=0.0, high=90.0
    )
    farthest: float = setting(
        50.0,
        "angle to the body's axis, from which on the axis of a named joint is doubted",
        unit="deg",
        low=0.0,
        high=90.0,
        source="an arm held still while the shoulder turns looks like an elbow 75-90 deg off",
    )
    joining_angle: float = setting(
        15.0,
        "delta of Direction Joining",
        unit="deg",
        low=1.0,
        high=60.0,
        source=f"{PAPER}, section 4.2",
    )
    cell: float = setting(
        5.0,
        "size of a stratification cell on the joint sphere",
        unit="deg",
        low=0.5,
        high=30.0,
        source="the paper names none; 5-10 deg make no difference on smoothed data",
    )
    restarts: int = setting(30, "random starts of 'em-restarts'", low=1, high=1000)

    def largest_of(self, n_axes: int) -> float:
        """Return the standard deviation in deg from which on an axis of so many is doubted."""
        return self.largest_uncertainty * (HINGE if n_axes == 1 else 1.0)

    def __post_init__(self) -> None:
        check_settings(self)
        parse_counts(self.counts)
        parse_windows(self.windows)


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
