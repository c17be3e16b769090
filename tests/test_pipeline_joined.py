"""One trial with one movement of every joint, one with the other: together they tell both axes."""

from dataclasses import replace

import numpy as np
import pytest
from benchmarks.accuracy.one_movement import axis_errors, one_movement
from numpy.testing import assert_allclose, assert_array_equal

from kinesphere.data import motion_from_parameters
from kinesphere.parameterization import parameterize
from kinesphere.pipeline import solve
from kinesphere.pipeline.best_axes import with_best_axes
from kinesphere.pipeline.reuse import calibrated
from kinesphere.synthetic import make_performance

pytestmark = pytest.mark.slow

TOLD = ("neck", "left_shoulder", "left_hip", "right_hip", "left_ankle")
"""Joints of two axes that both trials of this actor tell."""


@pytest.fixture(scope="module")
def performance():
    return make_performance(np.random.default_rng(3), rate=25.0, calibration_s=60.0, free_s=0.0)


def solved(performance, scatter_deg):
    """Return solutions of a trial about the distal and of one about the proximal axes."""
    return {
        name: solve(one_movement(performance, about, scatter_deg, 7 + about), performance.model)
        for about, name in enumerate(("distal", "proximal"))
    }


@pytest.fixture(scope="module")
def alike(performance):
    return solved(performance, 0.0)


def test_both_together_know_each_axis_as_well_as_the_better_one(performance, alike):
    distal, proximal = (alike[name].skeleton for name in ("distal", "proximal"))
    bearing, said = with_best_axes(distal, calibrated(alike))
    assert said == ()
    for name in TOLD:
        assert distal.joint(name).axes_sources == ("movement", "body"), name
        assert proximal.joint(name).axes_sources == ("body", "movement"), name
        both = bearing.joint(name)
        assert both.axes_sources == ("movement", "movement")
        assert both.axes_reused_from == ("distal", "proximal")
        alone = [axis_errors(one, performance, name) for one in (distal, proximal)]
        together = axis_errors(bearing, performance, name)
        assert together[0] == pytest.approx(alone[0][0])
        assert together[1] < alone[1][1] + 0.2
        assert max(together) < 2.5
        assert min(max(one) for one in alone) > 2 * max(together)  # one each is the body's


def test_people_stand_differently_and_markers_tell(performance):
    """A proximal axis is as good in the other trial's frames, which are degrees off its own."""
    told = solved(performance, 4.0)
    distal, proximal = (told[name].skeleton for name in ("distal", "proximal"))
    bearing, _ = with_best_axes(distal, calibrated(told))
    by_name = []
    for name in TOLD:
        both, own = bearing.joint(name), proximal.joint(name)
        assert both.axes_reused_from == ("distal", "proximal")
        assert axis_errors(bearing, performance, name)[1] < 1.5
        as_named = replace(own, axes=np.array([both.axes[0], own.axes[1]]))
        joints = tuple(as_named if j.name == name else j for j in bearing.joints)
        by_name.append(axis_errors(replace(bearing, joints=joints), performance, name)[1])
    assert max(by_name) > 5.0


def test_a_third_recording_is_told_about_both_axes(performance, alike):
    rng = np.random.default_rng(1)
    markers = performance.recording.markers[:120]
    third = replace(performance.recording, markers=markers + 1e-4 * rng.normal(size=markers.shape))
    turned = dict(reversed(alike.items()))
    one, other = (solve(third, performance.model, calibration_from=c) for c in (alike, turned))
    for joint, same in zip(one.skeleton.joints, other.skeleton.joints, strict=True):
        assert_array_equal(joint.axes, same.axes)
        assert_array_equal(joint.rest, same.rest)
    for name in TOLD:
        joint = one.skeleton.joint(name)
        assert joint.axes_sources == ("reused", "reused")
        assert joint.axes_reused_from == ("distal", "proximal")
    found = next(step.findings for step in one.history if step.name == "calibration")
    assert found["recordings"] == ["distal", "proximal"]
    assert found["axes_from"]["left_hip"] == {"axis_1": "distal", "axis_2": "proximal"}
    assert found["axes_from"]["left_knee"] == {"axis_1": "distal"}
    # angles and twists → poses → the same angles and twists
    wanted = np.deg2rad(rng.uniform(5, 25, size=one.parameters.angles.shape))
    wanted[~np.isfinite(one.parameters.angles[:1]).repeat(len(wanted), axis=0)] = np.nan
    twists = np.deg2rad(rng.uniform(-20, 20, size=one.parameters.twists.shape))
    posed = replace(one.parameters, angles=wanted, twists=twists)
    back = parameterize(motion_from_parameters(posed), reuse=one.skeleton)
    for name in TOLD:
        j = one.skeleton.joint_names.index(name)
        assert_allclose(back.angles[:, j, :2], wanted[:, j, :2], atol=1e-9)
        assert_allclose(back.twists[:, j], twists[:, j], atol=1e-9)
