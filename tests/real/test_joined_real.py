"""Functional trials of one person: each joint from its own trial, contradictions told."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from kinesphere.io import read
from kinesphere.pipeline import solve
from kinesphere.pipeline.best_axes import with_best_axes
from kinesphere.pipeline.frames_apart import turn_between
from kinesphere.pipeline.reuse import calibrated

pytestmark = [pytest.mark.real, pytest.mark.slow]


@pytest.fixture(scope="module")
def trials(recordings):
    folder = recordings / "functional"
    names = ("lknee", "rknee", "lankle")
    return {name: solve(read(folder / f"Test_func_{name}.c3d")) for name in names}


def test_each_knee_is_from_its_own_trial(trials):
    skeleton = trials["lankle"].skeleton
    bearing, said = with_best_axes(skeleton, calibrated(trials))
    moved = []
    for side in ("left", "right"):
        knee = bearing.joint(f"{side}_knee")
        own = trials[f"{side[0]}knee"].skeleton.joint(knee.name)
        assert knee.axes_reused_from == (f"{side[0]}knee",)
        there = trials[f"{side[0]}knee"].skeleton
        thigh, shank = (
            turn_between(skeleton.limb(limb), there.limb(limb)).rotation
            for limb in (f"{side}_thigh", f"{side}_shank")
        )
        assert_allclose(knee.axes, own.axes @ thigh.T, atol=1e-12)
        assert_allclose(knee.rest, thigh @ own.rest @ shank.T, atol=1e-12)
        moved.append(np.linalg.norm(knee.axes - own.axes))
    assert max(moved) > np.sin(np.deg2rad(3.0))  # frames of one name do differ
    # a squat's short arc and skin put the right knee's axis elsewhere; the left one's agrees
    assert [clause for clause in said if "knee (" in clause] == [
        clause for clause in said if clause.startswith("right_knee (")
    ]
    assert any("between rknee, which serves, and lankle" in clause for clause in said)


def test_markers_bring_knees_of_two_trials_nearer(trials):
    """The thigh's default position differs by degrees between trials, its markers do not move."""
    by_name, by_markers = [], []
    for side, own in (("left", "lknee"), ("right", "rknee")):
        one, other = (trials[name].skeleton for name in (own, "lankle"))
        thighs = (each.limb(f"{side}_thigh") for each in (one, other))
        turn = turn_between(*thighs)
        assert 0 < turn.unsure < np.deg2rad(4.0)
        a, b = (each.joint(f"{side}_knee").axes[0] for each in (one, other))
        by_name.append(np.arccos(abs(a @ b)))
        by_markers.append(np.arccos(abs(a @ turn.rotation @ b)))
    assert np.all(np.array(by_markers) <= np.array(by_name))
    assert by_name[1] - by_markers[1] > np.deg2rad(3.0)
