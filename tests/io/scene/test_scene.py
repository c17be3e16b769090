"""Scenes from files: what was written comes back, and what does not fit is said in one line."""

import shutil

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from kinesphere.errors import BadScene, KinesphereError, UnreadableFile
from kinesphere.io.images import read_image, write_image
from kinesphere.io.scene import read_scene, write_scene

pytestmark = pytest.mark.slow  # rendering takes long in plain Python


def test_images_masks_plates_and_cameras_come_back(folder, film):
    scene = read_scene(folder / "SCENE.toml")
    assert (scene.n_frames, scene.rate, scene.has_masks) == (8, 25.0, True)
    for one, other in zip(scene.cameras, film.scene.cameras, strict=True):
        assert (one.name, one.width, one.height) == (other.name, other.width, other.height)
        assert_allclose(one.matrix, other.matrix, atol=1e-12)
        assert_allclose(one.centre, other.centre, atol=1e-12)
    frames = list(scene.frames(2, 7, 3))
    assert [frame.index for frame in frames] == [2, 5]
    truth = film.scene.frame(5)
    for kind in ("images", "masks"):
        for one, other in zip(getattr(frames[1], kind), getattr(truth, kind), strict=True):
            assert_array_equal(one, other)
    for one, other in zip(scene.plates, film.scene.plates, strict=True):
        assert_array_equal(one, other)
    assert scene.history[0].warnings == ()


@pytest.mark.parametrize(("kind", "loss"), [("mkv", 0.0), ("mp4", 4.0)])
def test_videos_are_decoded_frame_by_frame(tmp_path, film, kind, loss):
    pytest.importorskip("av")
    scene = read_scene(write_scene(film.scene, tmp_path / "v", kind))
    assert (scene.n_frames, scene.rate) == (8, 25.0)
    for one, other in zip(scene.frames(3), film.scene.frames(3), strict=True):
        assert one.index == other.index
        for a, b in zip(one.images, other.images, strict=True):
            assert np.abs(a.astype(int) - b).mean() <= loss
        assert_array_equal(one.masks[0], other.masks[0])


def test_offsets_shift_a_camera(changed, film):
    path = changed('images = "cam02"', 'images = "cam02"\noffset = 3')
    scene = read_scene(path)
    assert scene.n_frames == 5
    assert scene.offsets == (0, 3, 0)
    frame = scene.frame(1)
    assert_array_equal(frame.images[1], film.scene.frame(4).images[1])
    assert_array_equal(frame.masks[1], film.scene.frame(4).masks[1])
    assert_array_equal(frame.images[0], film.scene.frame(1).images[0])
    assert "unequal numbers of frames" in scene.history[0].warnings[0]


def test_a_camera_that_began_late_starts_the_scene_late(changed, film):
    scene = read_scene(changed('images = "cam02"', 'images = "cam02"\noffset = -2'))
    assert scene.offsets == (2, 0, 2)
    frame = scene.frame(0)
    assert_array_equal(frame.images[0], film.scene.frame(2).images[0])
    assert_array_equal(frame.images[1], film.scene.frame(0).images[1])


def test_only_the_frames_asked_for(changed, film):
    scene = read_scene(changed("rate_hz", "frames = [2, 5]\nrate_hz"))
    assert scene.n_frames == 4
    assert scene.first_frame == 2
    assert_array_equal(scene.frame(0).images[2], film.scene.frame(2).images[2])


def test_reference_masks_lie_beside(changed, film):
    path = changed("masks =", "reference_masks =", count=3)
    scene = read_scene(path)
    assert not scene.has_masks
    frame = scene.frame(4)
    assert frame.masks == (None,) * 3
    assert_array_equal(frame.references[1], film.scene.frame(4).masks[1])


def test_a_few_masks_belong_to_the_frames_of_their_numbers(folder, film):
    for i in (0, 1, 2, 4, 6, 7):
        (folder / "cam01_masks" / f"{i:06d}.png").unlink()
    frames = list(read_scene(folder / "SCENE.toml").frames())
    assert [f.masks[0] is not None for f in frames] == [i in (3, 5) for i in range(8)]
    assert_array_equal(frames[5].masks[0], film.scene.frame(5).masks[0])


def test_a_missing_image_is_an_instant_without_it(folder):
    (folder / "cam02" / "000003.png").unlink()
    (folder / "cam01" / "000004.png").write_bytes(b"no image")
    scene = read_scene(folder / "SCENE.toml")
    assert "1 of 8 images are missing" in scene.history[0].warnings[0]
    frames = list(scene.frames())
    assert [f.images[1] is None for f in frames] == [i == 3 for i in range(8)]
    assert [f.images[0] is None for f in frames] == [i == 4 for i in range(8)]
    assert "no image that can be decoded" in scene.footage.notes[0]


def test_the_world_is_turned_and_scaled(changed, folder, film):
    text = (folder / "calibration.toml").read_text()
    (folder / "calibration.toml").write_text(text.replace('up = "+y"', 'up = "+z"'))
    scene = read_scene(folder / "SCENE.toml")
    for one, other in zip(scene.cameras, film.scene.cameras, strict=True):
        x, y, z = other.centre
        assert_allclose(one.centre, [x, z, -y], atol=1e-12)
    (folder / "calibration.toml").write_text(text.replace('unit = "m"', 'unit = "cm"'))
    scene = read_scene(folder / "SCENE.toml")
    assert_allclose(scene.cameras[0].centre, film.scene.cameras[0].centre / 100, atol=1e-9)


@pytest.mark.parametrize(("said", "scale", "meant"), [("m", 1000, "mm"), ("mm", 1, "m")])
def test_a_unit_no_room_has_is_refused_with_the_one_that_may_be_meant(folder, said, scale, meant):
    text = (folder / "calibration.toml").read_text().replace('unit = "m"', f'unit = "{said}"')
    for line in [line for line in text.splitlines() if line.startswith("translation")]:
        numbers = np.array(line.split("[")[1].rstrip("]").split(","), dtype=float) * scale
        text = text.replace(line, f"translation = {numbers.tolist()}")
    (folder / "calibration.toml").write_text(text)
    with pytest.raises(BadScene, match=f'unit = "{meant}" may be meant'):
        read_scene(folder / "SCENE.toml")


def test_an_up_axis_that_no_camera_stands_by_is_doubted(folder):
    text = (folder / "calibration.toml").read_text()
    (folder / "calibration.toml").write_text(text.replace('up = "+y"', 'up = "-y"'))
    (warning,) = read_scene(folder / "SCENE.toml").history[0].warnings
    assert "up is -y, but the cameras' images have +y upwards" in warning


def test_one_camera_is_not_enough(folder):
    text = (folder / "SCENE.toml").read_text()
    head, first, *_, last = text.split("[[camera]]")
    body = last.partition("[body]")[2]
    (folder / "SCENE.toml").write_text(f"{head}[[camera]]{first}[body]{body}")
    with pytest.raises(BadScene, match="1 camera cannot see how far"):
        read_scene(folder / "SCENE.toml")


def test_images_of_one_colour_are_instants_without_one(folder):
    black = np.zeros_like(read_image(folder / "cam02" / "000003.png"))
    for i in (3, 4, 6):
        write_image(black, folder / "cam02" / f"{i:06d}.png")
    scene = read_scene(folder / "SCENE.toml")
    blind = [frame.images[1] is None for frame in scene.frames()]
    assert blind == [i in (3, 4, 6) for i in range(8)]
    (note,) = scene.notes
    assert "cam02 shows one colour and nothing else in frames 4–5 and 7" in note


def test_single_frames_of_a_video_are_sought(tmp_path, film):
    pytest.importorskip("av")
    scene = read_scene(write_scene(film.scene, tmp_path / "v", "mp4"))
    one_by_one = list(scene.frames())
    for i in (7, 2, 0, 5):
        for a, b in zip(scene.frame(i).images, one_by_one[i].images, strict=True):
            assert_array_equal(a, b)


def test_damage_in_a_video_is_told_and_shifts_nobody(tmp_path, film):
    pytest.importorskip("av")
    scene = read_scene(write_scene(film.scene, tmp_path / "v", "mkv"))
    whole = list(scene.frames())
    path = tmp_path / "v" / "cam02.mkv"
    raw = bytearray(path.read_bytes())
    raw[len(raw) // 2 : len(raw) // 2 + 4000] = bytes(4000)
    path.write_bytes(raw)
    damaged = read_scene(tmp_path / "v" / "SCENE.toml")
    frames = list(damaged.frames())
    same = [np.array_equal(a.images[0], b.images[0]) for a, b in zip(whole, frames, strict=False)]
    assert all(same)
    assert_array_equal(frames[0].images[1], whole[0].images[1])
    told = [*damaged.notes, *damaged.history[0].warnings]
    assert any("cam02" in sentence for sentence in told)


def test_what_the_calibration_does_not_say_is_guessed_aloud(folder, film):
    text = (folder / "calibration.toml").read_text()
    text = text.replace('unit = "m"', 'unit = ""').replace('up = "+y"', 'up = ""')
    (folder / "calibration.toml").write_text(text)
    scene = read_scene(folder / "SCENE.toml")
    said = " ".join(scene.history[0].warnings)
    assert "m is guessed" in said
    assert "+y is guessed" in said
    assert_allclose(scene.cameras[0].centre, film.scene.cameras[0].centre, atol=1e-12)


def test_half_size_images_scale_the_calibration_aloud(folder, film):
    for path in (folder / "cam01").iterdir():
        write_image(np.ascontiguousarray(read_image(path)[::2, ::2]), path)
    (folder / "cam01_plate.png").unlink()
    shutil.rmtree(folder / "cam01_masks")
    scene_file = folder / "SCENE.toml"
    lines = scene_file.read_text().splitlines()
    lines = [x for x in lines if "cam01_plate" not in x and "cam01_masks" not in x]
    scene_file.write_text("\n".join(lines))
    scene = read_scene(scene_file)
    assert "scaled to fit" in scene.history[0].warnings[0]
    assert_allclose(scene.cameras[0].matrix, film.scene.cameras[0].resized(0.5).matrix, atol=1e-9)


def test_pixels_of_a_cropped_video_are_mapped(changed, film):
    scene = read_scene(
        changed(
            'images = "cam01"',
            'images = "cam01"\ncalibration_pixel = { scale = 2.0, shift = [10.0, -6.0] }',
        )
    )
    point = np.array([0.1, 1.0, 0.2])
    seen = film.scene.cameras[0].project(point)
    assert_allclose(2.0 * scene.cameras[0].project(point) + [10.0, -6.0], seen, atol=1e-9)


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ('name = "cam02"', 'name = "cam9"', "cam9 is not calibrated; calibration.toml knows cam01"),
        ('name = "cam02"', 'name = "cam01"', "cam01 is there twice"),
        ('images = "cam02"', 'images = "nowhere"', "nowhere: there is no such file"),
        ('images = "cam02"', 'images = "cam02/*.jpg"', "holds no images"),
        ('images = "cam02"', 'images = "cam02"\noffset = 8', "after its offset cam02 has 0 frames"),
        ('images = "cam02"', 'imags = "cam02"', r"camera\[1\].images is missing"),
        ("rate_hz = 25.0", "", "images alone have no rate"),
        ("rate_hz = 25.0", "rate_hz = 0", "rate_hz"),
        ("rate_hz = 25.0", "frames = [3, 9]\nrate_hz = 25.0", "the cameras cover frames 0 to 7"),
        ("calibration =", "calibrated =", "calibrated is no key"),
        ('calibration = "calibration.toml"', "", "no calibration for cam01"),
        ('mesh = "average"', 'model = "x"', "no TOML"),
        ('model = "full"', 'model = "x.glb"', "neither 'full' nor 'upper', and no file"),
        ("fit = true", 'fit = true\n[start]\npose = "given"', "needs start.values"),
        ("fit = true", 'fit = true\n[start]\npose = "lying"', "start.pose must be"),
        ("fit = true", "fit = true\n[start]\nframe = 8", "the scene has frames 0 to 7"),
        ("fit = true", "fit = true\n[start]\nfacing = [0.0, 0.0, 0.0]", "nowhere along the floor"),
        ("fit = true", "fit = true\n[start]\nfacing = [0.0, -2.0, 0.1]", "nowhere along the floor"),
        ('images = "cam02"', 'images = "./cam01"', "cam01 and cam02 have the same images, ./cam01"),
        ('masks = "cam02_masks"', 'masks = "cam01_masks"', "have the same masks, cam01_masks"),
        ("rate_hz", 'unit = "mm"\nrate_hz', "calibration.toml is in m"),
        ('plate = "cam01_plate.png"', 'plate = "none.png"', "there is no such file"),
    ],
)
def test_what_does_not_fit_is_said(changed, old, new, said):
    path = changed(old, new)
    with pytest.raises(KinesphereError, match=said) as error:
        read_scene(path)
    assert "\n" not in str(error.value)


def test_images_of_another_size_are_refused(folder):
    for path in (folder / "cam01").iterdir():
        write_image(np.ascontiguousarray(read_image(path)[:, :-4]), path)
    with pytest.raises(BadScene, match="60 × 48 pixels, but it was calibrated at 64 × 48"):
        read_scene(folder / "SCENE.toml")


def test_a_plate_of_another_size_is_refused(folder):
    plate = folder / "cam01_plate.png"
    write_image(np.ascontiguousarray(read_image(plate)[:-2]), plate)
    with pytest.raises(BadScene, match="64 × 46 pixels, but the images of cam01 are 64 × 48"):
        read_scene(folder / "SCENE.toml")


def test_a_damaged_video_keeps_what_can_be_decoded(tmp_path, film):
    pytest.importorskip("av")
    path = write_scene(film.scene, tmp_path / "v", "mkv")
    video = tmp_path / "v" / "cam02.mkv"
    raw = video.read_bytes()
    video.write_bytes(raw[: int(0.6 * len(raw))])
    scene = read_scene(path)
    assert 2 <= scene.n_frames < 8
    assert "unequal numbers of frames" in scene.history[0].warnings[0]
    assert_array_equal(scene.frame(1).images[1], film.scene.frame(1).images[1])
    video.write_bytes(b"not a video at all")
    with pytest.raises(UnreadableFile, match="no video that can be read"):
        read_scene(path)
    video.write_bytes(b"")
    with pytest.raises(UnreadableFile, match="is empty"):
        read_scene(path)


def test_frames_in_the_middle_that_cannot_be_decoded_are_missing_not_shifted(tmp_path, film):
    av = pytest.importorskip("av")
    path = write_scene(film.scene, tmp_path / "v", "mkv")
    video = tmp_path / "v" / "cam01.mkv"
    with av.open(str(video)) as container:
        packets = [(p.pos, p.size) for p in container.demux(video=0) if p.size]
    raw = bytearray(video.read_bytes())
    at, size = packets[4]
    raw[at + 20 : at + size - 20] = bytes(size - 40)
    video.write_bytes(bytes(raw))
    scene = read_scene(path)
    frames = list(scene.frames())
    assert len(frames) == 8
    assert_array_equal(frames[6].images[0], film.scene.frame(6).images[0])
    assert_array_equal(frames[3].images[0], film.scene.frame(3).images[0])


def test_a_rate_other_than_the_videos_is_used_aloud(tmp_path, film):
    pytest.importorskip("av")
    path = write_scene(film.scene, tmp_path / "v", "mkv")
    text = path.read_text()
    assert "rate_hz = 25.0" in text
    assert read_scene(path).history[0].warnings == ()
    path.write_text(text.replace("rate_hz = 25.0", "rate_hz = 60"))
    scene = read_scene(path)
    assert scene.rate == 60
    (said,) = scene.history[0].warnings
    assert said.startswith("rate_hz = 60 is used, but cam01 says 25 Hz")


def test_cameras_of_unlike_rates_are_refused(tmp_path, film):
    pytest.importorskip("av")
    from dataclasses import replace

    path = write_scene(film.scene, tmp_path / "a", "mkv")
    write_scene(replace(film.scene, rate=30.0), tmp_path / "b", "mkv")
    shutil.copy(tmp_path / "b" / "cam02.mkv", tmp_path / "a" / "cam02.mkv")
    with pytest.raises(BadScene, match="cam01 runs at 25 Hz and cam02 at 30 Hz"):
        read_scene(path)


def test_a_scene_never_replaces_other_files(tmp_path, film):
    (tmp_path / "thesis").mkdir()
    (tmp_path / "thesis" / "chapter.txt").write_text("…")
    with pytest.raises(KinesphereError):
        write_scene(film.scene, tmp_path / "thesis", "png")
    assert (tmp_path / "thesis" / "chapter.txt").exists()
