"""What the terminal says of a stage: numbers agree with their nouns, nothing is left empty."""

import numpy as np
import pytest

from kinesphere.cli.stages import stage_in_words

JOINT = {"name": "left_knee", "observability": "hinge", "residual_mm": 2.0, "axes_from": "movement"}


def words(name, limbs, joints, **found):
    summary = {
        "limbs": limbs,
        "limb_residual_rms_mm": 220.0,
        "rebuilt_residual_rms_mm": 3.0,
        "joint_findings": joints,
    }
    return stage_in_words({"name": name, "settings": {}, "findings": found}, summary)


def test_a_single_body_without_joints_has_words():
    limbs = ["limb_01"]
    found = {"bodies_found": 1, "trees": 1, "names_confidence": None, "loose": ["*3"]}
    told = words("discovery", limbs, [], **found)
    assert told == "1 body from motion alone; no limb named; 1 marker loose"
    assert words("skeleton", limbs, []) == "1 limb fits to 220 mm rms; no joints"
    assert words("parameterization", limbs, []) == "no joints, so no axes"


def test_one_joint_and_several():
    one = [{**JOINT, "n_axes": 1}]
    told = words("skeleton", ["trunk", "head"], one)
    assert told.startswith("2 limbs fit to 220 mm rms; 1 joint centre: 1 hinge; apart 2 mm")
    told = words("parameterization", ["trunk", "head"], one)
    assert told == "1 axis, joints: 1 by their own movements; 2 limbs rebuilt to 3 mm rms"
    two = [{**JOINT, "n_axes": 2}, {**JOINT, "n_axes": 1, "residual_mm": np.nan}]
    told = words("skeleton", ["a", "b", "c"], two)
    assert told.endswith("2 joint centres: 2 hinge; apart 2 mm (median of 1), 2 mm (left_knee)")
    assert words("parameterization", ["a", "b", "c"], two).startswith("3 axes, joints: 2 by")


@pytest.mark.parametrize(
    ("named", "said"), [(1, "1 limb named (confidence 0.80)"), (2, "2 limbs named")]
)
def test_named_limbs_are_counted(named, said):
    limbs = [*["trunk", "head"][:named], "limb_01"]
    found = {"bodies_found": 3, "trees": 2, "names_confidence": 0.8, "loose": []}
    assert f"3 bodies from motion alone in 2 trees; {said}" in words(
        "discovery", limbs, [], **found
    )


def test_a_calibration_says_where_axes_are_from():
    of_hip = {"axis_1": "abduct", "axis_2": "flex", "axis_3": None}
    found = {
        "recordings": ["abduct", "flex"],
        "axes_from": {"left_hip": of_hip, "left_knee": {"axis_1": "flex"}, "neck": {}},
    }
    told = words("calibration", [], [], **found)
    assert (
        told == "axes known best by abduct: left hip (axis 1); flex: left hip (axis 2), left knee"
    )
    one = words("calibration", [], [], recordings=["a"], axes_from={"neck": {"axis_1": "a"}})
    assert one == "axes of a: neck"
    none = words("calibration", [], [], recordings=["flex"], axes_from={})
    assert none == "no axes of other recordings"


def test_a_window_beyond_the_end_is_no_empty_row():
    told = words("calibration", [], [], window_s=[0, 60], used_s=17.999)
    assert told == "window 0–60 s; 18 s of it are recorded"


def test_a_stage_that_only_warns_points_below():
    stage = {"name": "checks", "settings": {}, "findings": {"found": []}, "warnings": ["a", "b"]}
    assert stage_in_words(stage, {}) == "2 warnings, see below"
    assert stage_in_words({**stage, "warnings": []}, {}) == ""


def test_many_hidden_samples_are_told_with_what_fills_them():
    def told(**found):
        return words("skeleton", ["limb_01"], [], **found)

    assert "5% of marker samples hidden" in told(hidden_share=0.05, fill_markers=False)
    assert "--set skeleton.fill_markers=true" in told(hidden_share=0.05, fill_markers=False)
    assert "hidden" not in told(hidden_share=0.05, fill_markers=True)
    assert "hidden" not in told(hidden_share=0.01, fill_markers=False)
