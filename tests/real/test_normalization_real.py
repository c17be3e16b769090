"""Normalized frames on real recordings: against the vendor's thorax, feet ahead, standing found."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from kinesphere.data import Recording
from kinesphere.geometry.rotations import rotation_angle
from kinesphere.io import read
from kinesphere.labelling import choose_model, match_labels
from kinesphere.normalization import NormalizationSettings, normalize
from kinesphere.quality import orient
from kinesphere.skeleton import fit_skeleton

pytestmark = [pytest.mark.real, pytest.mark.slow]

LATERAL, LONG = 8.0, 12.0  # deg; two definitions of one thorax, plus an error of its joints
SPREAD = 4.0  # deg rms between body frames of the default position: breathing, sway, noise
STRIDE = 6.0  # deg rms over whole strides, in which shoulders turn against the pelvis by ±10

PLUGIN_GAIT = (
    "plugin-gait/PiG_Calibration-FlatFoot-Full.c3d",
    "plugin-gait/PiG_Motion-FlatFoot-Full.c3d",
    "plugin-gait/pycgm_movement.c3d",
    "plugin-gait/pycgm_static.c3d",
)
CMU = tuple(f"cmu41/{name}.c3d" for name in ("02_05", "06_01", "85_02", "135_02"))
FUNCTIONAL = tuple(
    f"functional/{name}.c3d"
    for name in (
        "Test_func_anat", "Test_func_lankle", "Test_func_lhip", "Test_func_lknee",
        "Test_func_rankle", "Test_func_rhip", "Test_func_rknee", "Test_func_trunk",
        "anatomical_posture",
    )
)  # fmt: skip
WALKING = (CMU[1], *PLUGIN_GAIT[1:3])
STANDING = ("plugin-gait/PiG_Calibration-FlatFoot-Full.c3d", CMU[0], CMU[3], *FUNCTIONAL[1:])
"""Recordings in which somebody stands with arms hanging, as seen by eye; the rest raise them or
walk (85_02: forearms at 61°, and 60° is where arms no longer hang)."""


@cache
def provisional(path, without=()):
    recording = read(path)
    model = choose_model(recording)
    if without:
        labels = tuple(at for at in recording.labels if at.split(":")[-1] not in without)
        kept = [recording.labels.index(label) for label in labels]
        recording = Recording(
            markers=recording.markers[:, kept], labels=labels, rate=recording.rate, up=recording.up
        )
    recording = orient(match_labels(recording, model), model)
    return recording, fit_skeleton(recording, model)


def vendor_thorax(recording):
    """Return the vendor's thorax in our axes and world, (n_frames, 3, 3).

    Four points: origin, and one each along anterior, lateral and a third axis that points down;
    the lateral one then lies to the right.
    """
    points = {
        output.label: output.values @ recording.world_from_file.T for output in recording.outputs
    }
    x, z, down = (points[f"TRX{end}"] - points["TRXO"] for end in "ALP")
    axes = np.stack([x, -down, z], axis=-1)
    return axes / np.linalg.norm(axes, axis=1, keepdims=True)


def between(a, b):
    return np.rad2deg(np.arccos(np.clip((a * b).sum(axis=-1), -1, 1)))


@pytest.mark.parametrize(
    ("name", "without"),
    [
        ("lhip", ("LHEE", "RHEE")),
        ("rknee", ("LHEE", "RHEE")),
        ("rknee", ("LHEE",)),
        ("lhip", ("LHEE",)),
    ],
)
def test_a_foot_without_its_heel_lies_as_with_it(recordings, name, without):
    """By the line of its other markers alone it is 18 to 21° off in pitch."""
    path = recordings / "functional" / f"Test_func_{name}.c3d"
    whole, bare = (normalize(provisional(path, lost)[1]) for lost in ((), without))
    for side in ("left", "right"):
        with_heel, without_heel = (
            result.rotations[:, result.skeleton.limb_names.index(f"{side}_foot")]
            for result in (whole, bare)
        )
        apart = np.swapaxes(with_heel, -1, -2) @ without_heel
        pitch = np.rad2deg(np.nanmedian(np.arctan2(apart[:, 1, 0], apart[:, 0, 0])))
        assert abs(pitch) < 3.0
        assert np.rad2deg(np.nanmedian(rotation_angle(apart))) < 9.0
    findings = bare.history[-1].findings
    assert whole.history[-1].findings["feet_without_heel"] == []
    if len(without) == 1:  # the other foot has one
        assert findings["feet_by_the_other"] == {"left_foot": ["RHEE"]}
        assert findings["feet_without_heel"] == []
        return
    assert list(findings["feet_levelled_deg"]) == ["left_foot", "right_foot"]
    (said,) = (warning for warning in bare.history[-1].warnings if "heel" in warning)
    assert "rests flat" in said


@pytest.mark.parametrize(
    ("name", "marker", "off"),
    [
        *(
            (f"functional/{name}.c3d", f"{side}{marker}", 6.5)
            for name in ("Test_func_lknee", "Test_func_rhip", "anatomical_posture")
            for side in "LR"
            for marker in ("TOE", "TOE5", "HEE")
        ),
        *((PLUGIN_GAIT[3], f"{side}{marker}", 8.0) for side in "LR" for marker in ("TOE", "HEE")),
    ],
)
def test_a_foot_that_lacks_one_marker_lies_nearly_as_with_it(recordings, name, marker, off):
    """By its own markers alone it is 6 to 10° off; with its heel alone, turned right round."""
    whole, less = (normalize(provisional(recordings / name, lost)[1]) for lost in ((), (marker,)))
    foot = f"{'left' if marker[0] == 'L' else 'right'}_foot"
    i = whole.skeleton.limb_names.index(foot)
    apart = np.swapaxes(whole.rotations[:, i], -1, -2) @ less.rotations[:, i]
    assert np.rad2deg(np.nanmedian(rotation_angle(apart))) < off
    twin = f"{'R' if marker[0] == 'L' else 'L'}{marker[1:]}"
    assert less.history[-1].findings["feet_by_the_other"] == {foot: [twin]}
    assert any(f"{foot} has no marker like {twin}" in said for said in less.history[-1].warnings)


@pytest.mark.parametrize(
    ("name", "told"),
    [
        ("functional/Test_func_lknee.c3d", "outer edge"),
        (CMU[1], "outer edge"),
        (PLUGIN_GAIT[3], "at its heel alone"),
    ],
)
def test_feet_without_toes_are_told(recordings, name, told):
    """Both of them: 8 and 9° off, 16 and 18°, and 12 and 16°."""
    whole, less = (normalize(provisional(recordings / name, lost)[1])
                   for lost in ((), ("LTOE", "RTOE")))  # fmt: skip
    (said,) = (warning for warning in less.history[-1].warnings if told in warning)
    assert "left_foot (LHEE" in said
    assert "right_foot (RHEE" in said
    assert not any(told in warning for warning in whole.history[-1].warnings)
    aside = ["left_foot", "right_foot"] if told == "outer edge" else []
    assert less.history[-1].findings["feet_without_toes"] == aside
    assert whole.history[-1].findings["feet_without_toes"] == []


@pytest.mark.parametrize("name", PLUGIN_GAIT)
def test_the_trunk_agrees_with_the_vendors_thorax(name, recordings):
    recording, motion = provisional(recordings / name)
    result = normalize(motion)
    ours = result.rotations[:, result.skeleton.limb_names.index("trunk")]
    theirs = vendor_thorax(recording)
    assert np.nanmedian(np.linalg.det(theirs)) == pytest.approx(1.0, abs=1e-3)
    assert np.nanmedian(between(ours[:, :, 2], theirs[:, :, 2])) < LATERAL
    assert np.nanmedian(between(ours[:, :, 1], theirs[:, :, 1])) < LONG


@pytest.mark.parametrize("name", CMU + PLUGIN_GAIT + FUNCTIONAL)
def test_everybody_faces_forward(name, recordings):
    _, motion = provisional(recordings / name)
    result = normalize(motion)
    found = result.history[-1].findings
    assert found["facing"]["scores"]["feet"] > 0.8
    assert found["facing"]["scores"].get("knees", 1.0) > 0.5
    assert found["spread_rms_deg"] < (STRIDE if name in WALKING else SPREAD)
    assert not any("backwards" in warning for warning in result.history[-1].warnings)


@pytest.mark.parametrize("name", CMU + PLUGIN_GAIT + FUNCTIONAL)
def test_only_somebody_who_stands_counts_as_standing(name, recordings):
    found = normalize(provisional(recordings / name)[1]).history[-1].findings
    assert found["good_default_position"] is (name in STANDING)


@pytest.mark.parametrize("name", CMU + PLUGIN_GAIT + FUNCTIONAL)
def test_limbs_hang_and_feet_point_ahead(name, recordings):
    """In the normalized default position, legs lie within a stride of their ideal directions."""
    found = normalize(provisional(recordings / name)[1]).history[-1].findings
    off = found["limbs_off_ideal_deg"]
    assert max(angle for limb, angle in off.items() if "thigh" in limb or "shank" in limb) < 45
    assert max(angle for limb, angle in off.items() if "foot" in limb) < 60


@pytest.mark.parametrize("name", WALKING)
@pytest.mark.parametrize("cut", [slice(1, None), slice(None, -1)])
def test_one_frame_more_or_less_turns_no_limb(name, cut, recordings):
    """Who never stands still; 1.2° at most. Of one sample in a tenth of a second it was 11°."""
    _, motion = provisional(recordings / name)
    shorter = replace(
        motion,
        rotations=motion.rotations[cut],
        origins=motion.origins[cut],
        residuals=motion.residuals[cut],
        flags=motion.flags[cut],
    )
    whole, less = normalize(motion).rotations[cut], normalize(shorter).rotations
    turned = np.nanmax(rotation_angle(np.swapaxes(whole, -1, -2) @ less), axis=0)
    assert np.rad2deg(turned.max()) < 2.0


@pytest.mark.parametrize("name", CMU[:1] + PLUGIN_GAIT[:1] + FUNCTIONAL[2:3])
def test_twice_is_once(name, recordings):
    once = normalize(provisional(recordings / name)[1])
    twice = normalize(once)
    np.testing.assert_allclose(twice.rotations, once.rotations, atol=1e-9)
    np.testing.assert_allclose(twice.origins, once.origins, atol=1e-9)


@pytest.mark.parametrize("name", PLUGIN_GAIT)
def test_pairs_place_the_trunk_no_worse_than_the_papers_plane(name, recordings):
    """What made the pairs of shoulders and hips the default.

    Hips are where the pelvis' plane has them, to 9 mm, which is 1.1° over the half metre from there
    to the shoulders. It dips by 25° in one of these, whose trunk leans so 1.2° farther than the
    plane's: by the little that hips are known to. Elsewhere the pairs are nearer by 0.6 to 5.5°.
    """
    recording, motion = provisional(recordings / name)
    theirs = vendor_thorax(recording)
    worst = {}
    for body in ("lateral", "plane"):
        result = normalize(motion, NormalizationSettings(body=body))
        ours = result.rotations[:, result.skeleton.limb_names.index("trunk")]
        worst[body] = max(np.nanmedian(between(ours[:, :, k], theirs[:, :, k])) for k in range(3))
    assert worst["lateral"] < worst["plane"] + 1.5
