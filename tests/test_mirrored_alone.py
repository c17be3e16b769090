"""Mirror images from motion alone: names fit what comes out."""

from dataclasses import replace

import numpy as np
import pytest

from kinesphere.pipeline import solve
from kinesphere.pipeline.motion_alone import discovered
from kinesphere.pipeline.settings import Settings
from kinesphere.quality import OrientationSettings
from kinesphere.synthetic import make_performance, spoil_with_noise


@pytest.fixture(scope="module")
def recording():
    """Return a person whose labels tell a mirror image."""
    rng = np.random.default_rng(5)
    it = make_performance(rng, layout="cmu41", rate=25.0, calibration_s=40.0, free_s=10.0)
    return spoil_with_noise(it.recording, rng, deviation=0.0005)


def mirrored(recording, axis):
    return replace(recording, markers=recording.markers * np.where(np.arange(3) == axis, -1.0, 1.0))


def hidden(recording):
    return replace(recording, labels=tuple(f"*{k}" for k in range(recording.n_markers)))


def found(recording, **orientation):
    settings = Settings()
    _, model, _ = discovered(
        recording,
        None,
        settings.discovery,
        settings.skeleton,
        OrientationSettings(**orientation),
        asked=True,
    )
    return {segment.name: set(segment.markers) for segment in model.segments}


@pytest.mark.parametrize("axis", range(3))
def test_a_recording_that_is_reflected_keeps_the_names_of_its_limbs(recording, axis):
    limbs = found(recording)
    assert {"left_thigh", "right_thigh", "left_forearm", "right_forearm"} <= set(limbs)
    assert found(mirrored(recording, axis)) == limbs
    told = found(hidden(mirrored(recording, axis)), mirrored="yes")
    assert told == found(hidden(recording))


def test_what_is_not_reflected_is_named_as_it_is_seen(recording):
    limbs, seen = found(recording), found(mirrored(recording, 0), mirrored="no")
    assert seen["left_thigh"] == limbs["right_thigh"]
    assert found(hidden(mirrored(recording, 0))) == found(
        hidden(mirrored(recording, 0)), mirrored="no"
    )


def test_no_warning_says_that_the_names_of_a_reflected_person_are_wrong(recording):
    straight, image = (solve(r, "none") for r in (recording, mirrored(recording, 0)))
    (told,) = set(image.warnings) - set(straight.warnings)
    assert "was reflected" in told
    assert image.skeleton.joint_names == straight.skeleton.joint_names
    assert [limb.markers for limb in image.skeleton.limbs] == [
        limb.markers for limb in straight.skeleton.limbs
    ]
