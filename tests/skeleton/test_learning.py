"""Models learnt from motion: the actor's own tree comes out."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation

from kinesphere.data.label_sides import mirror_pairs
from kinesphere.errors import BadModel
from kinesphere.labelling import built_in_model
from kinesphere.skeleton import fit_skeleton, learn_model
from kinesphere.skeleton.degrees import count_axes
from kinesphere.skeleton.naming import joint_name
from kinesphere.skeleton.statistics import marker_statistics
from kinesphere.skeleton.topology import spanning_tree

NOISE = 3e-4  # m


def segments_of(model):
    return {segment.name: segment.markers for segment in model.segments}


def edges_of(model):
    return {frozenset((joint.parent, joint.child)) for joint in model.joints}


def test_the_tree_of_the_actor_comes_out_of_its_motion(bodies, rng):
    noisy = bodies.recording.markers + rng.normal(scale=NOISE, size=bodies.recording.markers.shape)
    recording = replace(bodies.recording, markers=noisy)
    learnt = learn_model([recording], "mine", segments_of(bodies.model))
    assert edges_of(learnt) == edges_of(bodies.model)
    assert {joint.name for joint in learnt.joints} == {joint.name for joint in bodies.model.joints}
    assert learnt.root == bodies.model.root
    assert len(fit_skeleton(recording, learnt).skeleton.limbs) == 12


def test_the_same_tree_whatever_the_limbs_are_called_and_however_they_are_listed(bodies, rng):
    given = segments_of(bodies.model)
    order = rng.permutation(len(given))
    names = {old: f"limb_{i + 1:02d}" for i, old in enumerate(given)}
    shuffled = {names[list(given)[i]]: given[list(given)[i]] for i in order}
    learnt = learn_model([bodies.recording], "anonymous", shuffled)
    back = {new: old for old, new in names.items()}
    found = {frozenset(back[limb] for limb in edge) for edge in edges_of(learnt)}
    assert found == edges_of(bodies.model)
    assert back[learnt.root] == "trunk"  # the limb with most neighbours
    assert {joint.name for joint in learnt.joints} == {f"joint_{i:02d}" for i in range(1, 12)}


def test_limbs_of_one_or_two_markers_find_their_place(cmu41):
    learnt = learn_model([cmu41.recording], "sparse", segments_of(cmu41.model))
    assert len(edges_of(learnt) & edges_of(cmu41.model)) >= 9  # of 11: chains of pairs are hard


def test_a_model_is_kept_and_gains_distances(cmu41):
    model = built_in_model("cmu41")
    learnt = learn_model([cmu41.recording, cmu41.recording], "person", model=model)
    assert learnt.joints == model.joints
    assert len(learnt.statistics) == len(model.statistics) + 2
    assert learnt.statistics[0].labels == model.labels


def test_statistics_are_those_of_a_plain_loop(rng, cmu41):
    labels = ("LKNE", "LANK", "nobody")
    recording = replace(cmu41.recording, markers=cmu41.recording.markers[:90])
    found = marker_statistics(recording, labels, "r")
    a, b = (recording.markers[:, i] for i in recording.columns(labels[:2]))
    distance = [float(np.linalg.norm(p - q)) for p, q in zip(a, b, strict=True)]
    assert found.mean[0, 1] == pytest.approx(np.mean(distance), abs=1e-12)
    assert found.deviation[0, 1] == pytest.approx(np.std(distance), abs=1e-9)
    assert_allclose(found.mean, found.mean.T, equal_nan=True)
    assert np.isnan(found.mean[2]).all()


def test_what_cannot_be_learnt_is_said(cmu41):
    recording = cmu41.recording
    with pytest.raises(BadModel, match="no recording to learn from"):
        learn_model([], "m", {"a": ("LKNE",)})
    with pytest.raises(BadModel, match="needs the segments"):
        learn_model([recording], "m")
    with pytest.raises(BadModel, match="no recording has the markers NOBODY"):
        learn_model([recording], "m", {"a": ("LKNE", "NOBODY")})
    markers = recording.markers.copy()
    markers[::2, recording.labels.index("LKNE")] = np.nan
    markers[1::2, recording.labels.index("LANK")] = np.nan
    apart = replace(recording, markers=markers)
    with pytest.raises(BadModel, match="no joint leads to"):
        learn_model([apart], "m", {"a": ("LKNE",), "b": ("LANK",)})


@pytest.mark.parametrize(
    ("axes", "expected"), [((1, 0, 0), 1), ((1, 0.8, 0), 2), ((0.05, 0, 0), None)]
)
def test_a_hinge_is_told_from_a_freer_joint_and_rest_from_both(rng, axes, expected):
    t = np.linspace(0, 9, 200)
    turns = np.stack([np.sin(t), np.sin(1.7 * t), np.sin(2.3 * t)], axis=1) * axes
    assert count_axes(Rotation.from_rotvec(turns).as_matrix()) == expected


def test_kruskal_takes_the_cheapest_edges_that_close_no_ring():
    costs = {("a", "b"): 3.0, ("a", "c"): 1.0, ("b", "c"): 2.0, ("c", "d"): np.inf}
    assert spanning_tree(("a", "b", "c", "d"), costs) == [("a", "c"), ("b", "c")]


def test_names_of_joints_and_sides():
    assert joint_name("pelvis", "left_thigh", 3) == "left_hip"
    assert joint_name("left_hand", "left_forearm", 3) == "left_wrist"
    assert joint_name("left_hand", "head", 3) == "joint_03"
    labels = ("LSHO", "RSHO", "LBUL", "knee_l", "knee_r", "left_toe", "right_toe", "CLAV")
    assert mirror_pairs(labels) == (
        ("LSHO", "RSHO"),
        ("knee_l", "knee_r"),
        ("left_toe", "right_toe"),
    )
