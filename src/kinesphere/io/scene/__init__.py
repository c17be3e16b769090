"""Scenes of several cameras, as ``SCENE.toml`` describes them."""

from kinesphere.io.scene.read import read_scene as read_scene
from kinesphere.io.scene.write import write_scene as write_scene
