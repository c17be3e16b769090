"""Fixtures every test may use."""

import os
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest


@pytest.fixture
def rng(request):
    """Give every test its own generator, the same on every run."""
    return np.random.default_rng(list(request.node.nodeid.encode()))


@pytest.fixture(scope="session")
def recordings():
    """Return the folder of real recordings; skip where it is absent, unless that is forbidden."""
    default = Path(__file__).parents[2] / "shared" / "data"
    folder = Path(os.environ.get("KINESPHERE_DATA", default))
    if folder.is_dir():
        return folder
    if os.environ.get("KINESPHERE_DATA_REQUIRED"):
        pytest.fail(f"real recordings are required but {folder} is no folder")
    return pytest.skip(f"no real recordings at {folder}; set KINESPHERE_DATA")


@pytest.fixture(scope="session")
def tracked_film():
    """Return a function: a film's truth as a tracker would hand it on."""
    return _tracked_film


@pytest.fixture(scope="session")
def filmed_body():
    """Return a function: the body of a film's motion, as drawing needs it; posed by the frame."""
    return _FilmedBody


_JOINTS = {
    "trunk": "lumbar",
    "head": "neck",
    "upper_arm": "shoulder",
    "forearm": "elbow",
    "hand": "wrist",
    "thigh": "hip",
    "shank": "knee",
    "foot": "ankle",
}


@dataclass(frozen=True)
class _FilmedBody:
    """The filmed body; its one parameter is the frame."""

    motion: Any

    @property
    def faces(self):
        return self.motion.surface.faces.astype(np.int32)

    @property
    def limb_of_face(self):
        surface = self.motion.surface
        return surface.weights[surface.faces].sum(axis=1).argmax(axis=1).astype(np.int32)

    def vertices(self, parameters):
        return self.motion.vertices(int(parameters[0]))


def _joint_name(limb):
    side, _, kind = limb.rpartition("left_" if limb.startswith("left_") else "right_")
    return f"{limb[: len(limb) - len(kind)]}{_JOINTS[kind]}" if kind in _JOINTS else side


def _tracked_film(film):
    from kinesphere.markerless import TrackedMotion

    motion = film.motion
    surface = motion.surface
    n, limbs = motion.n_frames, surface.limbs
    return TrackedMotion(
        body=_FilmedBody(motion),
        parameter_names=("frame",),
        parameters=np.arange(n, dtype=float)[:, None],
        limb_names=limbs,
        limb_parents=tuple(int(p) for p in surface.parents),
        joint_names=tuple(_joint_name(limb) for limb in limbs[1:]),
        rotations=motion.turns.copy(),
        origins=motion.joint_centres.copy(),
        ends=surface.ends - surface.joint_centres,
        overlap=np.full((n, len(film.scene.cameras)), 0.9),
        support=np.full((n, len(limbs)), 0.8),
        lost=np.zeros((n, len(limbs)), dtype=bool),
        rate=motion.rate,
        seconds={"segmentation": 2.0, "decoding": 1.0},
    )
