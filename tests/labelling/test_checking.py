"""Labels held against those that would be given: what counts as judged."""

import numpy as np
import pytest

from kinesphere.data import Recording
from kinesphere.labelling import LabellingSettings, built_in_model
from kinesphere.labelling.checking import checked
from kinesphere.labelling.labelled import Labelled
from kinesphere.labelling.runs import Run

N = 600
MODEL = built_in_model("cmu41")
SETTINGS = LabellingSettings(existing="check")
LABELS = ("Anna:LWRB", "Anna:LFIN", "*2")


def judged(*pieces, name="LWRB"):
    """Return what is found where pieces (start, end, label, confidence) of column 0 are told."""
    recording = Recording(np.zeros((N, 3, 3)), LABELS, 100.0)
    state = Labelled(
        np.full((N, len(MODEL.labels), 3), np.nan),
        [(Run(0, start, end),) for start, end, _, _ in pieces],
        [MODEL.labels.index(of) if of else -1 for _, _, of, _ in pieces],
        [sure for *_, sure in pieces],
    )
    return checked(recording, MODEL, SETTINGS, {name: 0}, state)


def test_a_short_piece_speaks_against_no_label():
    found = judged((0, 598, "LWRB", 0.9), (598, 600, "LFIN", 1.0))
    assert found.confidence[0] == pytest.approx(0.9)
    assert found.history[-1].findings["disagree"] == {}
    assert found.history[-1].warnings == ()


@pytest.mark.parametrize("of", ["LWRB", "LFIN"])
@pytest.mark.parametrize(("end", "sure"), [(89, 1.0), (600, 0.24)])
def test_what_is_short_or_doubtful_is_not_judged(of, end, sure):
    found = judged((0, end, of, sure))
    assert np.isnan(found.confidence[0])
    findings = found.history[-1].findings
    assert (findings["checked"], findings["disagree"]) == (0, {})
    assert findings["not_judged"] == ["LWRB"]
    assert findings["labels"]["LWRB"]["confidence"] is None


def test_what_is_long_and_likely_speaks_against_a_label():
    found = judged((0, 300, "LWRB", 0.9), (300, 600, "LFIN", 0.3))
    assert found.confidence[0] == 0
    step = found.history[-1]
    assert step.findings["disagree"] == {"LWRB": "LFIN"}
    assert step.findings["labels"]["LWRB"] == {
        "marker": "Anna:LWRB",
        "confidence": 0.0,
        "share": 1.0,
        "moves_like": "LFIN",
        "look_s": [[3.0, 6.0]],
    }
    assert step.warnings == ("LWRB moves like LFIN of model cmu41 in 50% of its frames",)


def test_pieces_of_one_label_count_together():
    pieces = [(100 * i, 100 * i + 50, "LFIN", 0.5 + 0.1 * (i % 2)) for i in range(4)]
    assert judged(*pieces).history[-1].findings["disagree"] == {"LWRB": "LFIN"}
    assert judged(*pieces, name="LFIN").confidence[0] == pytest.approx(0.55)


def test_what_has_no_label_is_no_verdict():
    assert np.isnan(judged((0, 600, "", 0.0)).confidence[0])


def test_nothing_but_confidences_changes():
    found = judged((0, 600, "LFIN", 0.9))
    assert found.labels == LABELS
    assert (found.markers == 0).all()
