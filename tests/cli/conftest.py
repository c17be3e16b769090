"""Recordings on disk, and a way to call the program as a shell does."""

from dataclasses import dataclass, replace

import numpy as np
import pytest

from kinesphere.cli.main import run
from kinesphere.io import write
from kinesphere.synthetic import make_performance


@dataclass(frozen=True)
class Called:
    """What a command left behind."""

    code: int
    out: str
    err: str

    @property
    def error_lines(self):
        return self.err.strip("\n").split("\n") if self.err else []


@pytest.fixture
def call(capfd):
    """Return a function that runs one command and hands back exit code, stdout and stderr.

    File descriptors are captured: a C library that prints would be seen as well.
    """

    def called(*words):
        capfd.readouterr()
        code = run([str(word) for word in words])
        return Called(code, *capfd.readouterr())

    return called


@pytest.fixture(scope="session")
def performance():
    """Return 41 markers on an actor who calibrates in 20 s."""
    return make_performance(
        np.random.default_rng(1), layout="cmu41", rate=10.0, calibration_s=20.0, free_s=2.0
    )


@pytest.fixture(scope="session")
def recording(performance):
    """Return the same with a prefix, a gap, and a label that would like to steer the terminal."""
    markers = np.array(performance.recording.markers)
    markers[30:50, 4] = np.nan
    extra = np.full((len(markers), 1, 3), 0.5)
    return replace(
        performance.recording,
        markers=np.concatenate([markers, extra], axis=1),
        labels=(*performance.recording.labels, "[red]X[/red]\x1b[31m"),
    )


@pytest.fixture(scope="session")
def trc(recording, tmp_path_factory):
    path = tmp_path_factory.mktemp("files") / "walk.trc"
    write(replace(recording, labels=(*recording.labels[:-1], "[red]X[/red]")), path)
    return path


@pytest.fixture(scope="session")
def c3d(performance, tmp_path_factory):
    path = tmp_path_factory.mktemp("files") / "walk.c3d"
    write(performance.recording, path)
    return path
