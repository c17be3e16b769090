"""Bodies, trees and names of real recordings whose labels were hidden."""

import re
from dataclasses import replace

import pytest

from kinesphere.io import read
from kinesphere.labelling import built_in_model, match_labels
from kinesphere.skeleton import discover

pytestmark = pytest.mark.real

GAIT = {"RPV": "pelvis", "RTA": "trunk"} | {
    f"{letter}{code}": f"{side}_{limb}"
    for letter, side in (("R", "right"), ("L", "left"))
    for code, limb in (
        *(("TH", "thigh"), ("SK", "shank"), ("FT", "foot"), ("AR", "upper_arm")),
        ("FA", "forearm"),
    )
}
PLATES = ("LB", "PV", "RUA", "LUA", "RFA", "LFA", "RTH", "LTH", "RSH", "LSH")


def found_in(path):
    """Return limb → set of hidden labels, and the discovery."""
    recording = read(path)
    hidden = replace(recording, labels=tuple(f"*{i}" for i in range(recording.n_markers)))
    discovery = discover(hidden)
    limbs = {
        segment.name: {recording.labels[int(label[1:])] for label in segment.markers}
        for segment in discovery.model.segments
    }
    return limbs, discovery


def test_twelve_segments_of_a_walk_are_found_and_named(recordings):
    limbs, discovery = found_in(recordings / "encodings" / "pc_real.c3d")
    for name, labels in limbs.items():
        assert {GAIT[label[:3]] for label in labels} == {name}
        assert len(labels) == 3
    assert len(limbs) == 12
    names = {joint.name for joint in discovery.model.joints}
    assert {"lumbar", "left_hip", "right_knee", "left_ankle", "right_elbow"} <= names


def test_rigid_plates_are_bodies(recordings):
    limbs, discovery = found_in(recordings / "plates" / "KneeltoProne01.c3d")
    bodies = [frozenset(labels) for labels in limbs.values()]
    recording = read(recordings / "plates" / "KneeltoProne01.c3d")
    for plate in PLATES:
        assert frozenset(x for x in recording.labels if x.startswith(plate)) in bodies
    loose = {recording.labels[int(label[1:])] for label in discovery.step.findings["loose"]}
    assert {"RAC", "LAC"} <= loose  # acromia wander by centimetres


def test_an_unlabelled_arm_has_bodies_of_four_two_and_three(recordings):
    limbs, discovery = found_in(recordings / "rigid-bodies" / "arm-4-2-3.c3d")
    assert sorted(len(labels) for labels in limbs.values()) == [2, 3, 4]
    assert len(discovery.model.joints) == 2
    assert all(name.startswith("limb_") for name in limbs)


def test_three_rigid_bodies_are_three(recordings):
    limbs, _ = found_in(recordings / "rigid-bodies" / "walkingOptiTrack.c3d")
    assert {frozenset(label[:4] for label in labels) for labels in limbs.values()} == {
        frozenset({"Foot"}),
        frozenset({"Knee"}),
        frozenset({"Leg_"}),
    }


@pytest.mark.parametrize("trial", ["02_05", "06_01", "85_02", "135_02"])
def test_sparse_markers_of_a_person_give_the_tree_and_no_wrong_name(recordings, trial):
    model = built_in_model("cmu41")
    recording = match_labels(read(recordings / "cmu41" / f"{trial}.c3d"), model)
    own = {label: segment.name for segment in model.segments for label in segment.markers}
    hidden = replace(recording, labels=tuple(f"*{i}" for i in range(recording.n_markers)))
    found = discover(hidden)
    named = 0
    for segment in found.model.segments:
        if segment.name.startswith("limb_"):
            continue
        limbs = [own[recording.labels[int(label[1:])]] for label in segment.markers]
        assert max(set(limbs), key=limbs.count) == segment.name
        named += 1
    assert named >= 11
    assert {"left_hip", "right_hip", "left_knee", "right_knee", "neck", "lumbar"} <= {
        joint.name for joint in found.model.joints
    }


def test_names_of_half_a_recording_are_told_as_likely_only(recordings):
    """Two of them are wrong: the head would be called trunk, a foot shank."""
    recording = match_labels(read(recordings / "cmu41" / "02_05.c3d"), built_in_model("cmu41"))
    hidden = replace(
        recording,
        markers=recording.markers[recording.n_frames // 2 :],
        residuals=None,
        outputs=(),
        analog=None,
        labels=tuple(f"*{i}" for i in range(recording.n_markers)),
    )
    found = discover(hidden)
    assert all(segment.name.startswith("limb_") for segment in found.model.segments)
    assert found.step.findings["names_confidence"] is None
    assert set(found.step.findings["names_from"]["likely_names"].values()) >= {"trunk", "pelvis"}
    assert any("too unsure to be given" in warning for warning in found.step.warnings)


HARDLY = "the markers hardly move against each other"


@pytest.mark.parametrize(
    "name",
    [
        "functional/anatomical_posture",
        "functional/Test_func_anat",
        "plugin-gait/PiG_Calibration-FlatFoot-Full",
        "plugin-gait/pycgm_static",
    ],
)
def test_who_stands_still_is_told_to_tell_nothing(recordings, name):
    found = discover(read(recordings / f"{name}.c3d"))
    assert any(HARDLY in doubt for doubt in found.step.warnings)


@pytest.mark.parametrize("name", ["cmu41/06_01", "functional/Test_func_rankle", "cmu41/02_05"])
def test_who_moves_is_not_told_so_and_doubts_speak_of_limbs_there_are(recordings, name):
    found = discover(read(recordings / f"{name}.c3d"))
    limbs = {segment.name for segment in found.model.segments}
    for doubt in found.step.warnings:
        assert HARDLY not in doubt
        assert set(re.findall(r"limb_\d\d", doubt)) <= limbs


def test_an_upper_half_is_named_where_the_whole_is(recordings):
    """Legs' markers are taken away: everything above keeps its name."""
    whole = read(recordings / "cmu41" / "135_02.c3d")
    leg = re.compile(r".*[LR](THI|KNE|TIB|SHN|ANK|HEE|TOE|MT\d)$")
    keep = [i for i, label in enumerate(whole.labels) if not leg.match(label)]
    above = replace(
        whole,
        markers=whole.markers[:, keep],
        labels=tuple(whole.labels[i] for i in keep),
        residuals=None,
    )
    assert len(keep) == 27
    named, beside = (
        {
            label: segment.name
            for segment in discover(one).model.segments
            for label in segment.markers
        }
        for one in (whole, above)
    )
    assert set(beside.values()) >= {"trunk", "head", "pelvis", "left_forearm", "right_upper_arm"}
    assert not [limb for limb in beside.values() if limb.startswith("limb_")]
    same = [named[label] == limb for label, limb in beside.items() if label in named]
    assert sum(same) >= len(same) - 2  # markers of a shoulder are another limb's
