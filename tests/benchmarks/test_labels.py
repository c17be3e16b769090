"""No row of the labelling benchmark knows the person it labels."""

from types import SimpleNamespace

import numpy as np
import pytest
from benchmarks.accuracy.labels import broken, clean, missing, sources
from benchmarks.accuracy.labels.elsewhere import COUNTERPARTS

from kinesphere.labelling import built_in_model

RATE = 10.0
FAKE = SimpleNamespace(
    markers=np.zeros((120, 41, 3)),
    rate=RATE,
    n_frames=120,
    n_markers=41,
    labels=tuple(f"m{i}" for i in range(41)),
)


def test_markers_are_counted_one_by_one_as_well():
    there = np.arange(200.0 * 3 * 3).reshape(200, 3, 3)
    found = there.copy()
    found[:2, 0] = np.nan  # F1 0.995
    found[:9, 1] = -1.0  # 0.955
    recording = SimpleNamespace(markers=found, labels=("a", "b", "c"))
    counts = broken._counts(recording, there, np.arange(3), ("a", "b", "c"))
    assert counts == {"samples": 600, "right": 589, "wrong": 9, "low_markers": 1}


def person(recording):
    return recording.split("_")[0]


@pytest.fixture
def labelled(monkeypatch):
    """Return every (recording, model's recordings) that benchmarks label, as they run."""
    read, found = [], []

    def cmu(name):
        read.append(name)
        return FAKE

    def given_labels(points, model):
        found.append((read[-1], model))
        return np.full(points.shape[1], -1)

    def label(raw, model):
        found.append((read[-1], model))
        return SimpleNamespace(markers=raw.markers, labels=raw.labels)

    for module in (clean, missing, broken):
        monkeypatch.setattr(module, "cmu", cmu)
        monkeypatch.setattr(module, "model_of", tuple)
    for module in (clean, missing):
        monkeypatch.setattr(module, "given_labels", given_labels)
    monkeypatch.setattr(broken, "label", label)
    nothing = SimpleNamespace(labels=np.full(41, -1))
    monkeypatch.setattr(clean, "match_huang_xia", lambda *_: nothing)
    monkeypatch.setattr(clean, "_frames_by_tree", lambda *_: 0)
    return found


@pytest.mark.parametrize(
    ("run", "learnt_from"),
    [
        (clean.pairs, 1),
        (lambda: clean.windows(5.0, several=False), 1),
        (lambda: clean.windows(2.0, several=True), 3),
        (missing.missing, 3),
        (broken.broken, 3),
    ],
    ids=["pairs", "windows of one", "windows of three", "missing", "broken"],
)
def test_the_model_is_of_other_people(labelled, run, learnt_from):
    run()
    assert {recording for recording, _ in labelled} == set(sources.CMU)
    for recording, model in labelled:
        assert len(model) == learnt_from
        assert person(recording) not in map(person, model)


@pytest.mark.real
def test_a_model_holds_the_recordings_it_is_asked_for_and_no_other(recordings):
    assert recordings.is_dir()
    wanted = sources.others("06_01")
    assert tuple(one.recording for one in sources.model_of(wanted).statistics) == wanted


def test_counterparts_keep_their_side():
    known = built_in_model("cmu41").labels
    for own, label in COUNTERPARTS.items():
        assert label in known
        assert own in ("CLAV", "C7", "T10", "STRN") or own[0] == label[0]
