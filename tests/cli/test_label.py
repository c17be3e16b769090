"""``kinesphere label``, as a person runs it."""

import json
from dataclasses import replace

import numba
import numpy as np
import pytest

from kinesphere.cli.label import show
from kinesphere.cli.main import run
from kinesphere.data import Recording, Step
from kinesphere.io import read, read_model, write, write_model
from kinesphere.labelling import built_in_model
from kinesphere.report import labelling_html
from kinesphere.skeleton.statistics import marker_statistics
from kinesphere.synthetic import make_performance

pytestmark = pytest.mark.skipif(
    bool(numba.config.DISABLE_JIT), reason="a search in plain Python takes minutes"
)
HEAD = ("LFHD", "RFHD", "LBHD", "RBHD", "C7", "T10", "CLAV", "STRN", "RBAC", "LSHO", "RSHO")


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    """Return a folder with a model and a recording of someone else without labels."""
    folder = tmp_path_factory.mktemp("label")
    plain = built_in_model("cmu41")
    trunk = [s for s in plain.segments if s.name in ("trunk", "head")]
    model = replace(
        plain,
        name="upper",
        segments=tuple(trunk),
        joints=tuple(replace(j, landmarks=()) for j in plain.joints if j.name == "neck"),
        root="trunk",
        required=HEAD,
        mirror=tuple(p for p in plain.mirror if set(p) <= set(HEAD)),
        aliases={},
        statistics=(),
    )
    made = [
        make_performance(
            np.random.default_rng(seed), layout="cmu41", calibration_s=10.0, free_s=10.0
        ).recording
        for seed in (21, 22)
    ]
    own = tuple(marker_statistics(one, model.labels, "someone") for one in made[:1])
    write_model(replace(model, statistics=own), folder / "upper.json")
    order = np.random.default_rng(3).permutation(len(model.labels))
    columns = made[1].columns(tuple(model.labels[i] for i in order))
    raw = replace(
        made[1], markers=made[1].markers[:, columns], labels=tuple(f"*{i}" for i in order)
    )
    write(raw, folder / "raw.c3d")
    return folder


def test_a_labelled_file_a_table_and_a_page(files, capsys):
    out = files / "out.c3d"
    code = run(
        ["label", str(files / "raw.c3d"), "--model", str(files / "upper.json"), "-o", str(out)]
    )
    said = capsys.readouterr().out
    assert code == 0
    assert "labels of upper given" in said
    found = read(out)
    assert set(found.labels) <= {*HEAD, *(f"*{i}" for i in range(99))}
    page = (files / "out.html").read_text(encoding="utf-8")
    table = (files / "out.labels.csv").read_text(encoding="utf-8")
    assert table.startswith("label,marker,said,confidence,labelled_s,look_at_s\n")
    assert "out.labels.csv" in said
    for name in HEAD:
        assert name in said
        assert name in page
        assert f"\n{name}," in table


def named(files, names, target):
    """Write the raw recording with some of its markers named rightly."""
    made = read(files / "raw.c3d")
    order = [built_in_order(files)[int(label[1:])] for label in made.labels]
    labels = tuple(
        names(label) if names(label) else own for label, own in zip(order, made.labels, strict=True)
    )
    write(replace(made, labels=labels), files / target)
    return str(files / target)


def built_in_order(files):
    return read_model(files / "upper.json").labels


def test_labels_with_a_subject_are_checked_on_the_page_too(files, capsys):
    whole = named(files, lambda label: f"Anna:{label}", "anna.c3d")
    out, model = files / "checked.c3d", str(files / "upper.json")
    more = ["--set", "labelling.existing=check"]
    assert run(["label", whole, "--model", model, "-o", str(out), *more]) == 0
    said = capsys.readouterr().out
    assert "0 disagree" in said
    page = (files / "checked.html").read_text(encoding="utf-8")
    assert page.count('class="still"') == 3
    for name in HEAD:
        assert f"Anna:{name}</th>" in page
    assert read(out).labels == read(whole).labels


def test_kept_labels_are_said_to_be_kept(files, capsys):
    some = named(files, lambda label: label if label in HEAD[:4] else "", "some.c3d")
    out, model = files / "kept.c3d", str(files / "upper.json")
    assert run(["label", some, "--model", model, "-o", str(out)]) == 0
    said = capsys.readouterr().out
    assert "4 kept and not checked" in said.replace("\n", " ")
    for name in HEAD[:4]:
        (line,) = (x for x in said.splitlines() if x.split()[:1] == [name])
        assert line.split()[1:3] == ["kept", "–"]
    found = read(out)
    assert found.confidence[found.labels.index(HEAD[0])] == 1


def test_the_table_does_not_take_the_place_of_what_is_labelled(files, capsys):
    raw = files / "a.labels.csv"
    raw.write_text("time_s\n", encoding="utf-8")
    out, model = files / "a.c3d", str(files / "upper.json")
    assert run(["label", str(raw), "--model", model, "-o", str(out)]) == 2
    assert "is what is to be labelled" in capsys.readouterr().err.replace("\n", " ")
    assert raw.read_text(encoding="utf-8") == "time_s\n"


def test_where_nothing_can_be_told_nothing_is_written(files, capsys):
    raw = read(files / "raw.c3d")
    one = replace(raw, markers=raw.markers[:1], residuals=None, outputs=(), analog=None, events=())
    write(one, files / "one.c3d")
    out = files / "nothing.c3d"
    code = run(
        ["label", str(files / "one.c3d"), "--model", str(files / "upper.json"), "-o", str(out)]
    )
    assert code == 2
    said = capsys.readouterr().err
    assert "one frame alone" in said
    assert "none of the 11 labels" in said
    assert not out.exists()
    assert not out.with_suffix(".html").exists()


def test_machines_get_json(files, capsys):
    out = files / "again.c3d"
    raw, model = str(files / "raw.c3d"), str(files / "upper.json")
    assert run(["label", raw, "--model", model, "-o", str(out), "--json"]) == 0
    summary = json.loads(capsys.readouterr().out)
    assert summary["labels_known"] == len(HEAD)
    assert set(summary["labels"]) == set(HEAD)


@pytest.mark.parametrize(("sure", "said"), [(0.6, "sure"), (0.37, "likely"), (0.2, "look")])
def test_table_and_page_call_a_confidence_the_same(files, capsys, sure, said):
    model = built_in_model("cmu41")
    row = {"confidence": sure, "share": 1.0, "pieces": 1}
    step = Step("label", {"model": "cmu41"}, {"labels": {"C7": row}})
    found = Recording(
        np.zeros((2, 1, 3)), ("C7",), 100.0, confidence=np.array([sure]), history=(step,)
    )
    show(
        {
            "file": "x.c3d",
            "model": "cmu41",
            "labels_given": 1,
            "labels_known": 1,
            "points_left_unlabelled": 0,
            "doubtful": [],
            "warnings": [],
            "labels": {"C7": row},
        }
    )
    (line,) = (x for x in capsys.readouterr().out.splitlines() if "C7" in x)
    assert said in line.split()
    assert f'C7</th><td class="dim">{said}</td>' in labelling_html(found, model)


@pytest.mark.parametrize(
    ("extra", "said"),
    [
        (["--model", "nobody", "-o", "x.c3d"], "neither a file nor a built-in model"),
        (["--model", "cmu41", "-o", "x.bvh"], "labels go to .c3d"),
        (["--model", "cmu41", "-o", "no/x.c3d"], "there is no folder no; make it first"),
        (["--model", "cmu41", "-o", "x.c3d", "--set", "labelling.method=guess"], "known are pair"),
    ],
)
def test_what_cannot_be_meant_is_said_in_a_line(files, capsys, monkeypatch, extra, said):
    monkeypatch.chdir(files)
    assert run(["label", "raw.c3d", *extra]) == 2
    error = capsys.readouterr().err
    assert said in error.replace("\n", " ")
    assert not (files / "x.c3d").exists()
