"""Joints of what is no body."""

from dataclasses import replace

import numpy as np

from kinesphere.skeleton import fit_skeleton
from kinesphere.synthetic import make_performance, spoil_with_noise


def test_the_joints_of_two_limbs_taken_for_one_are_not_told():
    """Half of the markers of either thigh as one limb, as bodies found wrongly were."""
    performance = make_performance(np.random.default_rng(31), calibration_s=0, free_s=30)
    recording = spoil_with_noise(performance.recording, np.random.default_rng(1))
    model = performance.model
    own = {segment.name: segment.markers for segment in model.segments}
    kept = {"pelvis", "trunk", "head", "left_thigh", "left_shank", "left_foot"} & own.keys()
    mixed = (*own["left_thigh"][:2], *own["right_thigh"][:2])
    segments = tuple(
        replace(one, markers=mixed if one.name == "left_thigh" else one.markers)
        for one in model.segments
        if one.name in kept
    )
    joints = tuple(
        replace(one, landmarks=())
        for one in model.joints
        if one.parent in kept and one.child in kept
    )
    labels = tuple(label for one in segments for label in one.markers)
    wrong = replace(model, segments=segments, joints=joints, required=labels, mirror={})
    skeleton = fit_skeleton(recording, wrong).skeleton
    right = fit_skeleton(recording, model).skeleton
    for name in ("left_hip", "left_knee"):
        assert skeleton.joint(name).observability == "undetermined"
        assert right.joint(name).observability != "undetermined"
        assert np.sqrt(np.trace(skeleton.joint(name).covariance)) > 0.05
    assert skeleton.joint("left_ankle").observability == "determined"
