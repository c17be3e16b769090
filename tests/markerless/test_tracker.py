"""A whole film tracked: truth, gaps, ways of starting, what is said of lost limbs."""

from dataclasses import dataclass, replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from kinesphere.data import BodyChoice, Frame, StartChoice, bundled_body
from kinesphere.errors import BadScene, BadSetting
from kinesphere.markerless.anatomy import full_body
from kinesphere.markerless.eyes import fitter_for
from kinesphere.markerless.first_pose import FirstPose, first_pose
from kinesphere.markerless.pose import moved, posed
from kinesphere.markerless.settings import TrackSettings
from kinesphere.markerless.shape import FACTORS
from kinesphere.markerless.tracker import track
from kinesphere.markerless.tracking import Tracking
from kinesphere.markerless.watching import backwards, masks_throughout
from kinesphere.synthetic.film import make_film

pytestmark = pytest.mark.slow

N = 10
SIZE = (320, 240)
QUICK = TrackSettings(shape_rounds=0)


@dataclass(frozen=True)
class Shots:
    """Frames that were rendered before."""

    shots: tuple[Frame, ...]

    def frames(self, start, stop, step=1):
        return iter(self.shots[start:stop:step])


@dataclass(frozen=True)
class Stopping(Shots):
    """Footage during whose longest run somebody presses Ctrl-C."""

    at: int

    def frames(self, start, stop, step=1):
        for frame in super().frames(start, stop, step):
            if frame.index == self.at and stop - start > 1:
                raise KeyboardInterrupt
            yield frame


@pytest.fixture(scope="module")
def film():
    return make_film(1, "arms", n_frames=N, plates=True, size=SIZE)


@pytest.fixture(scope="module")
def shots(film):
    """Return the frames; of the first one the silhouettes are given."""
    first, *others = film.scene.frames()
    return (replace(first, masks=first.references), *others)


def scene_of(film, shots, **changes):
    body = changes.pop("body", BodyChoice(fit=False))
    whole = {"has_masks": True, "plates": (None,) * 4, **changes}
    return replace(film.scene, footage=Shots(shots), n_frames=len(shots), body=body, **whole)


def errors(motion, film, order=slice(None)):
    at = {name: i for i, name in enumerate(motion.limb_names)}
    return np.stack(
        [
            np.linalg.norm(motion.origins[:, at[name]] - centres[order][: motion.n_frames], axis=1)
            for name, centres in film.joint_centres.items()
        ],
        axis=1,
    )


@pytest.fixture(scope="module")
def motion(film, shots):
    heard = []
    tracked = track(scene_of(film, shots), bundled_body(), QUICK, lambda *a: heard.append(a))
    assert heard[-1] == ("tracking", N, N)
    return tracked


def test_from_its_own_start_the_person_is_followed(motion, film):
    assert motion.solved.all()
    assert errors(motion, film).mean() < 0.010  # a quarter of the usual image size in pixels
    assert not motion.lost.any()
    assert np.nanmin(motion.support[:, 1]) > 0.6
    assert motion.overlap.min() > 0.8


def test_the_result_is_complete_and_of_one_piece(motion):
    limbs = len(motion.limb_names)
    assert motion.limb_names[0] == "pelvis"
    assert motion.limb_parents[0] == -1
    assert all(p < i for i, p in enumerate(motion.limb_parents))
    assert len(motion.joint_names) == limbs - 1
    assert {"left_elbow", "right_knee", "lumbar", "neck"} <= set(motion.joint_names)
    assert motion.parameters.shape == (N, len(motion.parameter_names))
    turns = motion.rotations
    assert_allclose(
        np.swapaxes(turns, -1, -2) @ turns, np.broadcast_to(np.eye(3), turns.shape), atol=1e-9
    )
    surface = motion.body.vertices(motion.parameters[3])
    assert surface.shape[1] == 3
    assert len(motion.body.limb_of_face) == len(motion.body.faces)
    assert motion.body.limb_of_face.max() < limbs
    # a limb's end is where the next one begins
    forearm, hand = motion.limb_names.index("left_forearm"), motion.limb_names.index("left_hand")
    end = motion.origins[:, forearm] + motion.rotations[:, forearm] @ motion.ends[forearm]
    assert_allclose(end, motion.origins[:, hand], atol=1e-3)


def test_the_same_input_gives_the_same_output(motion, film, shots):
    again = track(scene_of(film, shots), bundled_body(), QUICK)
    assert np.array_equal(again.parameters, motion.parameters)


def near_truth(motion, frame):
    """Return a first pose from what was tracked before."""
    pose = motion.body.pose(motion.parameters[frame])
    return FirstPose(pose, np.zeros(len(FACTORS)), float("nan"), "given")


def test_watched_backwards_the_poses_are_the_same(motion, film, shots):
    middle = 6
    scene = scene_of(film, shots, start=StartChoice(frame=middle))
    there = track(scene, bundled_body(), QUICK, start=near_truth(motion, middle))
    assert there.solved.all()
    assert errors(there, film).mean() < 0.012
    apart = np.linalg.norm(there.origins - motion.origins, axis=2)
    assert np.median(apart) < 0.004


def test_frames_without_images_are_gaps_and_tracking_resumes(motion, film, shots):
    holes = list(shots)
    for i in (4, 5):
        holes[i] = replace(holes[i], images=(None,) * 4)
    holes[7] = replace(holes[7], images=(None, *holes[7].images[1:]))
    scene = scene_of(film, tuple(holes))
    tracked = track(scene, bundled_body(), QUICK, start=near_truth(motion, 0))
    assert tracked.solved.tolist() == [i not in (4, 5) for i in range(N)]
    assert np.isnan(tracked.overlap[7, 0])
    assert np.isfinite(tracked.overlap[7, 1:]).all()
    assert np.nanmean(errors(tracked, film)[6:]) < 0.015
    assert "no camera has an image in frames 5–6: no pose there" in tracked.history[-1].warnings


def test_who_leaves_has_no_pose_and_is_found_again(motion, film, shots):
    left = list(shots)
    for i in (4, 5):
        left[i] = replace(left[i], images=film.scene.plates)
    scene = scene_of(film, tuple(left))
    tracked = track(scene, bundled_body(), QUICK, start=near_truth(motion, 0))
    assert tracked.solved.tolist() == [i not in (4, 5) for i in range(N)]
    assert np.nanmean(errors(tracked, film)[6:]) < 0.015
    assert "nobody is seen in frames 5–6: no pose there" in tracked.history[-1].warnings


def test_interrupted_it_keeps_what_it_has(motion, film, shots):
    scene, start = scene_of(film, shots), near_truth(motion, 0)
    whole = track(scene, bundled_body(), QUICK, start=start)
    stopping = replace(scene, footage=Stopping(shots, 6))
    tracked = track(stopping, bundled_body(), QUICK, start=start)
    assert (whole.n_reached, tracked.n_reached) == (None, 6)
    assert tracked.solved.tolist() == [i < 6 for i in range(N)]
    assert np.array_equal(tracked.parameters[:6], whole.parameters[:6])
    assert "interrupted after 6 of 10 frames" in tracked.history[-1].warnings[0]


def test_a_doubtful_start_is_said_at_once_and_first(motion, film, shots):
    said = []
    start = replace(near_truth(motion, 0), doubt="an arm may be elsewhere", warnings=("else",))
    few = scene_of(film, shots[:2])
    tracked = track(few, bundled_body(), QUICK, start=start, notice=said.append)
    assert said == ["an arm may be elsewhere"]
    assert tracked.start_doubt == said[0]
    assert tracked.history[-1].warnings[:2] == (said[0], "else")
    assert motion.start_doubt == ""


def test_interrupted_before_anything_was_found_it_stops(motion, film, shots):
    scene = replace(scene_of(film, shots), footage=Stopping(shots, 0))
    with pytest.raises(KeyboardInterrupt):
        track(scene, bundled_body(), QUICK, start=near_truth(motion, 0))


def test_arms_that_slip_are_held_lost_and_mostly_found_again():
    film = make_film(0, "arms", conditions="clutter", n_frames=1)
    shot = next(film.scene.frames())
    scene = replace(film.scene, body=BodyChoice(fit=False), has_masks=True)
    body = full_body(bundled_body())
    first = first_pose(
        scene, bundled_body(), full_body, QUICK, replace(shot, masks=shot.references)
    )
    names = list(body.parameter_names)
    arm = [body.chain.limb_names.index(f"left_{b}") for b in ("upper_arm", "forearm", "hand")]
    truth = film.joint_centres["left_hand"][0]
    back = []
    for turn, size in (("turn1", -1.2), ("turn3", 1.2), ("turn2", 1.2)):
        step = np.zeros(len(names))
        step[names.index(f"left_upper_arm.{turn}")] = size
        tracking = Tracking(fitter_for(body, scene.cameras, QUICK, masks=False), first.pose)
        assert not tracking.begin(shot.images).lost[arm].any()
        tracking.last, tracking.before = moved(body.chain, tracking.last, step), None
        found = [tracking.step(shot.images) for _ in range(8)]
        assert found[0].lost[arm].any()
        hand = posed(body.chain, found[-1].pose).centres[arm[-1]]
        back.append(np.linalg.norm(hand - truth) < 0.06)
        assert back[-1] == (not found[-1].lost[arm[:2]].any())
    assert sum(back) >= 2


def test_masks_in_place_of_images(film, shots):
    masked = tuple(replace(s, masks=s.references) for s in shots[:5])
    scene = scene_of(film, masked)
    assert masks_throughout(scene, 0)
    tracked = track(scene, bundled_body(), QUICK)
    assert errors(tracked, film).mean() < 0.008


def test_masks_of_one_frame_serve_the_start_only(film, shots):
    assert not masks_throughout(scene_of(film, shots), 0)
    assert not masks_throughout(scene_of(film, shots, has_masks=False), 0)


def test_where_masks_end_or_are_missing_colours_go_on(film, shots):
    masked = (0, 1, 2, 6, 7)
    some = tuple(replace(s, masks=s.references) if s.index in masked else s for s in shots)
    tracked = track(scene_of(film, some), bundled_body(), QUICK)
    assert tracked.solved.all()
    assert errors(tracked, film).mean(axis=1).max() < 0.012
    said = "no camera has a mask in frames 4–6 and 9–10: followed by colours there"
    assert said in tracked.history[-1].warnings


def test_plates_serve_the_start(film, shots):
    bare = (replace(shots[0], masks=(None,) * 4), *shots[1:3])
    scene = scene_of(film, bare, has_masks=False, plates=film.scene.plates, body=BodyChoice())
    assert errors(track(scene, bundled_body(), QUICK), film).mean() < 0.03


def test_the_papers_methods_follow_too(motion, film, shots):
    for method in ("level-set", "coupled"):
        settings = replace(QUICK, method=method)
        start = near_truth(motion, 0)
        tracked = track(scene_of(film, shots[:6]), bundled_body(), settings, start=start)
        assert errors(tracked, film).mean() < 0.02


def test_the_upper_body_alone(film, shots):
    scene = scene_of(film, shots[:5], body=BodyChoice(model="upper", fit=False))
    tracked = track(scene, bundled_body(), QUICK)
    assert tracked.parameters.shape[1] == 21
    at = {name: i for i, name in enumerate(tracked.limb_names)}
    hand = film.joint_centres["left_hand"][:5]
    assert np.linalg.norm(tracked.origins[:, at["left_hand"]] - hand, axis=1).mean() < 0.03


def test_a_given_pose_by_name(film, shots):
    scene = scene_of(
        film, shots[:1], start=StartChoice(pose="given", values={"pelvis.shift2": 0.9})
    )
    tracked = track(scene, bundled_body(), QUICK)
    assert tracked.solved.all()
    wrong = scene_of(film, shots[:1], start=StartChoice(pose="given", values={"nose": 0.1}))
    with pytest.raises(BadScene, match="no parameter nose"):
        track(wrong, bundled_body(), QUICK)


def test_an_unknown_model_is_named(film, shots):
    scene = scene_of(film, shots, body=BodyChoice(model="octopus"))
    with pytest.raises(BadSetting, match=r"octopus.*full, upper"):
        track(scene, bundled_body(), QUICK)


def test_backwards_is_the_reverse_in_pieces(film, shots):
    many = tuple(replace(shots[0], index=i) for i in range(60))
    scene = scene_of(film, many)
    assert [f.index for f in backwards(scene, 57)] == list(range(57, -1, -1))
    assert list(backwards(scene, 0)) == []
