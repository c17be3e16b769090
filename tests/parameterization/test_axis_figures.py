"""What is told of a joint axis by axis: as many figures as axes, each at the axis it is about."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from kinesphere.data import Step
from kinesphere.parameterization.axis_figures import PER_AXIS, nearest_places, with_places
from kinesphere.parameterization.joined import joined
from kinesphere.parameterization.joint import fit_joint
from kinesphere.parameterization.reused import reused_fit
from kinesphere.parameterization.settings import AxesSettings, ParameterizationSettings
from kinesphere.parameterization.third_axis import fit_axes
from kinesphere.parameterization.view import view_joint
from kinesphere.synthetic import make_performance

RATE = 25.0
LIMB = np.array([0.0, -1.0, 0.0])
DEFAULTS = ParameterizationSettings()
# every hinge leaves its cone by more than nothing, which casts doubt on it, too
SPREAD = ParameterizationSettings(axes=AxesSettings(largest_spread=0.0, on_doubt="movement"))


def swings(rng, *, bends, turns=(), noise_deg=0.1):
    """Return rotations of a limb at rest, then bent about z by degrees, then turned about itself.

    Each of them in two seconds to and fro, with two of rest before; bent by 50° while it turns.
    """
    wave = np.concatenate([np.zeros(50), np.sin(np.linspace(0, 2 * np.pi, 50))])
    bent = [wave * degrees for degrees in bends]
    held = [np.full(100, 50.0) for _ in turns]
    flexed = np.concatenate([*bent, *held])
    turned = np.concatenate([np.zeros(100 * len(bends)), *(wave * degrees for degrees in turns)])
    bell = np.hanning(21) / np.hanning(21).sum()
    flexed = np.convolve(np.pad(flexed, 10, mode="edge"), bell, mode="valid")
    shake = Rotation.from_rotvec(np.deg2rad(noise_deg) * rng.normal(size=(len(flexed), 3)))
    about_z = Rotation.from_rotvec(np.outer(np.deg2rad(flexed), [0.0, 0.0, 1.0]))
    about_limb = Rotation.from_rotvec(np.outer(np.deg2rad(turned), LIMB))
    return (shake * about_z * about_limb).as_matrix()


def view(rotations, name, settings=SPREAD):
    every = np.ones(len(rotations), dtype=bool)
    return view_joint(name, rotations, LIMB, every, RATE, every, settings)


def figures(fit):
    return [fit.findings[name] for name in (*PER_AXIS, "axes_uncertainty_deg")]


def assert_as_many_as_axes(fit, n_axes):
    assert len(fit.axes) == n_axes
    assert [len(values) for values in figures(fit)] == [n_axes] * (len(PER_AXIS) + 1)


def test_a_hinge_that_was_given_a_second_axis_tells_its_own_figures_at_its_own_place(rng):
    rotations = swings(rng, bends=[60.0] * 6)
    hinge = fit_axes(view(rotations, "left_knee"), DEFAULTS)
    both = fit_axes(view(rotations, "left_knee"), SPREAD)
    assert both.source == "movement"
    assert both.added
    assert_as_many_as_axes(hinge, 1)
    assert_as_many_as_axes(both, 2)
    assert np.abs(both.axes[1] @ hinge.axes[0]) == pytest.approx(1.0, abs=1e-12)
    for one, two in zip(figures(hinge), figures(both), strict=True):
        assert two == [None, one[0]]


def test_three_axes_of_a_hinge_have_three_figures(rng):
    rotations = swings(rng, bends=[-40.0] * 3, turns=[35.0] * 3)
    fit = fit_axes(view(rotations, "left_elbow", DEFAULTS), DEFAULTS)
    assert_as_many_as_axes(fit, 3)
    assert [value is None for value in fit.findings["ranges_deg"]] == [False, True, False]
    assert fit.findings["ranges_deg"][0] == pytest.approx(70.0, abs=8)


@pytest.mark.parametrize("name", ["left_hip", "left_knee", "somewhere"])
@pytest.mark.parametrize("bends", [(), (60.0,) * 6])
def test_of_axes_of_the_body_there_are_as_many_figures(rng, name, bends):
    """Where no movement tells any, and where only one of two is moved about, and that contradicts.

    What was found does not serve, but is told where the axis is that serves in its place.
    """
    body = ParameterizationSettings(axes=AxesSettings(on_doubt="body", largest_uncertainty=0.01))
    still = np.tile(np.eye(3), (200, 1, 1))
    rotations = swings(rng, bends=bends) if bends else still
    fit = fit_joint(view(rotations, name, body), body, 1 if name == "left_knee" else 2)
    assert fit.source == "body"
    assert_as_many_as_axes(fit, len(fit.axes))
    if bends:
        flexion = [float(np.abs(axis @ [0.0, 0.0, 1.0])) > 0.9 for axis in fit.axes]
        assert [value is not None for value in fit.findings["ranges_deg"]] == flexion
    else:
        assert figures(fit) == [[None] * len(fit.axes)] * (len(PER_AXIS) + 1)


def test_figures_of_reused_axes_are_as_many(rng):
    fit = fit_axes(view(swings(rng, bends=[60.0] * 6), "left_knee"), SPREAD)
    plain = make_performance(rng, calibration_s=0.0, n_frames=3).skeleton
    knee = replace(
        plain.joint("left_knee"),
        axes=fit.axes,
        rest=fit.rest,
        axes_source=fit.source,
        axes_assumed=fit.assumed,
        axes_uncertainty=fit.uncertainty,
    )
    joints = tuple(knee if joint.name == knee.name else joint for joint in plain.joints)
    step = Step("parameterization", findings={"joints": {"left_knee": fit.findings}})
    again = reused_fit("left_knee", replace(plain, joints=joints, history=(step,)))
    assert figures(again) == figures(fit)
    assert_as_many_as_axes(again, 2)


def test_of_an_axis_from_elsewhere_all_that_is_told_is_from_there(rng):
    base, donor = (
        fit_joint(view(swings(rng, bends=[60.0] * 6), "left_knee"), SPREAD) for _ in range(2)
    )
    both = joined(base, donor, 1, 1, np.deg2rad(10.0))
    for name in PER_AXIS:
        assert both.findings[name] == [None, donor.findings[name][1]]
        assert base.findings[name][1] is None or both.findings[name] != base.findings[name]


def test_places_are_those_of_the_nearest_axes():
    serving = np.eye(3)[[0, 2]]
    near = np.array([[-0.1, 0.0, -0.995]])
    assert nearest_places(near, serving) == [1]
    assert nearest_places(np.array([[0.6, 0.0, 0.8], [0.0, 0.3, 0.95]]), serving) == [0, 1]
    assert nearest_places(np.empty((0, 3)), serving) == []
    listed = with_places({"ranges_deg": [7.0], "explained": 0.5}, [1], 2)
    assert listed["ranges_deg"] == [None, 7.0]
    assert listed["explained"] == 0.5
    assert listed["alike_deg"] == [None, None]
