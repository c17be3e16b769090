"""The built-in models: complete, symmetrical, and about the body they claim to describe."""

import pytest

from kinesphere.errors import BadModel
from kinesphere.labelling import built_in_model, built_in_models

LIMBS = {
    *("pelvis", "trunk", "head"),
    *(
        f"{side}_{limb}"
        for side in ("left", "right")
        for limb in ("upper_arm", "forearm", "hand", "thigh", "shank", "foot")
    ),
}
TWO_AXES, ONE_AXIS = ("neck", "lumbar", "shoulder", "wrist", "hip", "ankle"), ("elbow", "knee")
AXES = dict.fromkeys(TWO_AXES, 2) | dict.fromkeys(ONE_AXIS, 1)
HALVES = {"left": "right", "right": "left"}


@pytest.fixture(params=built_in_models())
def model(request):
    return built_in_model(request.param)


def other_side(name):
    side, _, rest = name.partition("_")
    return f"{HALVES[side]}_{rest}" if side in HALVES else name


def test_both_layouts_are_there():
    assert built_in_models() == ("cmu41", "plugin-gait")


def test_an_unknown_name_is_answered_with_the_known_ones():
    with pytest.raises(BadModel, match="'cmu42'; there are cmu41, plugin-gait"):
        built_in_model("cmu42")


def test_a_model_has_every_limb_and_joint(model):
    assert {segment.name for segment in model.segments} == LIMBS
    assert model.root == "pelvis"
    paired = set(AXES) - {"neck", "lumbar"}
    names = {"neck", "lumbar", *(f"{side}_{joint}" for side in HALVES for joint in paired)}
    assert {j.name: j.n_axes for j in model.joints} == {n: AXES[n.split("_")[-1]] for n in names}


def test_cmu41_has_41_markers_and_needs_them_all():
    model = built_in_model("cmu41")
    assert len(model.labels) == 41
    assert set(model.required) == set(model.labels)


def test_plugin_gait_does_without_arm_wands_and_extras():
    model = built_in_model("plugin-gait")
    assert len(model.required) == 35
    assert not {"LUPA", "RFRM", "SACR", "LKNEM"} & set(model.required)
    assert {"LUPA", "RFRM", "SACR", "LKNEM"} <= set(model.labels)


def test_left_and_right_mirror_each_other(model):
    swap = dict(model.mirror) | {right: left for left, right in model.mirror}
    sided = {m for s in model.segments if s.name.split("_")[0] in HALVES for m in s.markers}
    assert sided <= set(swap)

    for segment in model.segments:
        twin = model.segment(other_side(segment.name))
        assert {swap.get(m, m) for m in segment.markers} == set(twin.markers)
        assert {swap.get(m, m) for m in segment.shared} == set(twin.shared)

    joints = {joint.name: joint for joint in model.joints}
    for joint in model.joints:
        twin = joints[other_side(joint.name)]
        assert (twin.parent, twin.child) == (other_side(joint.parent), other_side(joint.child))
        for mine, its in zip(joint.landmarks, twin.landmarks, strict=True):
            assert {swap.get(m, m): w for m, w in mine.weights.items()} == its.weights
            assert mine.plane == its.plane
            moves = (mine.inward, mine.down, mine.forward, mine.offset, mine.spread)
            assert moves == (its.inward, its.down, its.forward, its.offset, its.spread)


def test_shared_markers_belong_to_a_neighbour(model):
    for segment in model.segments:
        near = {j.parent for j in model.joints if j.child == segment.name}
        near |= {j.child for j in model.joints if j.parent == segment.name}
        owned = {m for name in near for m in model.segment(name).markers}
        assert set(segment.shared) <= owned


def test_every_joint_has_a_landmark_of_known_labels_with_its_source(model):
    for joint in model.joints:
        assert joint.landmarks
        for landmark in joint.landmarks:
            assert sum(landmark.weights.values()) == pytest.approx(1, abs=1e-6)
            named = {*landmark.weights, *(landmark.scale or ()), *landmark.plane}
            assert named <= set(model.labels)
            assert landmark.source
            assert 0.005 <= landmark.spread <= 0.05


def test_aliases_lead_to_labels_and_are_none_themselves(model):
    assert set(model.aliases.values()) <= set(model.labels)
    assert not set(model.aliases) & set(model.labels)
