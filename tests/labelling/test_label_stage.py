"""The stage: recordings without names in, recordings with names and confidences out."""

from dataclasses import replace

import numba
import numpy as np
import pytest
from numpy.testing import assert_array_equal

from kinesphere.data import Analog, Event, Output, Recording
from kinesphere.errors import BadModel, BadRecording, BadSetting
from kinesphere.io import read, write
from kinesphere.labelling import LabellingSettings, built_in_model, label
from kinesphere.report import labelling_html

pytestmark = pytest.mark.skipif(
    bool(numba.config.DISABLE_JIT), reason="a search in plain Python takes minutes"
)


def stripped(recording, rng, **changes):
    """Return the recording with its names taken away and its markers in another order."""
    order = rng.permutation(recording.n_markers)
    names = tuple(f"*{i}" for i in range(recording.n_markers))
    return replace(recording, markers=recording.markers[:, order], labels=names, **changes)


def assert_labelled_as(found, recording):
    for name in recording.labels:
        assert_array_equal(
            found.markers[:, found.labels.index(name)],
            recording.markers[:, recording.labels.index(name)],
        )


@pytest.fixture(scope="module")
def labelled(legs):
    """Return (labelled, as it was before it was stripped)."""
    model, recording = legs
    rng = np.random.default_rng(1)
    n = recording.n_frames
    full = replace(
        recording,
        residuals=np.full(recording.markers.shape[:2], 1e-3),
        outputs=(Output("LKneeAngles", "angle", np.ones((n, 3)), "deg"),),
        analog=Analog(np.zeros((2 * n, 1)), ("Fz",), ("N",), 2 * recording.rate),
        events=(Event(0.5, "Foot Strike", "Left"),),
    )
    return label(stripped(full, rng), model), full


def test_every_marker_gets_its_label_back(labelled):
    found, before = labelled
    assert set(found.labels) == set(before.labels)
    assert_labelled_as(found, before)
    assert (found.confidence > 0.1).all()


def test_everything_else_stays(labelled):
    found, before = labelled
    assert found.outputs == before.outputs
    assert found.analog is before.analog
    assert found.events == before.events
    assert found.rate == before.rate
    assert_array_equal(found.residuals, np.full_like(found.residuals, 1e-3))


def test_the_step_says_what_was_found(labelled):
    found, _ = labelled
    step = found.history[-1]
    assert step.name == "label"
    assert step.settings["method"] == "pair-statistics"
    assert step.findings["labels_given"] == step.findings["labels_known"] == 18
    assert step.findings["points_left_unlabelled"] == 0
    assert step.findings["missing"] == []


def test_a_c3d_file_keeps_labels_and_confidences(labelled, tmp_path):
    found, _ = labelled
    write(found, tmp_path / "labelled.c3d")
    back = read(tmp_path / "labelled.c3d")
    assert set(found.labels) == set(back.labels)
    for name in found.labels:
        there = back.confidence[back.labels.index(name)]
        assert there == pytest.approx(found.confidence[found.labels.index(name)], abs=1e-6)


def test_a_file_without_confidences_has_none(labelled, tmp_path):
    found, _ = labelled
    write(replace(found, confidence=None), tmp_path / "plain.c3d")
    assert read(tmp_path / "plain.c3d").confidence is None


def test_the_page_names_every_label_and_escapes_names(labelled, legs):
    model, _ = legs
    found, _ = labelled
    page = labelling_html(found, model, "<walk>")
    assert "&lt;walk&gt;" in page
    assert "<walk>" not in page
    for name in model.labels:
        assert f"</i>{name}</th>" in page
    assert page.count('class="still"') == 3


def test_labels_that_are_there_are_kept(legs, rng):
    model, recording = legs
    raw = stripped(recording, rng)
    names = list(raw.labels)
    names[0] = "LKNE"  # whatever it is: the user says so
    found = label(replace(raw, labels=tuple(names)), model)
    assert_array_equal(found.markers[:, found.labels.index("LKNE")], raw.markers[:, 0])
    assert found.confidence[found.labels.index("LKNE")] == 1


def test_labels_that_are_there_are_checked(legs):
    model, recording = legs
    names = list(recording.labels)
    a, b = names.index("LKNE"), names.index("RKNE")
    names[a], names[b] = names[b], names[a]
    swapped = replace(recording, labels=tuple(names))
    found = label(swapped, model, LabellingSettings(existing="check"))
    assert found.labels == swapped.labels
    assert found.history[-1].findings["disagree"] == {"LKNE": "RKNE", "RKNE": "LKNE"}
    assert any("LKNE moves like RKNE" in warning for warning in found.history[-1].warnings)
    assert found.history[-1].findings["not_judged"] == []
    assert found.history[-1].findings["checked"] == len(names)
    assert (found.confidence[[a, b]] == 0).all()
    others = [i for i in range(len(names)) if i not in (a, b)]
    assert (found.confidence[others] > 0).all()


def test_labels_that_cannot_be_checked_are_not_said_to_agree(legs):
    model, recording = legs
    still = replace(recording, markers=np.repeat(recording.markers[:1], 100, axis=0))
    step = label(still, model, LabellingSettings(existing="check")).history[-1]
    assert step.findings["checked"] == 0
    assert set(step.findings["not_judged"]) == set(recording.labels)
    assert any("could not be judged" in warning for warning in step.warnings)


def test_labels_that_are_there_are_ignored(legs):
    model, recording = legs
    turned = replace(recording, labels=recording.labels[::-1])
    found = label(turned, model, LabellingSettings(existing="ignore"))
    assert_labelled_as(found, recording)


def test_pieces_hidden_markers_and_ghosts(legs, rng):
    model, recording = legs
    n = 600
    spoilt = recording.markers[-n:] + rng.normal(scale=0.001, size=(n, 18, 3))
    spoilt[100:140, 4] = np.nan
    pieces = []
    for i in range(18):
        cut = int(rng.integers(150, 450))
        for part in (slice(0, cut), slice(cut, n)):
            piece = np.full((n, 3), np.nan)
            piece[part] = spoilt[part, i]
            pieces.append(piece)
    for start in (50, 300):
        piece = np.full((n, 3), np.nan)
        piece[start : start + 20] = rng.uniform(-1, 1, 3)
        pieces.append(piece)
    order = rng.permutation(len(pieces))
    raw = Recording(
        np.stack([pieces[i] for i in order], axis=1),
        tuple(f"*{i}" for i in order),
        recording.rate,
    )
    found = label(raw, model)
    right = wrong = 0
    for i, name in enumerate(recording.labels):
        if name in found.labels:
            given = found.markers[:, found.labels.index(name)]
            same = (given == spoilt[:, i]).all(axis=1)
            right += int(same.sum())
            wrong += int((np.isfinite(given[:, 0]) & ~same).sum())
    there = int(np.isfinite(spoilt[:, :, 0]).sum())
    assert wrong <= 0.005 * there
    assert right >= 0.9 * there


def test_the_order_of_pieces_and_ghosts_beside_a_whole_recording_change_no_label(legs, rng):
    model, recording = legs
    n = recording.n_frames
    ghosts = np.full((n, 40, 3), np.nan)
    for k in range(40):
        start = int(rng.integers(n - 15))
        ghosts[start : start + 15, k] = rng.uniform(-1, 2, 3)
    crowd = np.concatenate([recording.markers, ghosts], axis=1)
    found = []
    for _ in range(2):
        order = rng.permutation(crowd.shape[1])
        names = tuple(f"*{i}" for i in range(crowd.shape[1]))
        found.append(label(Recording(crowd[:, order], names, recording.rate), model))
        assert_labelled_as(found[-1], recording)
    assert_array_equal(found[0].confidence[:18], found[1].confidence[:18])


def test_of_two_bodies_one_is_labelled_and_that_is_said(legs, rng):
    model, recording = legs
    half = recording.n_frames // 2
    away = np.linspace(1, 4, half)[:, None, None] * np.array([1.0, 0.2, 0.0])
    one, other = recording.markers[:half], recording.markers[half : 2 * half] + away
    both = Recording(
        np.concatenate([one, other], axis=1), tuple(f"*{i}" for i in range(36)), recording.rate
    )
    found = label(stripped(both, rng), model)
    bodies = [
        sum(
            np.array_equal(found.markers[:, found.labels.index(name)], body[:, i])
            for i, name in enumerate(recording.labels)
            if name in found.labels
        )
        for body in (one, other)
    ]
    assert min(bodies) == 0
    assert max(bodies) == sum(name in found.labels for name in recording.labels) >= 16
    assert found.history[-1].warnings[0].startswith("2 bodies are in the volume; the one that")


def test_no_frames_are_refused(legs):
    model, recording = legs
    with pytest.raises(BadRecording, match="nothing to label"):
        label(replace(recording, markers=recording.markers[:0]), model)


def test_a_model_without_statistics_is_refused(legs):
    model, recording = legs
    with pytest.raises(BadModel, match="has no statistics"):
        label(recording, replace(model, statistics=()), LabellingSettings(existing="ignore"))


def test_an_unknown_method_is_answered_with_the_known_ones():
    with pytest.raises(BadSetting, match="'kd'; known are pair-statistics, huang-xia, similarity"):
        LabellingSettings(method="kd")


@pytest.mark.parametrize("name", ["cmu41", "plugin-gait"])
def test_built_in_models_know_distances_and_sides_but_no_recording(name):
    model = built_in_model(name)
    assert len(model.statistics) >= 3
    for one in model.statistics:
        assert len(one.quadruples) > 500
        assert "/" not in one.recording
    sure = np.abs(np.concatenate([one.handedness for one in model.statistics]))
    assert sure.min() >= 0.9


@pytest.mark.real
def test_a_real_person_by_the_statistics_of_others(recordings, rng):
    model = built_in_model("cmu41")
    own = "CMU 06_01, walking"
    others = tuple(one for one in model.statistics if one.recording != own)
    assert len(others) == 3
    walk = read(recordings / "cmu41" / "06_01.c3d")
    bare = replace(walk, labels=tuple(x.rpartition(":")[2] for x in walk.labels))
    found = label(stripped(bare, rng, details={}), replace(model, statistics=others))
    assert_labelled_as(found, bare)
