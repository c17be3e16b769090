"""TopologicalModel: a tree of segments, and how it says that it is none."""

import dataclasses

import pytest

from kinesphere.data import JointModel, Segment, TopologicalModel
from kinesphere.errors import BadModel

ARM = TopologicalModel(
    name="arm",
    segments=(
        Segment("left_hand", ("FIN",), shared=("WRA",)),
        Segment("trunk", ("C7", "T10", "SHO")),
        Segment("left_forearm", ("WRA", "WRB")),
        Segment("left_upper_arm", ("UPA", "ELB")),
    ),
    joints=(
        JointModel("left_wrist", "left_forearm", "left_hand"),
        JointModel("left_elbow", "left_upper_arm", "left_forearm", n_axes=1),
        JointModel("left_shoulder", "trunk", "left_upper_arm", n_axes=2),
    ),
    root="trunk",
)


def test_joints_come_parents_first():
    assert [j.name for j in ARM.joints_from_root] == ["left_shoulder", "left_elbow", "left_wrist"]


def test_labels_are_those_that_segments_own():
    assert ARM.labels == ("FIN", "C7", "T10", "SHO", "WRA", "WRB", "UPA", "ELB")
    assert ARM.segment("left_hand").shared == ("WRA",)


JOINTS, SEGMENTS = ARM.joints, ARM.segments


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"root": "pelvis"}, "root 'pelvis' is no segment; there are left_hand, trunk"),
        ({"segments": (*SEGMENTS, SEGMENTS[0])}, "segment left_hand is there twice"),
        ({"segments": (*SEGMENTS[1:], Segment("left_hand", ("ELB",)))}, "ELB belongs to both"),
        ({"joints": (*JOINTS[:2], JOINTS[2], JOINTS[2])}, "joint left_shoulder is there twice"),
        ({"joints": JOINTS[:2]}, "no chain of joints leads from left_hand to the root"),
        ({"joints": (*JOINTS, JointModel("x", "trunk", "left_hand"))}, "left_hand has two parents"),
        (
            {"joints": (*JOINTS[:2], JointModel("x", "tail", "left_upper_arm"))},
            "names segment 'tail'",
        ),
        ({"joints": (*JOINTS, JointModel("x", "left_hand", "trunk"))}, "root trunk hangs from"),
        (
            {"joints": (*JOINTS[:2], JointModel("x", "left_hand", "left_upper_arm"))},
            "joints form a ring",
        ),
    ],
)
def test_what_is_no_tree_is_refused(changes, message):
    with pytest.raises(BadModel, match=message):
        dataclasses.replace(ARM, **changes)
