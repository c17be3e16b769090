"""The page and the table of a labelled recording: what was looked at, and what was not."""

import csv
import re

import numpy as np
import pytest

from kinesphere.data import Recording, Step
from kinesphere.labelling import built_in_model
from kinesphere.report import labelling_html, write_label_table

MODEL = built_in_model("cmu41")
NAMES = ("LFHD", "RFHD", "C7", "LKNE", "RKNE")


def recording(findings, labels, confidence):
    """Return five markers that bear these labels, and what labelling found about them."""
    places = np.random.default_rng(2).normal(size=(5, 3))
    markers = np.repeat(places[None], 50, axis=0)
    markers[40:, 0] = np.nan
    step = Step("label", {"model": "cmu41"}, findings)
    return Recording(markers, labels, 10.0, confidence=np.array(confidence), history=(step,))


@pytest.fixture
def after_check():
    """One disagrees, two could not be judged; the file names its subject."""
    labels = tuple(f"Anna:{name}" for name in NAMES)
    sure = [0.9, 0.3, np.nan, 0.0, np.nan]
    table = {
        name: {
            "marker": label,
            "confidence": None if np.isnan(c) else c,
            "moves_like": "RKNE" if name == "LKNE" else None,
            "look_s": [[0.0, 2.5], [3.0, 5.0]] if name == "LKNE" else [],
        }
        for name, label, c in zip(NAMES, labels, sure, strict=True)
    }
    found = {"checked": 3, "disagree": {"LKNE": "RKNE"}, "not_judged": ["C7", "RKNE"]}
    return recording({**found, "labels": table}, labels, sure)


@pytest.fixture
def after_keep():
    """Two were there already, one was not found, one is doubtful, one has no label."""
    labels = ("LFHD", "RFHD", "C7", "LKNE", "*0")
    sure = [1.0, 1.0, 0.9, 0.2, np.nan]
    table = {
        name: {"confidence": c, "kept": name in ("LFHD", "RFHD"), "look_s": []}
        for name, c in zip(NAMES, (*sure[:4], None), strict=True)
    }
    return recording({"labels_given": 4, "kept": 2, "labels": table}, labels, sure)


def rows(page):
    """Return name → (colour, word, bar, confidence) of the table's rows."""
    pattern = (
        r'<th scope="row">(?:<i class="trust (\w+)"></i>)?([^<]+)</th><td class="dim">([^<]*)</td>'
        r'<td>(<span class="meter">.*?</span>)?([^<]+)</td>'
    )
    return {m[2]: (m[1], m[3], m[4] is not None, m[5]) for m in re.finditer(pattern, page)}


def tiles(page):
    found = re.findall(r'<span class="name">([^<]+)</span><b>([^<]+)</b>', page)
    return dict(found)


def dots(page):
    """Return name → colour in the first drawing."""
    drawing = page.split('class="still"')[1].split("</svg>")[0]
    return {
        name: colour
        for colour, name in re.findall(r'<circle class="(\w+)".*?<text[^>]*>([^<]+)', drawing)
    }


def test_checked_labels_are_shown_under_their_own_names(after_check):
    page = labelling_html(after_check, MODEL)
    assert rows(page) == {
        "Anna:LKNE": ("poor", "moves like RKNE", True, "0.00"),
        "Anna:C7": ("none", "not judged", False, "–"),
        "Anna:RKNE": ("none", "not judged", False, "–"),
        "Anna:RFHD": ("fair", "likely", True, "0.30"),
        "Anna:LFHD": ("good", "sure", True, "0.90"),
    }
    assert next(iter(rows(page))) == "Anna:LKNE"
    found = tiles(page)
    assert (found["Labels checked"], found["To look at"], found["Not judged"]) == (
        "3 of 5",
        "1",
        "2",
    )
    assert "Left unlabelled" not in found


def test_drawings_show_what_was_not_judged_in_grey(after_check):
    assert dots(labelling_html(after_check, MODEL)) == {
        "LFHD": "good",
        "RFHD": "fair",
        "C7": "none",
        "LKNE": "poor",
        "RKNE": "none",
    }


def test_kept_labels_are_neither_sure_nor_green(after_keep):
    page = labelling_html(after_keep, MODEL)
    found = rows(page)
    assert found["LFHD"] == found["RFHD"] == ("none", "kept", False, "–")
    assert found["C7"] == ("good", "sure", True, "0.90")
    assert found["LKNE"] == ("poor", "look", True, "0.20")
    assert found["RKNE"] == (None, "not given", False, "–")
    assert dots(page)["LFHD"] == "none"
    assert "nobody looked whether it is right" in page
    counts = tiles(page)
    assert (counts["Labels given"], counts["Kept, not checked"]) == ("4 of 5", "2")
    assert (counts["To look at"], counts["Left unlabelled"]) == ("1", "1")


def test_where_nothing_was_kept_nothing_is_said_of_it(after_keep):
    table = after_keep.history[-1].findings["labels"]
    for row in table.values():
        row["kept"] = False
    page = labelling_html(after_keep, MODEL)
    assert "kept" not in page.split("</style>")[1].lower()
    assert rows(page)["LFHD"] == ("good", "sure", True, "1.00")


def test_the_table_says_the_same(after_check, tmp_path):
    write_label_table(after_check, tmp_path / "x.labels.csv")
    with (tmp_path / "x.labels.csv").open(encoding="utf-8", newline="") as file:
        found = list(csv.DictReader(file))
    assert found[0] == {
        "label": "LKNE",
        "marker": "Anna:LKNE",
        "said": "moves like RKNE",
        "confidence": "0.000",
        "labelled_s": "5.000",
        "look_at_s": "0.000 to 2.500; 3.000 to 5.000",
    }
    by_label = {row["label"]: row for row in found}
    assert set(by_label) == set(NAMES)
    assert (by_label["C7"]["said"], by_label["C7"]["confidence"]) == ("not judged", "")
    assert by_label["LFHD"]["labelled_s"] == "4.000"


def test_the_table_of_what_was_kept_and_what_is_missing(after_keep, tmp_path):
    write_label_table(after_keep, tmp_path / "x.labels.csv")
    lines = (tmp_path / "x.labels.csv").read_text(encoding="utf-8").splitlines()
    assert lines[1] == "RKNE,,not given,,0.000,"
    assert lines[2] == "LKNE,LKNE,look,0.200,5.000,"
    assert lines[-1] == "RFHD,RFHD,kept,,5.000,"
    assert [path.name for path in tmp_path.iterdir()] == ["x.labels.csv"]
