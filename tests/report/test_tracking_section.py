"""The tracking section: pictures, a curve a camera, a bar a limb; and the table beside it."""

import csv
import io
from dataclasses import replace

import numpy as np
import pytest

pytest.importorskip("cv2")

from kinesphere.report.strip import overlay_strip, shown_frames
from kinesphere.report.tracking import tracking_section, tracking_table
from kinesphere.synthetic.film import make_film

pytestmark = pytest.mark.slow  # rendering takes long in plain Python


@pytest.fixture(scope="module")
def film():
    return make_film(2, "arms", size=(96, 72), n_frames=20, n_cameras=3)


@pytest.fixture(scope="module")
def spoiled(film, tracked_film):
    tracked = tracked_film(film)
    support, lost, overlap = tracked.support.copy(), tracked.lost.copy(), tracked.overlap.copy()
    support[13, 5] = 0.1
    support[:, 2] = np.nan
    lost[13:15, 5] = True
    overlap[4:6, 1] = np.nan
    parameters = tracked.parameters.copy()
    parameters[19] = np.nan
    return replace(tracked, support=support, lost=lost, overlap=overlap, parameters=parameters)


def test_the_worst_frame_is_shown(spoiled):
    assert shown_frames(spoiled, 3) == [0, 10, 13, 19]


def test_the_strip_has_a_row_a_frame_and_a_column_a_camera(film, spoiled):
    strip, frames = overlay_strip(film.scene, spoiled, 3)
    assert frames == [0, 10, 13, 19]
    assert strip.shape[0] > 4 * 30
    assert strip.dtype == np.uint8


def test_the_section_tells_of_lost_limbs(film, spoiled):
    html = tracking_section(film.scene, spoiled, b"picture", [0, 13])
    hand = spoiled.limb_names[5]
    assert f'<th scope="row">{hand}</th>' in html
    assert html.count('class="lost"') == 2  # cells of the bar: one a frame
    assert "19 of 20 frames have a pose" in html
    assert "data:image/jpeg;base64,cGljdHVyZQ==" in html
    assert html.count('<path class="c1"') == 1
    broken = html.split('<path class="c1" d="')[1].split('"')[0]
    assert broken.count("M") == 2  # the curve breaks where there was no image


def test_overlap_with_given_masks_stands_apart(film, spoiled):
    by_mask = np.zeros(spoiled.overlap.shape, dtype=bool)
    by_mask[[2, 7], 1] = True
    overlap = spoiled.overlap.copy()
    overlap[[2, 7], 1] = 0.5, 0.7
    html = tracking_section(
        film.scene, replace(spoiled, overlap=overlap, by_mask=by_mask), b"", [0]
    )
    assert '<td class="n">0.60</td><td class="n">2</td>' in html
    assert "with given masks" not in tracking_section(film.scene, spoiled, b"", [0])


def test_names_of_cameras_cannot_smuggle_markup(film, spoiled):
    camera = replace(film.scene.cameras[0], name="<script>alert(1)</script>")
    scene = replace(film.scene, cameras=(camera, *film.scene.cameras[1:]))
    html = tracking_section(scene, spoiled, b"", [0])
    assert "<script>" not in html


def test_the_table_has_a_row_a_frame(film, spoiled):
    rows = list(csv.DictReader(io.StringIO(tracking_table(film.scene, spoiled))))
    assert len(rows) == 20
    assert rows[4]["overlap.cam02"] == ""
    assert rows[3]["overlap.cam02"] == "0.9000"
    limb = spoiled.limb_names[5]
    assert [row["lost"] for row in rows[12:16]] == ["", limb, limb, ""]
    assert float(rows[10]["time_s"]) == pytest.approx(10 / 30, abs=1e-6)
