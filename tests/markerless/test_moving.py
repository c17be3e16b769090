"""What has moved before a room that nobody has photographed empty."""

from dataclasses import dataclass, replace

import numpy as np
import pytest

from kinesphere.data import Frame
from kinesphere.markerless.cutting import cut_out_together
from kinesphere.markerless.hypotheses import arm_poses, facing, standing
from kinesphere.markerless.moving import instants_about, moved_since, rooms
from kinesphere.markerless.pose import posed
from kinesphere.markerless.rim import Canvas
from kinesphere.markerless.views import view_of
from kinesphere.synthetic.film import make_film


@dataclass(frozen=True)
class Blank:
    """Footage that shows nothing, and counts."""

    def frames(self, start, stop, step=1):
        return (Frame(i, (None,) * 4, (None,) * 4) for i in range(start, stop, step))


@pytest.fixture(scope="module")
def scene():
    return make_film(1, "arms", n_frames=1, size=(64, 48)).scene


def pictures_of_a_square(rng, columns):
    """Return images of one room with a red square that is elsewhere in each."""
    room = np.full((120, 160, 3), (120, 130, 125)) + rng.normal(scale=15, size=(120, 160, 1))
    out = []
    for column in columns:
        picture = room.copy()
        picture[50:80, column : column + 20] = (190, 60, 50)
        noisy = picture + rng.normal(scale=2, size=picture.shape)
        out.append(np.clip(noisy, 0, 255).astype(np.uint8))
    return out


def test_what_moves_is_told_from_the_room(rng, ring):
    pictures = pictures_of_a_square(rng, (10, 40, 70, 100, 130))
    frames = [Frame(i, (p,), (None,)) for i, p in enumerate(pictures)]
    view = replace(view_of(ring(1)[0], 640), width=640)  # the camera's own size: as it is
    (room,) = rooms([view], frames)
    found = moved_since(pictures[1], room) > 0
    truth = np.zeros_like(found)
    truth[50:80, 40:60] = True
    assert (found & truth).sum() / (found | truth).sum() > 0.8


def test_what_stays_has_not_moved(rng):
    first, second = pictures_of_a_square(rng, (40, 40))
    assert not moved_since(first, second).any()


def test_other_light_or_another_room_moves_nothing(rng):
    first, _ = pictures_of_a_square(rng, (40, 40))
    assert not moved_since((first * 0.8).astype(np.uint8), first).any()
    tinted = first.copy()
    tinted[:, 50:, 2] = 20  # two thirds of the image: nobody is that large
    assert not moved_since(tinted, first).any()


def test_two_images_are_no_room(rng, ring):
    frames = [
        Frame(i, (p, None), (None,) * 2) for i, p in enumerate(pictures_of_a_square(rng, (9, 9)))
    ]
    views = [view_of(camera, 640) for camera in ring(2)]
    assert rooms(views, frames) == [None, None]


@pytest.mark.parametrize(("n_frames", "first"), [(1, 0), (5, 4), (300, 0), (300, 299), (3000, 900)])
def test_instants_are_of_the_scene_and_about_the_start(scene, n_frames, first):
    whole = replace(scene, n_frames=n_frames, footage=Blank())
    at = [frame.index for frame in instants_about(whole, first)]
    assert 0 <= min(at) <= max(at) < n_frames
    assert len(at) >= min(n_frames, 11)
    assert abs(np.median(at) - first) <= 6 * scene.rate
    assert len(at) <= 2 * 11


def test_a_bare_arm_that_moves_is_cut_out_too(ring, whole, rng):
    middle = np.array([0.0, 0.95, 0.0])
    pose = facing(standing(whole.chain), middle, np.array([1.0, 0, 0.3]))
    pose = list(arm_poses(whole.chain, pose, "left"))[20]
    points = whole.skinned(posed(whole.chain, pose))
    arm = [whole.chain.limb_names.index(f"left_{b}") for b in ("forearm", "hand")]
    views = [view_of(camera, 320) for camera in ring(4, target=middle)]
    pictures, moved, bare = [], [], []
    for view in views:
        limbs = Canvas(view, whole, 6).draw(points).limbs
        picture = np.full((*limbs.shape, 3), (150, 150, 140), dtype=np.float64)
        picture[limbs >= 0] = (50, 70, 150)
        skin = np.isin(limbs, arm)
        picture[skin] = (196, 152, 128)
        noisy = picture + rng.normal(scale=4, size=picture.shape)
        pictures.append(np.clip(noisy, 0, 255).astype(np.uint8))
        moved.append(skin.astype(np.uint8) * 255)
        bare.append(skin)
    known = cut_out_together(views, pictures, middle, moved)
    unknown = cut_out_together(views, pictures, middle)

    def held(masks):
        both = sum(((m > 0) & b).sum() for m, b in zip(masks, bare, strict=True))
        return both / sum(b.sum() for b in bare)

    assert held(known) > 0.8
    assert held(known) > held(unknown)


def test_where_somebody_stood_before_is_not_cut_out(ring, whole, rng):
    middle = np.array([0.0, 0.95, 0.0])
    pose = facing(standing(whole.chain), middle, np.array([1.0, 0, 0.3]))
    before = replace(pose, position=pose.position + np.array([0.12, 0, 0.1]))
    views = [view_of(camera, 320) for camera in ring(4, target=middle)]
    pictures, moved, truth = [], [], []
    for view in views:
        now, then = (
            Canvas(view, whole, 6).draw(whole.skinned(posed(whole.chain, p))).limbs >= 0
            for p in (pose, before)
        )
        picture = np.full((*now.shape, 3), (150, 150, 140), dtype=np.float64)
        picture[now] = (50, 70, 150)
        noisy = picture + rng.normal(scale=4, size=picture.shape)
        pictures.append(np.clip(noisy, 0, 255).astype(np.uint8))
        moved.append((now ^ then).astype(np.uint8) * 255)
        truth.append(now)
    for mask, person in zip(cut_out_together(views, pictures, middle, moved), truth, strict=True):
        assert ((mask > 0) & person).sum() / ((mask > 0) | person).sum() > 0.85
