"""A start that is right is believed; one that is wrong is doubted, or refused."""

from dataclasses import replace

import numpy as np
import pytest

from kinesphere.errors import BadScene
from kinesphere.markerless.doubt import Evidence, contrast, doubt_of, evidence_of
from kinesphere.markerless.eyes import fitter_for
from kinesphere.markerless.hypotheses import arm_poses, facing, standing
from kinesphere.markerless.pose import posed
from kinesphere.markerless.rim import Canvas
from kinesphere.markerless.settings import TrackSettings
from kinesphere.markerless.silhouettes import Silhouettes
from kinesphere.markerless.start import overlaps

SURE = Evidence(edges=0.98, overlap=0.92, bare=0.0, cut_out=True)


@pytest.fixture(scope="module")
def drawn(ring, whole):
    """Return a fitter, the true pose, and images and silhouettes of it."""
    rng = np.random.default_rng(3)
    pose = facing(standing(whole.chain, "t-pose"), np.array([0.0, 0.95, 0]), np.array([1.0, 0, 0]))
    points = whole.skinned(posed(whole.chain, pose))
    cameras = ring(4)
    fitter = fitter_for(whole, cameras, TrackSettings(largest=320), masks=True)
    pictures, masks = [], []
    for eye in fitter.eyes:
        limbs = Canvas(eye.canvas.view, whole, 6).draw(points).limbs
        picture = np.full((*limbs.shape, 3), (150, 150, 140), dtype=np.float64)
        picture[limbs >= 0] = (50, 70, 150)
        noisy = picture + rng.normal(scale=2, size=picture.shape)
        pictures.append(np.clip(noisy, 0, 255).astype(np.uint8))
        masks.append((limbs >= 0).astype(np.uint8) * 255)
    return fitter, pose, pictures, masks


def evidence(drawn, pose):
    fitter, _, pictures, masks = drawn
    overlap = float(np.mean(overlaps(fitter, pose, masks)))
    return evidence_of(fitter, pose, pictures, Silhouettes(masks, cut_out=True), overlap)


def test_the_true_pose_is_believed(drawn):
    found = evidence(drawn, drawn[1])
    assert found.bare == 0
    assert found.overlap > 0.99
    assert doubt_of(replace(found, edges=1.0), 1) == ""


def test_an_arm_put_elsewhere_leaves_space_bare_and_has_no_edges(drawn, whole):
    right = evidence(drawn, drawn[1])
    down = evidence(drawn, next(iter(arm_poses(whole.chain, drawn[1], "left"))))
    assert down.bare > 0.5e-3
    assert down.edges < right.edges
    assert "left bare" in doubt_of(replace(down, edges=1.0), 1)


def test_somebody_who_is_elsewhere_is_refused(drawn):
    off = replace(drawn[1], position=drawn[1].position + np.array([0.5, 0, 0.3]))
    found = evidence(drawn, off)
    assert found.nobody
    with pytest.raises(BadScene, match="not found in frame 7"):
        doubt_of(found, 7)


@pytest.mark.parametrize(
    ("changes", "why"),
    [
        ({"edges": 0.93}, "edges of the image along the body's rim 0.93"),
        ({"overlap": 0.8}, "overlap with the silhouettes 0.80"),
        ({"bare": 2e-3}, "2.0 litres"),
        ({"moved": False}, "nothing moves"),
        ({"edges": float("nan"), "overlap": 0.9}, "edges"),
    ],
)
def test_each_of_three_may_speak_against_a_start(changes, why):
    assert doubt_of(SURE, 1) == ""
    assert why in replace(SURE, **changes).against[0]


def test_given_silhouettes_are_evidence_enough():
    cluttered = replace(SURE, edges=0.8, bare=1e-3, cut_out=False)
    assert doubt_of(cluttered, 1) == ""
    assert "overlap" in doubt_of(replace(cluttered, overlap=0.5), 1)


def test_what_is_said_names_the_frame_and_the_remedy():
    said = doubt_of(replace(SURE, overlap=0.7), 12)
    assert said.startswith("the start is doubtful")
    assert "frame 12" in said
    assert "plates" in said
    assert "keypoints" in said


def test_contrast_ranks_an_edge_high_and_follows_no_unit():
    picture = np.full((60, 80, 3), 90, dtype=np.uint8)
    picture[:, 40:] = 160
    picture[:, :, 1] += np.arange(80, dtype=np.uint8) // 4
    ranks = contrast(picture)
    assert ranks.shape == (60, 80)
    assert ranks[:, 39:41].min() > 0.9
    assert np.median(ranks[:, :30]) < 0.9
