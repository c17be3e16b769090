"""A small scene on disk, made from a film."""

import pytest

from kinesphere.synthetic.film import make_film

pytest.importorskip("cv2")


@pytest.fixture(scope="session")
def film():
    """Eight frames, three cameras, with masks and plates."""
    return make_film(
        4, "arms", size=(64, 48), n_frames=8, n_cameras=3, rate=25.0, masks=True, plates=True
    )


@pytest.fixture
def folder(tmp_path, film):
    """Return the film as a folder of PNG images."""
    from kinesphere.io.scene import write_scene

    write_scene(film.scene, tmp_path / "scene", "png")
    return tmp_path / "scene"


@pytest.fixture
def changed(folder):
    """Return a function that replaces text in SCENE.toml and returns its path."""

    def change(old, new, count=1):
        path = folder / "SCENE.toml"
        text = path.read_text()
        assert old in text
        path.write_text(text.replace(old, new, count))
        return path

    return change
