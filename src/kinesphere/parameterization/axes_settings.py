"""What can be chosen about the axes of the parameterization."""

from dataclasses import dataclass

from kinesphere.data import check_settings, setting
from kinesphere.parameterization.per_joint import parse_counts, parse_windows

PAPER = "Sar Dessai, Hornung & Kobbelt 2006"

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
        "turns about itself on purpose; of three asked for, those that no movement tells are put "
        "beside the others",
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
        "at hips, knees, ankles, shoulders, elbows, necks and where nobody named the joint, "
        "1.5 times that; of a hinge three times, where its axis in free motion foretells the "
        "movement clearly better than the body's",
        unit="deg",
        low=0.0,
        high=45.0,
        source="the body's axes are 1-9 deg off at hips and lumbar, 4-26 (16 rms) at knees, 8-37 "
        "at elbows",
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

    def __post_init__(self) -> None:
        check_settings(self)
        parse_counts(self.counts)
        parse_windows(self.windows)
