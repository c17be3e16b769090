"""Of two axes the one that the movement tells, and the other put across it."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation

from kinesphere.data import Step
from kinesphere.errors import BadModel
from kinesphere.geometry.chain import joint_rotations
from kinesphere.parameterization import judged_axes
from kinesphere.parameterization.anatomy import body_axes, n_told
from kinesphere.parameterization.angles import solve_angles
from kinesphere.parameterization.joined import joined
from kinesphere.parameterization.joint import fit_joint
from kinesphere.parameterization.one_of_two import completed
from kinesphere.parameterization.report import stage_warnings
from kinesphere.parameterization.reused import own_or_reused, reused_fit
from kinesphere.parameterization.settings import AxesSettings, ParameterizationSettings
from kinesphere.parameterization.view import view_joint
from kinesphere.synthetic import make_performance

RATE = 50.0
DOWN = np.array([0.0, -1.0, 0.0])
SETTINGS = ParameterizationSettings()


def hip(rng, flexion_deg, abduction_deg, name="left_hip", swings=4, off_deg=8.0, noise_deg=0.3):
    """Return a hip that swings about flexion, then about abduction, and its axes, flexion first."""
    turn = Rotation.from_rotvec(np.deg2rad(off_deg) * np.array([0.6, -0.5, 0.6]))
    axes = turn.apply(body_axes(name)[:2])
    n = round(RATE * 6 * 2 * swings)
    t = np.arange(n) / RATE
    angles = np.zeros((n, 2))
    for i in range(2 * swings):
        during = (t >= 6 * i + 1) & (t < 6 * i + 4)
        reach = np.deg2rad((flexion_deg, abduction_deg)[i // swings])
        angles[during, i // swings] = reach * np.sin(2 * np.pi / 3 * (t[during] - 6 * i - 1))
    noise = Rotation.from_rotvec(np.deg2rad(noise_deg) * rng.normal(size=(n, 3)))
    about = (Rotation.from_rotvec(angles[:, k, None] * axes[k]) for k in (0, 1))
    flexed, abducted = about
    seen = np.ones(n, dtype=bool)
    rotations = (noise * flexed * abducted).as_matrix()
    return view_joint(name, rotations, DOWN, seen, RATE, seen, SETTINGS), axes


def off(a, b):
    return float(np.rad2deg(np.arctan2(np.linalg.norm(np.cross(a, b)), abs(a @ b))))


@pytest.mark.parametrize("name", ["left_hip", "right_hip"])
@pytest.mark.parametrize("little", [0.0, 5.0])
@pytest.mark.parametrize("wide", [0, 1])
def test_the_axis_that_is_moved_about_is_kept(rng, name, little, wide):
    reaches = (40.0, little) if wide == 0 else (little, 40.0)
    view, axes = hip(rng, *reaches, name=name)
    fit = fit_joint(view, SETTINGS)
    at = 1 - wide  # distal first
    assert fit.sources == (("body", "movement") if wide == 0 else ("movement", "body"))
    assert off(fit.axes[at], axes[wide]) < 1.0
    assert fit.axes[at] @ body_axes(name)[wide] > 0
    assert abs(fit.axes[0] @ fit.axes[1]) < 1e-12
    assert np.isnan(fit.uncertainty[1 - at])
    assert off(fit.axes[at], axes[wide]) < np.rad2deg(fit.uncertainty[at]) < 6.0
    assert fit.half_told
    assert fit.doubts
    for figures in ("ranges_deg", "conditioning", "axes_uncertainty_deg"):
        assert [value is None for value in fit.findings[figures]] == [at == 1, at == 0]


def test_all_poses_are_reached_about_both(rng):
    view, _ = hip(rng, 60.0, 6.0)
    fit = fit_joint(view, SETTINGS)
    solved = solve_angles(
        view.rotations,
        fit.axes,
        fit.rest,
        view.long_axis,
        view.twist_known,
        SETTINGS.angles,
        SETTINGS.twist,
        RATE,
    )
    assert np.rad2deg(np.nanmax(solved.excess)) < 1e-6


def test_both_where_both_are_told_and_none_where_none_is(rng):
    assert fit_joint(hip(rng, 40.0, 40.0)[0], SETTINGS).sources == ("movement", "movement")
    assert fit_joint(hip(rng, 5.0, 4.0)[0], SETTINGS).sources == ("body", "body")


def test_one_movement_alone_is_contradicted_by_nothing(rng):
    view, _ = hip(rng, 40.0, 0.0, swings=1)
    assert len(view.samples.phases) == 1
    assert fit_joint(view, SETTINGS).source == "body"


def test_an_axis_far_from_the_body_is_not_kept_alone(rng):
    view, _ = hip(rng, 40.0, 0.0, off_deg=50.0)
    assert fit_joint(view, SETTINGS).source == "body"


@pytest.mark.parametrize(
    ("apart_deg", "arc_deg", "kept"),
    [(82.0, 50.0, False), (82.0, 15.0, True), (25.0, 50.0, False), (11.0, 50.0, True)],
)
def test_halves_that_move_as_far_contradict_an_axis_alone(
    rng, monkeypatch, apart_deg, arc_deg, kept
):
    """However few phases are in one: two axes would confirm each other, and it may lack one."""

    def contradiction(halves, axes, search):
        one = np.ones(len(axes))
        return np.deg2rad(apart_deg * one), np.deg2rad(arc_deg * one), one

    monkeypatch.setattr(judged_axes, "contradiction", contradiction)
    fit = fit_joint(hip(rng, 40.0, 5.0)[0], SETTINGS)  # arcs about flexion of 70°
    assert fit.half_told == kept
    assert fit.source == ("movement" if kept else "body")
    said = f"halves of the time put the axis that is told {apart_deg:.0f}° apart"
    assert kept or said in fit.doubts
    if arc_deg < 35.0:  # half of what the whole moves: such halves judge nothing
        assert np.nanmax(np.rad2deg(fit.uncertainty)) < 6.0
    if apart_deg == 11.0:
        assert fit.loose == "axes from two halves of the data differ by 11°"
        (uncertainty,) = np.rad2deg(fit.uncertainty[np.isfinite(fit.uncertainty)])
        assert 6.5 < uncertainty < 8.0  # 5.5° of halves, 4.7° of skin


def test_whoever_wants_doubtful_axes_gets_both_of_them(rng):
    keep = ParameterizationSettings(axes=AxesSettings(on_doubt="movement"))
    view, _ = hip(rng, 40.0, 6.0)
    fit = fit_joint(view, keep)
    assert "body" not in fit.sources or fit.source == "body"
    assert not fit.half_told


def test_the_other_axis_is_the_bodys_as_far_as_it_lies_across():
    body = body_axes("left_ankle")
    axis = np.array([0.4, 0.86, -0.3])
    axis /= np.linalg.norm(axis)
    both, at = completed(-axis, "left_ankle", np.array([1.0, 0.0, 0.0]))
    assert at == 0  # distal; flexion stays proximal
    assert_allclose(both[0], axis)
    nearest = np.cross(np.cross(axis, body[0]), axis)
    assert_allclose(both[1], nearest / np.linalg.norm(nearest))


def test_nobodys_joint_has_the_other_across_its_limb():
    axis, limb = np.array([0.0, 0.6, 0.8]), np.array([1.0, 0.0, 0.0])
    both, at = completed(axis, "joint_07", limb)
    assert at == 1
    assert_allclose(both @ both.T, np.eye(2), atol=1e-12)
    assert abs(both[0] @ limb) < 1e-12


def test_which_axis_is_put_across_is_said(rng):
    fit = fit_joint(hip(rng, 40.0, 5.0)[0], SETTINGS)
    said = [w for w in stage_warnings({}, {"left_hip": fit}, "phase-log-pca") if "one of two" in w]
    assert len(said) == 1
    assert "left_hip (axis 1: " in said[0]


def test_reused_axes_are_not_doubted_for_what_was_left_out(rng):
    plain = make_performance(rng, calibration_s=0.0, n_frames=3).skeleton
    half = replace(plain.joint("left_hip"), axes_assumed=(True, False), axes_source="movement")
    joints = tuple(half if joint.name == "left_hip" else joint for joint in plain.joints)
    loose = "axes from two halves of the data differ by 12°"
    told = {"doubts": ["an axis is 71° off", "an axis is uncertain", loose], "remark": loose}
    step = Step("parameterization", {}, {"joints": {"left_hip": told}}, (), "0")
    fit = reused_fit("left_hip", replace(plain, joints=joints, history=(step,)))
    [said] = [w for w in stage_warnings({}, {"left_hip": fit}, "phase-log-pca") if "reused" in w]
    assert said.endswith(f": left_hip (axis 2: {loose})")
    whole = replace(half, axes_assumed=())
    joints = tuple(whole if joint.name == "left_hip" else joint for joint in plain.joints)
    fit = reused_fit("left_hip", replace(plain, joints=joints, history=(step,)))
    [said] = stage_warnings({}, {"left_hip": fit}, "phase-log-pca")
    assert "axis 1:" not in said


def test_axes_that_a_movement_told_are_counted(rng):
    skeleton = make_performance(rng, calibration_s=0.0, n_frames=3).skeleton
    hip, elbow = (skeleton.joint(name) for name in ("left_hip", "left_elbow"))
    assert (n_told(hip), n_told(elbow)) == (2, 1)
    assert n_told(hip.without_axes) == 0
    half = replace(hip, axes_assumed=(True, False))
    assert (n_told(half), half.axes_sources) == (1, ("body", "given"))
    assert n_told(replace(hip, axes_source="body")) == 0
    added = replace(elbow, axes=hip.axes, axes_uncertainty=None, axes_assumed=(True, False))
    assert n_told(added) == 1
    for wrong in ((True,), (True, True)):
        with pytest.raises(BadModel, match="left_hip has 2 axes"):
            replace(hip, axes_assumed=wrong)


def test_reused_axes_give_way_to_a_movement_that_tells_more(rng):
    plain = make_performance(rng, calibration_s=0.0, n_frames=3).skeleton
    half = replace(plain.joint("left_hip"), axes_assumed=(False, True), axes_source="movement")
    joints = tuple(half if joint.name == "left_hip" else joint for joint in plain.joints)
    there = replace(plain, joints=joints)
    kept = own_or_reused(hip(rng, 5.0, 4.0)[0], there, SETTINGS)
    assert kept.sources == ("reused", "body")
    assert kept.half_told
    assert own_or_reused(hip(rng, 5.0, 40.0)[0], there, SETTINGS).sources == ("reused", "body")
    both = own_or_reused(hip(rng, 40.0, 40.0)[0], there, SETTINGS)
    assert both.sources == ("movement", "movement")
    assert own_or_reused(hip(rng, 40.0, 40.0)[0], plain, SETTINGS).sources == ("reused", "reused")


@pytest.mark.parametrize("told", [0, 1])
@pytest.mark.parametrize("name", ["left_hip", "right_hip"])
def test_an_axis_from_elsewhere_and_one_from_here_make_a_joint(rng, told, name):
    """One recording told axis ``told``, this one tells the other: poses come back to the bit."""
    reaches = [(6.0, 40.0), (40.0, 6.0)]  # flexion, the proximal axis 1, first
    elsewhere = fit_joint(hip(rng, *reaches[told], name=name)[0], SETTINGS)
    view, axes = hip(rng, *reaches[1 - told], name=name)
    own = fit_joint(view, SETTINGS)
    assert elsewhere.half_told
    assert own.half_told
    plain = make_performance(rng, calibration_s=0.0, n_frames=3).skeleton
    joint = replace(
        plain.joint(name),
        axes=elsewhere.axes,
        rest=elsewhere.rest,
        axes_source="movement",
        axes_assumed=elsewhere.assumed,
        axes_reused_from=tuple("" if across else "t" for across in elsewhere.assumed),
        axes_uncertainty=elsewhere.uncertainty,
    )
    step = Step("parameterization", findings={"joints": {name: elsewhere.findings}})
    joints = tuple(joint if j.name == name else j for j in plain.joints)
    there = replace(plain, joints=joints, history=(step,))
    both = own_or_reused(view, there, SETTINGS)
    expected = ("reused", "movement") if told == 0 else ("movement", "reused")
    assert both.sources == expected
    assert both.reused_from == (("t", "") if told == 0 else ("", "t"))
    assert not both.half_told
    assert both.assumed == ()
    assert np.isfinite(both.uncertainty).all()
    for k in (0, 1):
        assert off(both.axes[k], axes[1 - k]) < 1.0
        assert both.axes[k] @ body_axes(name)[1 - k] > 0
    assert both.findings["axes_apart_deg"] == pytest.approx([off(*both.axes)])
    assert all(isinstance(value, float) for value in both.findings["ranges_deg"])
    # parameters → poses → parameters
    wanted = np.deg2rad(rng.uniform(-25, 25, size=(200, 3)))
    angles = np.c_[wanted[:, :2], np.full(200, np.nan)]
    poses = joint_rotations(both.axes, both.rest, DOWN, angles, wanted[:, 2])
    seen = np.ones(200, dtype=bool)
    back = solve_angles(
        poses, both.axes, both.rest, DOWN, seen, SETTINGS.angles, SETTINGS.twist, RATE
    )
    assert_allclose(back.angles[:, :2], wanted[:, :2], atol=1e-9)
    assert_allclose(back.twists, wanted[:, 2], atol=1e-9)


def test_two_axes_that_are_nearly_one_are_not_put_together(rng):
    elsewhere = fit_joint(hip(rng, 6.0, 40.0)[0], SETTINGS)
    own = fit_joint(hip(rng, 40.0, 6.0)[0], SETTINGS)
    assert joined(elsewhere, own, 1, 1, np.deg2rad(20.0)) is not None
    near = replace(own, axes=np.array([own.axes[0], elsewhere.axes[0]]))
    assert joined(elsewhere, near, 1, 1, np.deg2rad(20.0)) is None
