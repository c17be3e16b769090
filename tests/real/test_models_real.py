"""Real recordings: the right layout, the right person, the right way up, whatever the export."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

import kinesphere as ks
from kinesphere.data import Recording
from kinesphere.errors import BadRecording
from kinesphere.labelling import choose_model, find_subjects, match_labels
from kinesphere.quality import check_recording, orient

pytestmark = pytest.mark.real

FULL_BODY = {
    # file: (model, subject, required labels that are missing, up in the file)
    "cmu41/02_05.c3d": ("cmu41", "TakeoMonday", [], "+z"),
    "cmu41/06_01.c3d": ("cmu41", "Justin", [], "+z"),
    "cmu41/85_02.c3d": ("cmu41", "Male", [], "+z"),
    "cmu41/135_02.c3d": ("cmu41", "male", [], "+z"),
    "plugin-gait/PiG_Calibration-FlatFoot-Full.c3d": ("plugin-gait", "", [], "+z"),
    "plugin-gait/PiG_Motion-FlatFoot-Full.c3d": ("plugin-gait", "", [], "+z"),
    "plugin-gait/pycgm_movement.c3d": ("plugin-gait", "", [], "+z"),
    "plugin-gait/pycgm_static.c3d": ("plugin-gait", "", [], "+z"),
    "functional/Test_func_anat.c3d": ("plugin-gait", "", ["RBHD"], "-z"),
    "functional/Test_func_lankle.c3d": ("plugin-gait", "", [], "-z"),
    "functional/Test_func_lhip.c3d": ("plugin-gait", "", [], "-z"),
    "functional/Test_func_lknee.c3d": ("plugin-gait", "", [], "-z"),
    "functional/Test_func_rankle.c3d": ("plugin-gait", "", [], "-z"),
    "functional/Test_func_rhip.c3d": ("plugin-gait", "", [], "-z"),
    "functional/Test_func_rknee.c3d": ("plugin-gait", "", [], "-z"),
    "functional/Test_func_trunk.c3d": ("plugin-gait", "", ["LHEE", "RHEE"], "-z"),
    "functional/anatomical_posture.c3d": ("plugin-gait", "", [], "-z"),
}
OTHERS = {
    # file: (up in the file, who says so)
    "formats/squat.c3d": ("+y", "body"),
    "plates/KneeltoProne01.c3d": ("+z", "body"),
    "encodings/Qualisys.c3d": ("+z", "body"),
    "encodings/TYPE-2a.c3d": ("+z", "file"),
    "encodings/pc_real.c3d": ("+z", "file"),
    "encodings/sub_labels.c3d": ("+z", "file"),
    "rigid-bodies/arm-4-2-3.c3d": ("+z", "file"),
    "rigid-bodies/walkingOptiTrack.c3d": ("+z", "file"),
    "formats/gait10dof18musc_walk_CRLF_line_ending.trc": ("+y", "body"),
    "formats/dataWithBlanksForMissingMarkers.trc": ("+z", "body"),
    "formats/dataWithNaNsWithSpaces.trc": ("+y", "body"),
}
WAIST = {
    "cmu41": ("LFWT", "RFWT", "LFWT", "LBWT"),
    "plugin-gait": ("LASI", "RASI", "LASI", "LPSI"),
}
LYING_ABOUT = {"cmu41/85_02.c3d": 0.8, "formats/squat.c3d": 0.9}
"""Share of frames with the head above the feet; elsewhere all of them."""


@pytest.fixture(scope="module")
def read(recordings):
    known = {}

    def read(name):
        if name not in known:
            known[name] = ks.read(recordings / name)
        return known[name]

    return read


def step(recording):
    return recording.history[-1]


def solved(recording, subject=None):
    """Return a recording as the line hands it to the skeleton, and its model."""
    model = choose_model(recording, subject)
    return orient(match_labels(recording, model, subject), model), model


def height(recording, *labels):
    return np.nanmean(recording.markers[:, recording.columns(labels), 1], axis=1)


@pytest.mark.parametrize("name", FULL_BODY)
def test_layout_and_person(read, name):
    model_name, subject, missing, _ = FULL_BODY[name]
    recording = read(name)
    model = choose_model(recording)
    assert model.name == model_name
    assert find_subjects(recording) == ((subject,) if subject else ())
    matched = match_labels(recording, model)
    found = step(matched).findings
    assert (found["subject"], found["missing"]) == (subject, missing)
    assert step(matched).warnings == ()
    assert matched.n_markers == recording.n_markers
    assert_array_equal(matched.markers, recording.markers)


@pytest.mark.parametrize("name", OTHERS)
def test_other_layouts_are_not_mistaken(read, name):
    assert choose_model(read(name)) is None


@pytest.mark.parametrize("name", FULL_BODY)
def test_a_person_stands_in_a_right_handed_world(read, name):
    *_, up = FULL_BODY[name]
    recording = read(name)
    world, _ = solved(recording)
    found = step(world).findings
    assert (found["up"], found["mirrored"]) == (up, False)
    assert found["right_handed_share"] > 0.99
    above = height(world, "LFHD", "RFHD") - height(world, "LANK", "RANK")
    assert np.mean(above[np.isfinite(above)] > 0.9) >= LYING_ABOUT.get(name, 1.0)
    # the pelvis: (left to right) × (back to front) points up
    waist = WAIST[FULL_BODY[name][0]]
    left, right, front, back = (world.markers[:, world.columns((label,))[0]] for label in waist)
    turned = np.cross(right - left, front - back)[:, 1]
    known = np.isfinite(turned) & np.isfinite(above)
    assert np.mean(turned[known & (above > 1.0)] > 0) > 0.99


@pytest.mark.parametrize("name", [*FULL_BODY, *OTHERS, "video/pose2sim/Balancing_for_IK.trc"])
def test_every_part_of_the_body_is_the_right_way_round(read, name):
    found = check_recording(read(name))
    assert [f.what for f in found if f.rule in ("sides", "heels")] == []


@pytest.mark.parametrize("name", FULL_BODY)
def test_legs_of_exchanged_names_are_told(read, name):
    recording = read(name)
    of_the_legs = ("THI", "KNE", "SHN", "TIB", "ANK", "HEE", "TOE", "MT5", "NAV")
    sides = {"L": "R", "R": "L"}

    def exchanged(label):
        subject, colon, bare = label.rpartition(":")
        if bare[0] not in sides or not bare[1:].startswith(of_the_legs):
            return label
        return subject + colon + sides[bare[0]] + bare[1:]

    labels = tuple(map(exchanged, recording.labels))
    (found,) = (f for f in check_recording(replace(recording, labels=labels)) if f.rule == "sides")
    assert "labels of the legs are exchanged" in found.what
    assert set(found.markers) == {label for label in labels if exchanged(label) != label}


@pytest.mark.parametrize("name", FULL_BODY)
def test_a_wrong_field_is_overruled_aloud_and_only_a_wrong_one(read, name):
    *_, up = FULL_BODY[name]
    field = read(name).up
    warnings = step(solved(read(name))[0]).warnings
    if field in (None, up):
        assert warnings == ()
    else:
        (warning,) = warnings
        assert f"the file says up is {field}, but" in warning
        assert warning.endswith(f"up is {up}")


@pytest.mark.parametrize("name", OTHERS)
def test_up_without_a_model(read, name):
    found = step(orient(read(name))).findings
    assert (found["up"], found["up_from"]) == OTHERS[name]
    assert found["mirrored"] is False


def test_kneeling_and_prone_is_judged_by_the_floor(read):
    world = orient(read("plates/KneeltoProne01.c3d"))
    found = step(world).findings
    assert "only in 51% of the frames the head is along +z" in step(world).warnings[0]
    assert 0.4 < found["upright_share"]["+x"] < 0.55
    assert 0.4 < found["upright_share"]["+z"] < 0.55
    assert found["floor_sway"]["+z"] < 0.5 * found["floor_sway"]["+x"]


def test_lying_prone_does_not_overrule_the_file_but_kneeling_upright_does(read):
    whole = read("plates/KneeltoProne01.c3d")
    prone = replace(whole, markers=whole.markers[1100:], residuals=None, up="+z")
    assert step(orient(prone)).findings["up"] == "+z"
    assert "a person who lies" in step(orient(prone)).warnings[0]
    kneeling = replace(whole, markers=whole.markers[:500], residuals=None, up="+y")
    assert step(orient(kneeling)).findings["up"] == "+z"
    assert "the file says up is +y, but" in step(orient(kneeling)).warnings[0]


EXPORTS = {
    "y-up": np.array([[1.0, 0, 0], [0, 0, 1], [0, -1, 0]]),
    "head-down": np.diag([1.0, -1, -1]),
    "x-up": np.array([[0, 0, 1.0], [1, 0, 0], [0, 1, 0]]),
    "left-handed": np.diag([1.0, -1, 1]),
    "left-handed y-up": np.array([[1.0, 0, 0], [0, 0, 1], [0, 1, 0]]),
}


@pytest.mark.parametrize("export", EXPORTS)
@pytest.mark.parametrize(
    "name",
    [
        "cmu41/85_02.c3d",
        "plugin-gait/PiG_Motion-FlatFoot-Full.c3d",
        "functional/Test_func_trunk.c3d",
        "functional/anatomical_posture.c3d",
    ],
)
def test_any_export_gives_the_same_world(read, name, export):
    """Rotated or mirrored, in mm, markers in another order, nothing said of the axes."""
    recording = read(name)
    order = np.random.default_rng(7).permutation(recording.n_markers)
    turn = EXPORTS[export]
    copy = replace(
        recording,
        markers=1e3 * recording.markers[:, order] @ turn.T,
        labels=tuple(recording.labels[i] for i in order),
        residuals=None,
        up=None,
    )
    world, model = solved(copy)
    expected, expected_model = solved(recording)
    assert model.name == expected_model.name
    assert step(world).findings["mirrored"] == (np.linalg.det(turn) < 0)
    assert bool(step(world).warnings) == (np.linalg.det(turn) < 0)
    back = 1e-3 * world.markers[:, world.columns(expected.labels)]
    assert_allclose(back[..., 1], expected.markers[..., 1], atol=1e-12)  # rounding of the mm
    assert np.linalg.det(world.world_from_file @ turn) == 1


def test_two_people_in_one_file_are_told_apart(read):
    """Justin walks, the other one turns cartwheels."""
    first, second = read("cmu41/06_01.c3d"), read("cmu41/85_02.c3d")
    n = min(first.n_frames, second.n_frames)
    both = Recording(
        markers=np.concatenate([first.markers[:n], second.markers[:n]], axis=1),
        labels=(*first.labels, *second.labels),
        rate=first.rate,
    )
    model = choose_model(both)
    assert find_subjects(both) == ("Justin", "Male")
    with pytest.raises(BadRecording, match=r"Justin .*, Male .*; pick a subject"):
        match_labels(both, model)
    for subject, alone in (("Justin", first), ("Male", second)):
        world, _ = solved(both, subject)
        expected, _ = solved(replace(alone, markers=alone.markers[:n], residuals=None))
        assert set(world.labels) == set(model.labels)
        assert_array_equal(world.markers[:, world.columns(expected.labels)], expected.markers)


@pytest.mark.parametrize("name", FULL_BODY)
def test_a_good_recording_raises_no_alarm(read, name):
    """Gaps are noted; nothing jumps, doubles, freezes or has the wrong size."""
    assert {finding.rule for finding in check_recording(read(name))} <= {"gap"}


def test_the_known_gaps_are_found(read):
    (walk,) = check_recording(read("plugin-gait/PiG_Motion-FlatFoot-Full.c3d"))
    assert walk.markers == ("LFHD",)
    squat = {f.markers[0].partition(":")[2]: f for f in check_recording(read("formats/squat.c3d"))}
    assert dict(squat["STRN"].numbers)["missing_share"] == pytest.approx(0.20, abs=0.005)
