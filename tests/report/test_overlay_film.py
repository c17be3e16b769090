"""The video of all cameras: it can be decoded, shows every frame in time, and says what is lost."""

import io
from dataclasses import replace

import numpy as np
import pytest

pytest.importorskip("cv2")
pytest.importorskip("av")

from kinesphere.report.overlay_film import overlay_film, sheet_for
from kinesphere.report.panels import panels_for
from kinesphere.synthetic.film import make_film

pytestmark = pytest.mark.slow  # rendering takes long in plain Python


@pytest.fixture(scope="module")
def film():
    return make_film(2, "arms", size=(96, 72), n_frames=9, n_cameras=3)


def decoded(raw):
    import av

    with av.open(io.BytesIO(raw)) as container:
        stream = container.streams.video[0]
        return stream, [frame.to_ndarray(format="rgb24") for frame in container.decode(stream)]


@pytest.mark.parametrize(("rate", "shown", "pace"), [(25.0, 9, 25), (60.0, 5, 30), (100.0, 3, 25)])
def test_it_lasts_as_long_as_the_motion(film, tracked_film, rate, shown, pace):
    scene = replace(film.scene, rate=rate)
    raw, poster = overlay_film(scene, tracked_film(film))
    stream, pictures = decoded(raw)
    assert len(pictures) == shown
    assert stream.average_rate == pytest.approx(pace, rel=1e-3)
    assert pictures[0].shape == poster.shape
    assert np.corrcoef(pictures[0].ravel(), poster.ravel())[0, 1] > 0.98


def test_browsers_can_play_it(film, tracked_film):
    stream, pictures = decoded(overlay_film(film.scene, tracked_film(film))[0])
    assert stream.codec_context.name in ("h264", "vp9", "libvpx-vp9")
    assert stream.codec_context.pix_fmt == "yuv420p"
    assert all(side % 2 == 0 for side in pictures[0].shape[:2])


def test_the_body_is_drawn_where_it_has_a_pose(film, tracked_film):
    tracked = tracked_film(film)
    parameters = tracked.parameters.copy()
    parameters[4:] = np.nan
    _, poster = overlay_film(film.scene, tracked)
    none = replace(tracked, parameters=np.full_like(parameters, np.nan))
    _, bare = overlay_film(film.scene, none)
    assert bare.shape == poster.shape
    assert (poster != bare).any()
    _, pictures = decoded(overlay_film(film.scene, replace(tracked, parameters=parameters))[0])
    assert len(pictures) == film.scene.n_frames


def test_frames_that_were_never_reached_are_not_shown(film, tracked_film):
    tracked = tracked_film(film)
    parameters = tracked.parameters.copy()
    parameters[:2] = parameters[6:] = np.nan
    stopped = replace(tracked, parameters=parameters, n_reached=4)
    assert len(decoded(overlay_film(film.scene, stopped)[0])[1]) == 4


def test_panels_show_the_whole_body_and_are_never_enlarged(film, tracked_film):
    tracked = tracked_film(film)
    panels = panels_for(film.scene, tracked, range(9), np.inf)
    for panel, camera in zip(panels, film.scene.cameras, strict=True):
        assert panel.scale == 1.0
        skin = np.concatenate([film.motion.vertices(i) for i in (0, 4, 8)])
        pixels = camera.project(skin)
        inside = pixels.clip(0, [camera.width - 1, camera.height - 1])
        assert (inside >= [panel.left, panel.top]).all()
        assert (inside <= [panel.right, panel.bottom]).all()


@pytest.mark.parametrize("n", [1, 2, 4, 5, 8])
def test_any_number_of_cameras_fits_on_a_screen(film, tracked_film, n):
    panel = panels_for(film.scene, tracked_film(film), range(9), np.inf)[0]
    big = replace(panel, camera=panel.camera.resized(20.0))
    sheet = sheet_for([big.within(np.inf, np.inf)] * n)
    pictures = [np.zeros((p.size[1], p.size[0], 3), np.uint8) for p in sheet.panels]
    height, width, _ = sheet.arranged(pictures, ["cam"] * n, "frame 1").shape
    assert width <= 1282
    assert height <= 742
    assert width > 1000 or height > 600
