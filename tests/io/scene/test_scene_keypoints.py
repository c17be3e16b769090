"""Keypoints beside a scene: the right file of the right camera, and what does not fit is said."""

import json
import shutil

import numpy as np
import pytest
from numpy.testing import assert_allclose

from kinesphere.data.directions import world_from_up
from kinesphere.data.keypoints import KEYPOINTS, PlacedKeypoints, SeenKeypoints
from kinesphere.errors import BadScene, UnreadableFile
from kinesphere.io.keypoints import SETS, keypoint_columns, read_people
from kinesphere.io.scene import read_scene
from kinesphere.io.scene.keypoints import start_keypoints
from kinesphere.io.trc import write_trc

NOSE, ANKLE = KEYPOINTS.index("nose"), KEYPOINTS.index("left_ankle")


def person(n=25, at=0.0, confidence=0.9):
    """Return a person whose keypoint i is at (at + i, at + 2 i)."""
    i = np.arange(n)
    return {
        "pose_keypoints_2d": np.stack([at + i, at + 2 * i, np.full(n, confidence)], 1)
        .ravel()
        .tolist()
    }


def write_people(path, *people):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(json.dumps({"version": 1.3, "people": list(people)}))
    return path


@pytest.fixture
def keyed(folder):
    """Return a scene whose start is in frame 3, with keypoints at (100 × frame + i, …)."""
    for camera in ("cam01", "cam02", "cam03"):
        for frame in range(8):
            name = f"{camera}_{frame:012d}_keypoints.json"
            write_people(folder / "pose" / f"{camera}_json" / name, person(at=100.0 * frame))
    scene = folder / "SCENE.toml"
    scene.write_text(scene.read_text() + '\n[start]\nframe = 3\nkeypoints = "pose"\n')
    return folder


def said(scene):
    return " ".join(scene.history[0].warnings)


@pytest.mark.parametrize("n", SETS)
def test_every_set_knows_its_joints(tmp_path, n):
    people = read_people(write_people(tmp_path / "a.json", person(n)))
    names = SETS[n][1]
    assert people.shape == (1, len(KEYPOINTS), 3)
    assert people[0, ANKLE].tolist() == [
        names.index("left_ankle"), 2 * names.index("left_ankle"), 0.9,
    ]  # fmt: skip
    assert people[0, NOSE, 0] == 0


def test_sets_are_as_published():
    """BODY_25 and HALPE_26 by their papers' figures, COCO by its annotations."""
    assert [SETS[25][1].index(n) for n in ("right_wrist", "left_hip", "left_ear", "left_heel")] == [
        4, 12, 18, 21,
    ]  # fmt: skip
    assert [SETS[26][1].index(n) for n in ("right_wrist", "left_hip", "right_heel")] == [10, 11, 25]
    assert [SETS[17][1].index(n) for n in ("right_ear", "left_shoulder", "right_ankle")] == [
        4, 5, 16,
    ]  # fmt: skip
    assert [SETS[18][1].index(n) for n in ("right_hip", "left_ankle", "left_ear")] == [8, 13, 17]
    assert [len(SETS[n][1]) for n in (17, 18, 25, 26)] == [17, 18, 25, 26]


def test_what_was_not_seen_has_no_place(tmp_path):
    path = tmp_path / "a.json"
    one = person()
    one["pose_keypoints_2d"][0:3] = [0, 0, 0]
    one["pose_keypoints_2d"][12] = 1e300  # its right wrist
    write_people(path, one, {}, {"pose_keypoints_2d": []})
    path.write_text(path.read_text().replace("14.0, 28.0", "NaN, NaN"))  # BODY_25's left ankle
    people = read_people(path)
    assert len(people) == 1
    for k in (NOSE, ANKLE, KEYPOINTS.index("right_wrist")):
        assert np.isnan(people[0, k, :2]).all()
        assert people[0, k, 2] == 0


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("", "is empty"),
        ('{"people": [', "is no JSON"),
        ("[1, 2]", '"people"'),
        ('{"people": 3}', '"people"'),
        ('{"people": [7]}', "pose_keypoints_2d"),
        ('{"people": [{"pose_keypoints_2d": [1, 2, "x"]}]}', "else than numbers"),
        ('{"people": [{"pose_keypoints_2d": [[1], 2, 3]}]}', "else than numbers"),
        ('{"people": [{"pose_keypoints_2d": [1, 2, 0.5]}]}', "25 .BODY_25."),
        ('{"people": [{"pose_keypoints_2d": [1, 2]}]}', "0.666667 keypoints"),
    ],
)
def test_other_files_are_refused_in_one_line(tmp_path, text, says):
    path = tmp_path / "a.json"
    path.write_text(text)
    with pytest.raises(UnreadableFile, match=says) as error:
        read_people(path)
    assert "\n" not in str(error.value)


def test_labels_of_trc_files_are_understood():
    columns = keypoint_columns(["RShoulder", "left_hip", "L_Knee", "Neck", "RBigToe", "Nose", "C7"])
    assert columns == {
        "right_shoulder": 0, "left_hip": 1, "left_knee": 2, "right_big_toe": 4, "nose": 5,
    }  # fmt: skip


@pytest.mark.slow
def test_the_start_frame_of_every_camera_is_read(keyed):
    scene = read_scene(keyed / "SCENE.toml")
    seen = scene.start.keypoints
    assert isinstance(seen, SeenKeypoints)
    assert_allclose(seen.pixels[:, NOSE], 300)
    assert (scene.start.frame, said(scene)) == (3, "")


@pytest.mark.slow
def test_an_offset_shifts_keypoints_with_their_images(keyed):
    path = keyed / "SCENE.toml"
    path.write_text(path.read_text().replace('name = "cam02"\n', 'name = "cam02"\noffset = 2\n'))
    assert read_scene(path).start.keypoints.pixels[:, NOSE, 0].tolist() == [300, 500, 300]


@pytest.mark.slow
def test_of_several_people_the_surest_is_taken_and_said(keyed):
    half = person(at=9.0)
    half["pose_keypoints_2d"][2 * 3 + 2 :: 3] = [0.1] * 23
    write_people(keyed / "pose/cam02_json/cam02_000000000003_keypoints.json", half, person(at=5.0))
    scene = read_scene(keyed / "SCENE.toml")
    assert scene.start.keypoints.pixels[1, NOSE, 0] == 5
    assert "shows 2 people" in said(scene)


@pytest.mark.slow
def test_missing_files_and_other_counts_are_said(keyed):
    (keyed / "pose/cam01_json/cam01_000000000003_keypoints.json").unlink()
    shutil.rmtree(keyed / "pose/cam03_json")
    scene = read_scene(keyed / "SCENE.toml")
    assert scene.start.keypoints is None
    for words in ("has 7 files", "8 images", "it is not there", "no keypoints of cam03"):
        assert words in said(scene)
    assert "found by the images instead" in said(scene)


@pytest.mark.slow
def test_nothing_confident_falls_back_to_the_images(keyed):
    for camera in ("cam01", "cam02"):
        path = keyed / f"pose/{camera}_json/{camera}_000000000003_keypoints.json"
        write_people(path, person(confidence=0.1))
    scene = read_scene(keyed / "SCENE.toml")
    assert scene.start.keypoints is None
    assert "keypoints are confident in cam03" in said(scene)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("old", "new", "error", "says"),
    [
        ('"pose"', '"nowhere"', UnreadableFile, "no such keypoints"),
        ('"pose"', '"cam01"', BadScene, "called after two cameras"),
        ('"pose"', '"no.trc"', UnreadableFile, "no.trc"),
        ("frame = 3", 'pose = "given"\nvalues = { a = 1.0 }', BadScene, "needs no start.keypoints"),
    ],
)
def test_no_keypoints_are_an_error(keyed, old, new, error, says):
    path = keyed / "SCENE.toml"
    path.write_text(path.read_text().replace(old, new))
    with pytest.raises(error, match=says):
        read_scene(path)


@pytest.mark.slow
def test_a_trc_file_comes_in_metres_and_in_the_calibrations_axes(keyed, film, recording_of):
    points = np.random.default_rng(3).uniform(-0.3, 0.3, (8, 4, 3)) + np.array([0, 0.9, 0])
    labels = ("RShoulder", "LShoulder", "RHip", "LHip")
    write_trc(recording_of(points, labels, 25.0), keyed / "a.trc", "mm")
    path = keyed / "SCENE.toml"
    path.write_text(path.read_text().replace('"pose"', '"a.trc"'))
    placed = read_scene(path).start.keypoints
    assert isinstance(placed, PlacedKeypoints)
    at = [KEYPOINTS.index(n) for n in ("right_shoulder", "left_shoulder", "right_hip", "left_hip")]
    assert_allclose(placed.points[at], points[3], atol=1e-8)
    assert np.isnan(np.delete(placed.points, at, axis=0)).all()
    write_trc(recording_of(points + 50, labels, 25.0), keyed / "a.trc", "m")
    scene = read_scene(path)
    assert scene.start.keypoints is None
    assert "outside most images" in said(scene)
    write_trc(recording_of(points[:2], labels, 25.0), keyed / "a.trc", "m")
    scene = read_scene(path)
    assert scene.start.keypoints is None
    assert "2 rows, the cameras 8 frames" in said(scene)
    write_trc(recording_of(points, ("A", "B", "C", "D"), 25.0), keyed / "a.trc", "m")
    with pytest.raises(UnreadableFile, match="no label is a keypoint"):
        read_scene(path)


@pytest.mark.parametrize("axes", ["calibration", "y-up"])
def test_axes_of_a_trc_file_are_guessed_by_who_stands_upright(tmp_path, axes, film, recording_of):
    turn = world_from_up("+z")
    world = np.array([[0.1, 1.3, 0.2], [0.1, 1.3, -0.2], [0.1, 0.5, 0.1], [0.2, 0.1, -0.1]])
    calibration = world @ turn
    points = calibration if axes == "calibration" else calibration[:, [1, 2, 0]]
    labels = ("RShoulder", "LShoulder", "RKnee", "LAnkle")
    path = tmp_path / "a.trc"
    write_trc(recording_of(points[None], labels, 25.0), path, "m")
    for asked in (None, axes):
        found, words = start_keypoints(path, asked, (), film.scene.cameras, turn, 0, 1)
        at = [KEYPOINTS.index(n) for n in keypoint_columns(labels)]
        assert_allclose(found.points[at], world, atol=1e-8)
        assert [f'"{axes}" is guessed' in sentence for sentence in words] == [True] * (not asked)


@pytest.fixture
def recording_of():
    """Return what makes a recording of points."""
    from kinesphere.data import Recording

    return lambda points, labels, rate: Recording(points, labels, rate)
