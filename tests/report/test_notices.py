"""Warnings in few words, and nothing lost on the way."""

import pytest

from kinesphere.report.notices import Notice, names_in_words, notices

JOINTS = ("neck", "left_hip", "right_hip", "left_upper_arm", "right_upper_arm", "left_foot")


@pytest.mark.parametrize(
    ("names", "said"),
    [
        (["left_hip", "neck", "right_hip"], "hips, neck"),
        (["right_hip", "left_hip"], "hips"),
        (["left_hip", "right_knee"], "left hip, right knee"),
        (["left_upper_arm", "right_upper_arm"], "upper arms"),
        (["left_foot", "right_foot", "left_foot"], "feet"),
        (["joint_01", "left"], "joint 01, left"),
        ([], ""),
    ],
)
def test_names(names, said):
    assert names_in_words(names) == said


def test_reasons_are_told_apart_most_common_first():
    warning = (
        "not told: neck (hardly moves), left_hip (halves differ by 75°; 63° off, 12.5° are "
        "wanted), right_hip (halves differ by 7°)"
    )
    assert notices([warning], JOINTS) == [
        Notice(
            "not told",
            (
                ("halves differ by 7–75°", "hips"),
                ("hardly moves", "neck"),
                ("63° off, 12.5° are wanted", "left hip"),
            ),
        )
    ]


def test_what_is_said_of_one_axis_is_not_said_of_another():
    warning = "one is told: left_hip (axis 1: 12° off), right_hip (axis 2: 20° off)"
    [found] = notices([warning], JOINTS)
    assert found.reasons == (("axis 1: 12° off", "left hip"), ("axis 2: 20° off", "right hip"))


def test_unlike_numbers_of_axes_are_no_range():
    one = "only 1 of {} main movements is there"
    warning = f"not told: neck ({one.format(3)}), left_hip ({one.format(2)})"
    [found] = notices([warning], JOINTS)
    assert sorted(found.reasons) == [(one.format(2), "left hip"), (one.format(3), "neck")]


@pytest.mark.parametrize(
    ("warning", "said"),
    [
        (
            "the centre of neck, left_hip, right_hip; it is elsewhere",
            "the centre of neck, hips; it is elsewhere",
        ),
        ("nothing tells the twist at left_hip, right_hip", "nothing tells the twist at hips"),
        ("at left_hip alone", "at left hip alone"),
        ("at rest at left_upper_arm: 12.6 deg/s", "at rest at left upper arm: 12.6 deg/s"),
        ("nothing tells the twist at left_foot", "nothing tells the twist at left foot"),
        ("that of left_hip.", "that of left hip."),
        ("see left_hip.c3d, a/left_hip, 'left_hip'", "see left_hip.c3d, a/left_hip, 'left_hip'"),
        ("axes.counts=left_hip=1", "axes.counts=left_hip=1"),
        ("labels LFHD, left_hip", "labels LFHD, left_hip"),
        ("labels LFHD, left_hip_marker, x", "labels LFHD, left_hip_marker, x"),
        ("left out: STRANGE (no reason we know)", "left out: STRANGE (no reason we know)"),
        ("trailing: neck (still) and more", "trailing: neck (still) and more"),
        ("both: with more, neck (still)", "both: with more, neck (still)"),
        ("at left_hip, right_hip, L_X", "at left_hip, right_hip, L_X"),
        ("", ""),
    ],
)
def test_other_sentences_stay_but_for_lists_of_names(warning, said):
    assert notices([warning], JOINTS) == [Notice(said)]


def test_said_once():
    assert notices(["b", "a", "b"]) == [Notice("b"), Notice("a")]
