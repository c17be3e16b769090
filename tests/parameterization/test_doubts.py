"""Which axes are doubted for what is known of them."""

from types import SimpleNamespace

import numpy as np
import pytest
from numpy.testing import assert_array_equal

from kinesphere.parameterization.confidence import AxesQuality
from kinesphere.parameterization.doubts import apart, reasons_to_doubt, uncertain_in_free_motion
from kinesphere.parameterization.reach_report import reach_warnings
from kinesphere.parameterization.report import stage_warnings
from kinesphere.parameterization.settings import AxesSettings

SETTINGS = AxesSettings()
AXIS = np.array([[0.0, 0.0, 1.0]])


def quality(range_deg, halves_deg, reading_deg=0.0, coupled_deg=0.0):
    """Return the quality of one axis."""
    return AxesQuality(
        labels=np.zeros(1, dtype=np.intp),
        ranges=np.deg2rad([range_deg]),
        conditioning=np.array([9.0]),
        explained=1.0,
        halves=np.deg2rad([halves_deg]),
        heights=np.zeros(1),
        readings=np.deg2rad([reading_deg]),
        coupled=np.deg2rad([coupled_deg]),
    )


def swing(range_deg, off_deg):
    """Return directions of a limb that swings about `AXIS` and leaves its plane, rms."""
    t = np.linspace(-0.5, 0.5, 400)
    angles = np.deg2rad(range_deg) * t
    up = np.sqrt(2) * np.deg2rad(off_deg) * np.sin(16 * np.pi * t)
    return np.stack([np.cos(up) * np.sin(angles), -np.cos(up) * np.cos(angles), np.sin(up)], axis=1)


def doubts(range_deg, halves_deg, off_deg=0.0):
    told = quality(range_deg, halves_deg), AXIS, None, swing(range_deg, off_deg), SETTINGS
    return reasons_to_doubt(*told)


@pytest.mark.parametrize(
    ("range_deg", "halves_deg", "doubted"),
    [
        (80.0, 16.0, False),
        (80.0, 21.0, True),
        (20.0, 4.0, False),  # 9.7°, of which skin says 8.6° over the arc and 4° as its share
        (20.0, 12.0, True),  # 11.2°, of which the halves say 6°
        (19.0, 18.0, True),  # 13.4°
        (14.0, 7.0, True),  # one short swing: 13.4°
    ],
)
def test_an_axis_is_doubted_by_the_whole_of_its_uncertainty(range_deg, halves_deg, doubted):
    uncertain = np.rad2deg(quality(range_deg, halves_deg).uncertainty[0])
    assert (uncertain > SETTINGS.largest_uncertainty) == doubted
    assert bool(doubts(range_deg, halves_deg)) == doubted


def test_another_reading_of_the_movement_is_part_of_it():
    told = quality(80.0, 12.0, 9.0), AXIS, None, swing(80.0, 0.0), SETTINGS
    assert np.rad2deg(told[0].uncertainty[0]) == pytest.approx(
        np.sqrt(6**2 + np.rad2deg(3 / 80) ** 2 + np.rad2deg(0.07) ** 2 + 9**2), 1e-3
    )
    (said,) = reasons_to_doubt(*told)
    assert said.startswith("an axis is uncertain by 11.7°")
    assert said.endswith("if the limb twists with the angle, it is 9° off")
    assert "twists" not in doubts(12.5, 12.0)[0]


def test_movement_about_another_axis_is_part_of_it():
    told = quality(80.0, 2.0, coupled_deg=11.0)
    skin = np.hypot(np.rad2deg(3 / 80), np.rad2deg(0.07))
    assert np.rad2deg(told.uncertainty) == pytest.approx([np.sqrt(1 + 11**2 + skin**2)], 1e-3)
    (said,) = reasons_to_doubt(told, AXIS, None, swing(80.0, 0.0), SETTINGS)
    assert said.endswith("movement about another that goes with it can put it 11° off")
    assert told.ordered([0]).coupled == told.coupled
    assert_array_equal(told.only(0, 1).coupled, [np.nan, *told.coupled])


@pytest.mark.parametrize(
    ("range_deg", "off_deg", "doubted"),
    [(80.0, 4.0, False), (20.0, 1.5, False), (20.0, 4.0, True), (20.0, 8.0, True)],
)
def test_a_limb_that_leaves_its_cone_wants_a_wide_movement(range_deg, off_deg, doubted):
    found = doubts(range_deg, 2.0, off_deg)
    assert bool(found) == doubted
    assert not doubted or "leaves the cone" in found[0]


def test_who_loses_axes_is_told_why_and_what_to_do():
    fit = SimpleNamespace(
        source="body",
        doubts=("an axis is uncertain",),
        kept="",
        loose="",
        added="",
        misfit="",
        gave_way="",
        assumed=(),
        half_told=False,
    )
    (said,) = stage_warnings({}, {"right_elbow": fit}, "phase-log-pca")
    assert said.endswith("right_elbow (an axis is uncertain)")
    assert "about one axis at a time" in said
    assert "--calibration-from" in said
    (said,) = stage_warnings({}, {"right_elbow": fit}, "phase-log-pca", reuse=True)
    assert said.endswith("serve instead: right_elbow (an axis is uncertain)")
    assert "move each" not in said


def test_a_kept_axis_is_described_by_what_holds_of_it():
    fit = SimpleNamespace(
        source="movement",
        axes=AXIS,
        doubts=(uncertain_in_free_motion(*np.deg2rad([12.0, 0.5, 9.0])),),
        kept="4.8° instead of 15.2°",
        loose="",
        added="",
        misfit="",
        gave_way="",
        assumed=(),
        half_told=False,
        findings={},
    )
    (said,) = stage_warnings({}, {"left_elbow": fit}, "phase-log-pca")
    assert said.endswith(
        "left_elbow (4.8° instead of 15.2°; the axis of all movement is uncertain by 12.0°; "
        "movement about another that goes with it can put it 9° off)"
    )


def test_that_the_bodys_axes_are_farther_off_is_said_only_where_they_are():
    fit = SimpleNamespace(
        source="movement",
        axes=AXIS,
        doubts=(),
        kept="",
        loose="axes from two halves of the data differ by 15°",
        added="",
        misfit="",
        gave_way="",
        assumed=(),
        half_told=False,
    )
    names = ("lumbar", "left_knee", "right_elbow", "left_hip", "right_ankle", "joint_01")
    plain, kept = stage_warnings({}, dict.fromkeys(names, fit), "phase-log-pca")
    given = f"({fit.loose})"
    assert plain.endswith(f"uncertain by more: lumbar {given}")
    roomy = ", ".join(f"{name} {given}" for name in names[1:])
    assert kept.endswith(f"the body frame's are usually farther off at such joints: {roomy}")


@pytest.mark.parametrize(
    ("share", "source", "said"),
    [
        (0.32, "movement", True),
        (0.2, "movement", False),
        (0.5, "body", True),
        (0.2, "body", False),
        (0.5, "reused", False),
        (None, "movement", False),
    ],
)
def test_a_hinge_whose_limb_is_often_out_of_reach_is_named(share, source, said):
    fits = {"right_elbow": SimpleNamespace(axes=AXIS, source=source)}
    told = reach_warnings(fits, {"right_elbow": {"unreachable": share}}, 2.0)
    assert bool(told) == said
    assert not said or f"right_elbow ({share:.0%} of the frames)" in told[0]
    assert not said or ("body frame's" in told[0]) == (source == "body")


def test_of_several_axes_it_is_said_which_one_halves_contradict():
    halves, ranges = np.deg2rad([3.0, 39.0]), np.deg2rad([30.0, 63.0])
    assert apart(halves, ranges).endswith("differ by 39° about the one whose movement covers 63°")
    assert apart(halves[1:], ranges[1:]).endswith("differ by 39°")
