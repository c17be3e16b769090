"""The model drawn over an image: where it is, in the colours of its limbs; nothing elsewhere."""

import numpy as np
import pytest
from numpy.testing import assert_array_equal

pytest.importorskip("cv2")

from kinesphere.markerless.drawing import limb_colours, overlay
from kinesphere.synthetic.film import make_film

pytestmark = pytest.mark.slow  # rendering takes long in plain Python


@pytest.fixture(scope="module")
def film():
    return make_film(2, "arms", size=(160, 120), n_frames=2, masks=True)


@pytest.fixture(scope="module")
def drawn(filmed_body):
    """Return a function that draws the film's first frame over grey."""
    return lambda film, **how: _drawn(filmed_body(film.motion), film, **how)


def _drawn(body, film, **how):
    camera = film.scene.cameras[0]
    grey = np.full((120, 160, 3), 90, dtype=np.uint8)
    names = film.motion.surface.limbs
    skin = body.vertices(np.array([0.0]))
    return overlay(grey, camera, how.pop("skin", skin), body.faces, body.limb_of_face, names, **how)


def test_it_covers_the_silhouette_and_nothing_else(film, drawn):
    picture = drawn(film)
    assert_array_equal((picture != 90).any(axis=2), film.scene.frame(0).masks[0])


def test_half_size_shows_the_same_at_half_the_place(film, drawn):
    covered = (drawn(film, scale=0.5) != 90).any(axis=2)
    assert covered.shape == (60, 80)
    whole = film.scene.frame(0).masks[0].reshape(60, 2, 80, 2).mean(axis=(1, 3))
    agree = (covered & (whole > 0.5)).sum() / (covered | (whole > 0.5)).sum()
    assert agree > 0.85


def test_lost_limbs_are_red_and_left_open(film, drawn):
    names = film.motion.surface.limbs
    lost = np.array([name == "trunk" for name in names])
    usual, red = drawn(film).astype(int), drawn(film, lost=lost).astype(int)
    changed = (usual != red).any(axis=2)
    assert 0.1 < changed.sum() / film.scene.frame(0).masks[0].sum() < 0.6
    edge = red[changed][:, 0].max()
    assert edge > 220
    assert np.median(np.abs(red - 90).max(axis=2)[changed]) < np.median(
        np.abs(usual - 90).max(axis=2)[changed]
    )


def test_no_pose_leaves_the_image_as_it_is(film, drawn):
    skin = np.full((film.motion.surface.n_vertices, 3), np.nan)
    assert (drawn(film, skin=skin) == 90).all()


def test_left_and_right_differ():
    left, right, odd = limb_colours(("left_thigh", "right_thigh", "limb_03"))
    assert (left > right).all()
    assert odd.tolist() == [150, 150, 150]
