"""Markers of a filmed person: rigid on their limbs, and the model knows where the joints are."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from kinesphere.data import bundled_body
from kinesphere.skeleton import fit_skeleton
from kinesphere.synthetic.film import make_film, marker_model, markers_of

pytestmark = pytest.mark.slow  # the movements are worked out frame by frame


@pytest.fixture(scope="module")
def motion():
    return make_film(2, "body", size=(64, 48), n_frames=60).motion


def test_markers_of_a_limb_keep_their_distances(motion, rng):
    markers = markers_of(motion, rng, noise=0.0)
    model = marker_model(motion.surface)
    assert markers.labels == model.labels
    for segment in model.segments:
        at = [markers.labels.index(label) for label in segment.markers]
        points = markers.markers[:, at]
        apart = np.linalg.norm(points[:, :, None] - points[:, None], axis=-1)
        assert np.ptp(apart, axis=0).max() < 1e-9
        # spread out in all three directions, or the limb's turn would be a guess
        assert np.linalg.svd(points[0] - points[0].mean(axis=0))[1][2] > 0.01


def test_landmarks_are_where_the_joints_are(motion, rng):
    markers = markers_of(motion, rng, noise=0.0)
    limbs = motion.surface.limbs
    for joint in marker_model(motion.surface).joints:
        (landmark,) = joint.landmarks
        at = [markers.labels.index(label) for label in landmark.weights]
        weights = np.array(list(landmark.weights.values()))
        assert weights.sum() == pytest.approx(1.0)
        found = np.einsum("m,tmi->ti", weights, markers.markers[:, at])
        assert_allclose(found, motion.joint_centres[:, limbs.index(joint.child)], atol=1e-9)


def test_the_marker_line_finds_the_filmed_skeleton(motion, rng):
    recording = markers_of(motion, rng)
    found = fit_skeleton(recording, marker_model(motion.surface))
    limbs = motion.surface.limbs
    for joint in ("left_elbow", "right_knee", "left_shoulder"):
        j = found.skeleton.joint_names.index(joint)
        child = found.skeleton.joints[j].child
        off = found.joint_centres()[:, j] - motion.joint_centres[:, limbs.index(child)]
        assert np.sqrt((off**2).sum(axis=1).mean()) < 0.003


def test_noise_is_as_asked(motion):
    quiet = markers_of(motion, np.random.default_rng(1), noise=0.0).markers
    loud = markers_of(motion, np.random.default_rng(1), noise=2e-3).markers
    assert (loud - quiet).std() == pytest.approx(2e-3, rel=0.05)


def test_the_model_covers_every_limb_of_the_bundled_body():
    model = marker_model(bundled_body())
    assert {s.name for s in model.segments} == set(bundled_body().limbs)
    assert {j.name for j in model.joints} >= {"lumbar", "neck", "left_elbow", "right_ankle"}
