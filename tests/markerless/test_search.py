"""Small silhouettes, and limbs looked for in the large before them."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

pytest.importorskip("cv2")

from kinesphere.markerless.cutting import cut_out_together
from kinesphere.markerless.hypotheses import arm_places, facing, standing
from kinesphere.markerless.pose import limited, moved, posed
from kinesphere.markerless.rim import Canvas
from kinesphere.markerless.search import shaken, with_arms_found
from kinesphere.markerless.sketch import coarsened, sketch_of
from kinesphere.markerless.views import view_of

pytestmark = pytest.mark.slow  # rendering takes long in plain Python


def someone(whole, arms="a-pose"):
    """Return a person upright."""
    place, looks = np.array([0.05, 0.95, 0.1]), np.array([1.0, 0, 0.4])
    return facing(standing(whole.chain, arms), place, looks)


@pytest.fixture(scope="module")
def shot(ring, whole):
    """Return views, and masks of a person whose left arm is raised ahead, bent."""
    pose = someone(whole, "standing")
    step = np.zeros(whole.chain.n_dofs)
    names = whole.parameter_names
    step[names.index("left_upper_arm.turn3")] = 1.2
    step[names.index("left_forearm.angle1")] = 0.5
    pose = limited(whole.chain, moved(whole.chain, pose, step))
    views = [view_of(camera, 320) for camera in ring(4)]
    points = whole.skinned(posed(whole.chain, pose))
    masks = [
        np.where(Canvas(view, whole, 6).draw(points).limbs >= 0, np.uint8(255), np.uint8(0))
        for view in views
    ]
    return views, masks, pose


def test_few_triangles_look_like_many(whole):
    few = coarsened(whole, 0.045)
    assert len(few.faces) < 0.35 * len(whole.faces)
    assert_allclose(few.bind.min(axis=0), whole.bind.min(axis=0), atol=0.03)
    assert_allclose(few.bind.max(axis=0), whole.bind.max(axis=0), atol=0.03)
    assert few.faces.max() < len(few.bind)


def test_the_true_pose_is_worth_most(shot, whole):
    views, masks, pose = shot
    sketch = sketch_of(whole, views, masks)
    best = sketch.worth(pose)
    for k in (3, 10, 20, 30):
        step = np.zeros(whole.chain.n_dofs)
        step[k] = 0.4
        assert sketch.worth(moved(whole.chain, pose, step)) < best


def test_worth_beside_is_worth(shot, whole):
    views, masks, pose = shot
    sketch = sketch_of(whole, views, masks)
    limbs = [whole.chain.limb_names.index("left_upper_arm")]
    beside = sketch.worth_beside(pose, limbs)
    for other in list(arm_places(whole.chain, pose, "left", 20))[::5]:
        # along the cut between arm and trunk a pixel may belong to neither or both
        assert beside(other) == pytest.approx(sketch.worth(other), abs=40)


def test_a_camera_without_a_mask_is_left_out(shot, whole):
    views, masks, pose = shot
    all_but_one = sketch_of(whole, views, [None, *masks[1:]])
    assert len(all_but_one.views) == 3
    assert all_but_one.worth(pose) < sketch_of(whole, views, masks).worth(pose)


def test_a_raised_arm_is_found(shot, whole):
    views, masks, truth = shot
    sketch = sketch_of(whole, views, masks)
    hanging = replace(truth, balls=truth.balls.copy(), angles=someone(whole).angles)
    arm = whole.chain.limb_names.index("left_upper_arm")
    hanging.balls[arm] = someone(whole, "standing").balls[arm]
    found = shaken(sketch, with_arms_found(sketch, hanging), (0.1, 0.05), 16)
    hand = whole.chain.limb_names.index("left_hand")
    there, before, now = (posed(whole.chain, p).centres[hand] for p in (truth, hanging, found))
    assert np.linalg.norm(before - there) > 0.3
    assert np.linalg.norm(now - there) < 0.12  # near enough to be fitted
    assert sketch.worth(found) > sketch.worth(hanging)


def test_searching_twice_finds_the_same(shot, whole):
    views, masks, pose = shot
    sketch = sketch_of(whole, views, masks)
    one, two = (shaken(sketch, pose, (0.1,), 4, ["left_thigh"]) for _ in range(2))
    assert_allclose(whole.parameters(one), whole.parameters(two), atol=0)


def test_places_of_an_arm_are_mirrored_and_within_reach(whole):
    poses = list(arm_places(whole.chain, someone(whole), "right"))
    assert len(poses) > 300
    for pose in poses[::40]:
        assert_allclose(limited(whole.chain, pose).balls, pose.balls, atol=1e-6)


@pytest.mark.parametrize("lies", [False, True])
def test_cameras_cut_a_person_out_together(ring, whole, rng, lies):
    middle = np.array([0.0, 0.4 if lies else 0.95, 0.0])
    up = np.array([0.9, 0.1, 0.42]) if lies else np.array([0.0, 1, 0])
    up /= np.linalg.norm(up)
    pose = facing(standing(whole.chain), middle, np.array([0.3, -1.0, 0.2]) if lies else
                  np.array([1.0, 0, 0.3]), up)  # fmt: skip
    points = whole.skinned(posed(whole.chain, pose))
    views = [view_of(camera, 320) for camera in ring(4, target=middle)]
    pictures, truth = [], []
    for i, view in enumerate(views):
        person = Canvas(view, whole, 6).draw(points).limbs >= 0
        picture = np.full((*person.shape, 3), (150, 150, 140), dtype=np.float64)
        picture[person] = (50, 70, 150)
        if i == 0:  # a poster of the same colour, which the other cameras know nothing of
            picture[10:60, 10:80] = (50, 70, 150)
        noisy = picture + rng.normal(scale=4, size=picture.shape)
        pictures.append(np.clip(noisy, 0, 255).astype(np.uint8))
        truth.append(person)
    masks = cut_out_together(views, pictures, middle)
    for mask, person in zip(masks, truth, strict=True):
        assert ((mask > 0) & person).sum() / ((mask > 0) | person).sum() > 0.85
    assert cut_out_together(views, [None, *pictures[1:]], middle)[0] is None
