"""Real walking on other rigs: feet stand, knees bend, nothing leaps; contacts are the vendor's."""

import numpy as np
import pytest
from benchmarks.accuracy.retargeting.contacts import events_of, matched
from benchmarks.accuracy.retargeting.measure import measured
from benchmarks.accuracy.retargeting.rigs import changed, character

from kinesphere import solve
from kinesphere.editing import retarget_motion
from kinesphere.io import read, read_rig, write_on_rig

pytestmark = pytest.mark.real

WALKS = ("cmu41/06_01.c3d", "plugin-gait/PiG_Motion-FlatFoot-Full.c3d")


@pytest.fixture(scope="module", params=WALKS)
def walk(request, recordings):
    solution = solve(read(recordings / request.param))
    return retarget_motion(solution.motion, solution.skeleton)  # gaps bridged, joints held together


@pytest.mark.parametrize("rig", ["20 % shorter", "20 % taller", "other proportions", "t", "a"])
def test_walking_stays_walking(walk, rig):
    own = dict(changed(walk.skeleton))
    skeleton = own[rig] if rig in own else character(rig, 1.15, 1.4)
    row = measured("walk", walk, rig, skeleton, rig in own)
    assert row.n_contacts >= 8
    assert row.slide_most_mm < 1e-6
    assert row.heel_most_mm < 15
    assert row.slide_free_mm > 1
    assert row.arms_deg < 1e-6
    # how straight the walker's knees stand: a leg that is nearly straight turns by degrees for each
    # millimetre it is to be shorter. Hips 20 mm farther forward make it 6.4°, farther back 2.7°
    assert row.legs_deg < 5
    assert row.wrong_knees == 0
    assert row.turn_deg < 1.1 * row.turn_source_deg
    assert row.jerk_deg < 1.1 * row.jerk_source_deg
    assert row.added_deg < 1.5


def test_contacts_are_those_the_vendor_marked(recordings):
    solution = solve(read(recordings / WALKS[1]))
    rows = matched(solution.motion, events_of(solution.recording))
    assert len(rows) >= 8
    strikes = [row.late_s for row in rows if row.what == "Foot Strike"]
    offs = [row.late_s for row in rows if row.what == "Foot Off"]
    assert np.abs(strikes).max() < 0.08
    assert np.abs(offs).max() < 0.16  # toes leave after the ball has risen


def test_cmus_own_rig_walks(recordings, tmp_path):
    rig = recordings / "formats" / "01_01.bvh"
    solution = solve(read(recordings / WALKS[0]))
    done = retarget_motion(solution.motion, read_rig(rig))
    assert write_on_rig(done, rig, tmp_path / "out.bvh") == ()
    back = read(tmp_path / "out.bvh")
    assert np.abs(back.origins - done.origins).max() < 1e-4
    feet = [back.skeleton.limb_names.index(f"{side}Foot") for side in ("Left", "Right")]
    assert -0.01 < back.origins[:, feet, 1].min() < 0.1
