"""The unlabelled arm of 4, 2 and 3 markers: its limbs are measured together, doubted or not."""

from dataclasses import replace

import numpy as np
import pytest

from kinesphere.io import read
from kinesphere.skeleton import discover, fit_skeleton
from kinesphere.skeleton.settings import SkeletonSettings

pytestmark = pytest.mark.real

WRIST = 0.01  # m between halves, in the hand's plane; limb by limb it is 12 mm off


@pytest.fixture(scope="module")
def found(recordings):
    recording = read(recordings / "rigid-bodies" / "arm-4-2-3.c3d")
    return recording, discover(recording).model


def wrist_reach(recording, model, part, link):
    """Return how far the wrist is from each of the hand's markers, (3,) m."""
    half = replace(recording, markers=np.array(recording.markers[part]))
    skeleton = fit_skeleton(half, model, SkeletonSettings(link_limbs=link)).skeleton
    wrist = skeleton.joint("joint_02")
    hand = skeleton.limb(wrist.child).marker_positions
    return np.linalg.norm(hand - wrist.centre_in_child, axis=1)


def test_halves_of_the_arm_agree_on_the_wrist(found):
    recording, model = found
    assert all(joint.doubtful for joint in model.joints)  # nothing sure beside them
    middle = recording.n_frames // 2
    parts = slice(middle), slice(middle, None)
    apart = {}
    for link in (True, False):
        first, second = (wrist_reach(recording, model, part, link) for part in parts)
        apart[link] = np.linalg.norm(first - second)
    assert apart[True] < min(WRIST, 0.7 * apart[False])
