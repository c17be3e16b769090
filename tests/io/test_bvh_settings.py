"""What motion.bvh can be made to look like."""

import pytest

from kinesphere.errors import BadSetting
from kinesphere.io import read_bvh, write_bvh
from kinesphere.io.bvh_names import renamed
from kinesphere.io.bvh_settings import BvhSettings

LIMBS = ("pelvis", "trunk", "head", "left_upper_arm", "right_forearm", "left_thigh", "right_foot")


def test_names_are_those_of_the_program():
    assert renamed(LIMBS, "kinesphere") == LIMBS
    assert renamed(LIMBS, "unity") == (
        *("Hips", "Spine", "Head", "LeftUpperArm", "RightLowerArm", "LeftUpperLeg", "RightFoot"),
    )
    assert renamed(LIMBS, "motionbuilder") == (
        *("Hips", "Spine", "Head", "LeftArm", "RightForeArm", "LeftUpLeg", "RightFoot"),
    )
    assert renamed(("trunk", "limb_01"), "unity") == ("Hips", "limb_01")
    assert renamed(("trunk", "Hips"), "unity") == ("trunk", "Hips"), "names stay different"


@pytest.mark.parametrize(("channels", "order"), [("zxy", "ZXY"), ("zyx", "ZYX")])
def test_every_joint_has_the_order_asked_for(performance, tmp_path, channels, order):
    write_bvh(performance.motion, tmp_path / "a.bvh", channels=channels)
    text = (tmp_path / "a.bvh").read_text(encoding="utf-8")
    turns = " ".join(f"{letter}rotation" for letter in order)
    lines = [line.strip() for line in text.splitlines() if "CHANNELS" in line]
    assert lines[0] == f"CHANNELS 6 Xposition Yposition Zposition {turns}"
    assert set(lines[1:]) == {f"CHANNELS 3 {turns}"}


def test_names_are_written(performance, tmp_path):
    write_bvh(performance.motion, tmp_path / "a.bvh", names="motionbuilder")
    names = read_bvh(tmp_path / "a.bvh").skeleton.limb_names
    assert names[0] == "Hips"
    assert {"LeftUpLeg", "RightForeArm", "Head"} <= set(names)


@pytest.mark.parametrize("wrong", [{"names": "maya"}, {"channels": "xyw"}, {"rest": "a"}])
def test_unknown_choices_are_named(performance, tmp_path, wrong):
    ((key, value),) = wrong.items()
    with pytest.raises(BadSetting, match=f"{key} is '{value}'"):
        write_bvh(performance.motion, tmp_path / "a.bvh", **wrong)
    with pytest.raises(BadSetting, match=key):
        BvhSettings(**wrong)
