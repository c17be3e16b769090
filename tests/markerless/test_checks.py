"""Cameras that fit agree; one that is turned, swapped or late is found."""

from dataclasses import dataclass, replace
from itertools import combinations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

pytest.importorskip("cv2")

from kinesphere.data import Footage
from kinesphere.markerless.checks import AGREE, check_scene
from kinesphere.markerless.consistency import disagreement, find_culprit, find_lateness, sights
from kinesphere.markerless.entrance import with_person_in_view
from kinesphere.markerless.mixups import find_swap, person_size
from kinesphere.synthetic.film import make_film

pytestmark = pytest.mark.slow  # rendering takes long in plain Python

SIZE = (320, 240)
DIAGONAL = float(np.hypot(*SIZE))


@pytest.fixture(scope="module")
def film():
    """Arms swinging before four cameras, masks alone: quick."""
    made = make_film(3, "arms", size=SIZE, n_frames=24, masks=True)
    footage = replace(made.footage, with_images=False)
    return replace(made, scene=replace(made.scene, footage=footage))


@pytest.fixture(scope="module")
def masks(film):
    return [frame.masks for frame in film.scene.frames()]


@dataclass(frozen=True)
class Late:
    """Footage of which one camera shows everything some frames late."""

    footage: Footage
    camera: int
    frames_late: int

    def frames(self, start, stop, step=1):
        for i in range(start, stop, step):
            now = next(iter(self.footage.frames(i, i + 1, 1)))
            then = max(0, i - self.frames_late)
            late = next(iter(self.footage.frames(then, then + 1, 1)))
            mixed = list(now.masks)
            mixed[self.camera] = late.masks[self.camera]
            yield replace(now, masks=tuple(mixed))


@dataclass(frozen=True)
class Gone:
    """Footage in which nobody is there in some frames."""

    footage: Footage
    gone: range

    def frames(self, start, stop, step=1):
        for frame in self.footage.frames(start, stop, step):
            empty = tuple(np.zeros_like(mask) for mask in frame.masks)
            yield replace(frame, masks=empty) if frame.index in self.gone else frame


def turned(camera, degrees):
    turn = Rotation.from_rotvec([0, np.radians(degrees), 0]).as_matrix()
    return camera.turned(turn, camera.centre - turn @ camera.centre)


def test_true_cameras_agree(film, masks):
    assert disagreement(sights(film.scene.cameras, masks[::6])) < 1.0


def test_disagreement_grows_with_the_error(film, masks):
    cameras = list(film.scene.cameras)
    apart = []
    for degrees in (0.0, 1.0, 3.0):
        cameras[2] = turned(film.scene.cameras[2], degrees)
        apart.append(disagreement(sights(cameras, masks[::6])))
    assert apart[0] < apart[1] < apart[2]
    assert apart[2] > 2 * AGREE * DIAGONAL


@pytest.mark.parametrize("wrong", range(4))
def test_the_camera_that_is_turned_is_found(film, masks, wrong):
    cameras = list(film.scene.cameras)
    cameras[wrong] = turned(cameras[wrong], 3.0)
    assert find_culprit(sights(cameras, masks[::6])) == wrong


def test_the_order_of_cameras_does_not_matter(film, masks):
    order = [2, 0, 3, 1]
    cameras = list(film.scene.cameras)
    cameras[1] = turned(cameras[1], 2.0)
    straight = disagreement(sights(cameras, masks[::6]))
    shuffled = disagreement(
        sights([cameras[k] for k in order], [tuple(m[k] for k in order) for m in masks[::6]])
    )
    assert shuffled == pytest.approx(straight, abs=0.5)


def test_turning_the_world_changes_nothing(film, masks):
    turn, shift = Rotation.from_rotvec([0.3, -1.0, 0.5]).as_matrix(), np.array([4.0, -2.0, 1.0])
    cameras = [turned(c, 1.0 * (i == 0)) for i, c in enumerate(film.scene.cameras)]
    there = disagreement(sights([c.turned(turn, shift) for c in cameras], masks[::6]))
    assert there == pytest.approx(disagreement(sights(cameras, masks[::6])), abs=0.5)


@pytest.mark.parametrize("frames_late", [-3, 3])
def test_the_camera_that_is_late_is_found(film, masks, frames_late):
    n = len(masks)
    mixed = []
    for t in range(3, n - 3):
        row = list(masks[t])
        row[1] = masks[t - frames_late][1]
        mixed.append(tuple(row))
    late, *_ = find_lateness(sights(film.scene.cameras, mixed), 4)
    assert (late.camera, late.frames) == (1, frames_late)
    assert late.mended > 0.6


def test_a_scene_in_order_has_nothing_to_say(film):
    step = check_scene(film.scene)
    assert step.warnings == ()
    assert step.findings["checked"] is True


def test_a_late_camera_is_named_with_its_remedy(film):
    late = replace(film.scene, footage=Late(film.scene.footage, 2, 3), offsets=(0, 0, 5, 0))
    (warning,) = check_scene(late).warnings
    assert "cam03 seems to show everything 3 frames later than the others" in warning
    assert "offset = 8 in the [[camera]] of cam03" in warning


def test_people_who_come_and_go_are_no_late_camera(film):
    gone = replace(film.scene, footage=Gone(film.scene.footage, range(9, 14)))
    assert check_scene(gone).warnings == ()


def test_a_wrong_calibration_is_named(film):
    cameras = list(film.scene.cameras)
    cameras[0] = turned(cameras[0], 4.0)
    warnings = check_scene(replace(film.scene, cameras=tuple(cameras))).warnings
    assert any("cam01 does not fit the others" in warning for warning in warnings)


@pytest.mark.parametrize("degrees", [0.7, 3.0])
def test_of_perfect_cameras_one_that_is_off_is_named_alone(film, degrees):
    """However little: what the others say leaves no doubt which it is."""
    cameras = list(film.scene.cameras)
    cameras[1] = turned(cameras[1], degrees)
    warnings = check_scene(replace(film.scene, cameras=tuple(cameras))).warnings
    assert any("cam02 does not fit the others" in warning for warning in warnings)
    assert not any(name in w for w in warnings for name in ("cam01", "cam03", "cam04"))


@pytest.mark.parametrize(
    "way", [np.eye(3), Rotation.from_euler("x", -90, degrees=True).as_matrix()]
)
def test_a_calibration_from_camera_to_world_is_recognised(film, way):
    cameras = [
        replace(
            c,
            rotation=(c.rotation @ way).T @ way.T,
            translation=-(c.rotation @ way).T @ c.translation,
        )
        for c in film.scene.cameras
    ]
    wrong = replace(film.scene, cameras=tuple(cameras), world_from_file=way)
    (warning,) = check_scene(wrong).warnings
    assert "seems to be camera-to-world" in warning


def test_an_offset_beyond_the_usual_is_looked_for(film):
    long = make_film(3, "arms", size=SIZE, n_frames=40, masks=True)
    footage = replace(long.footage, with_images=False)
    scene = replace(long.scene, footage=Late(footage, 1, 10))
    scene = replace(scene, start=replace(scene.start, frame=10))
    (warning,) = check_scene(scene).warnings
    assert "offset = 10 in the [[camera]] of cam02" in warning


def test_one_video_for_two_cameras_is_doubted(film):
    @dataclass(frozen=True)
    class Twice:
        def frames(self, start, stop, step=1):
            rng = np.random.default_rng(3)
            for frame in film.scene.footage.frames(start, stop, step):
                a, b, c = rng.integers(0, 255, (3, 4, 5, 3), dtype=np.uint8)
                yield replace(frame, images=(a, b, c, b))

    warnings = check_scene(replace(film.scene, footage=Twice())).warnings
    assert warnings[0].startswith("cam02 and cam04 show the same picture")


@pytest.mark.parametrize(("one", "other"), list(combinations(range(4), 2)))
def test_exchanged_cameras_are_named(film, one, other):
    """Opposite ones, too, whose silhouettes are nearly each other's mirror image."""
    cameras = list(film.scene.cameras)
    cameras[one], cameras[other] = (
        replace(cameras[other], name=cameras[one].name),
        replace(cameras[one], name=cameras[other].name),
    )
    (warning,) = check_scene(replace(film.scene, cameras=tuple(cameras))).warnings
    assert f"cam0{one + 1} and cam0{other + 1} seem to be exchanged" in warning


def test_two_cameras_cannot_tell_that_they_are_exchanged(film, masks):
    cameras = film.scene.cameras[:2][::-1]
    assert find_swap(cameras, [m[:2] for m in masks]) is None


@pytest.mark.parametrize("scale", [0.1, 3.0])
def test_a_person_of_a_size_nobody_has_means_a_wrong_unit(film, masks, scale):
    cameras = tuple(replace(c, translation=c.translation * scale) for c in film.scene.cameras)
    size = person_size(film.scene.cameras, masks[::6])
    assert 1.6 < size < 2.3
    assert person_size(cameras, masks[::6]) == pytest.approx(scale * size, rel=1e-6)
    warnings = check_scene(replace(film.scene, cameras=cameras)).warnings
    assert any("calibration's unit is wrong" in warning for warning in warnings)


def test_without_masks_or_plates_it_says_that_nothing_was_checked(film):
    (warning,) = check_scene(replace(film.scene, has_masks=False)).warnings
    assert "neither masks nor plates" in warning


def test_empty_masks_are_said(film):
    @dataclass(frozen=True)
    class Blind:
        def frames(self, start, stop, step=1):
            for frame in film.scene.footage.frames(start, stop, step):
                empty = (np.zeros(SIZE[::-1], dtype=bool), *frame.masks[1:])
                yield replace(frame, masks=empty)

    warnings = check_scene(replace(film.scene, footage=Blind())).warnings
    assert "cam01 shows no silhouette in any frame looked at" in warnings[0]


def test_a_room_that_is_empty_at_first_moves_the_start(film):
    scene = replace(film.scene, footage=Gone(film.scene.footage, range(7)), first_frame=10)
    found = with_person_in_view(scene)
    assert found.start.frame == 7
    (warning,) = found.history[-1].warnings
    assert warning == ("frame 11 shows nobody in two cameras; the start was looked for in frame 18")


def test_a_start_that_shows_the_person_or_is_given_stays(film):
    assert with_person_in_view(film.scene) is film.scene
    gone = replace(film.scene, footage=Gone(film.scene.footage, range(7)))
    given = replace(gone, start=replace(gone.start, pose="given", values={"x": 0.0}))
    assert with_person_in_view(given) is given
    blind = replace(gone, has_masks=False)
    assert with_person_in_view(blind) is blind


def test_a_film_of_nobody_stays_as_it_is(film):
    nobody = replace(film.scene, footage=Gone(film.scene.footage, range(24)))
    assert with_person_in_view(nobody) is nobody
