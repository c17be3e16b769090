"""Other layouts: plates and a squat in halves, bodies that are no people; what does not fit."""

import time
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from benchmarks.accuracy.labels.sources import cmu, folder, model_of, score_of, shuffled
from kinesphere import read
from kinesphere.data import Recording, Segment, TopologicalModel
from kinesphere.data.label_sides import mirror_pairs
from kinesphere.errors import KinesphereError
from kinesphere.io import read_segments
from kinesphere.labelling import built_in_model, label
from kinesphere.labelling.matching import Match
from kinesphere.labelling.pair_statistics import match_pair_statistics
from kinesphere.labelling.template import template_of
from kinesphere.skeleton import learn_model
from kinesphere.skeleton.statistics import marker_statistics
from kinesphere.synthetic import HAND, QUADRUPED, make_performance

SQUATTING = "a similar layout of 53 markers, squatting"
_SAME = ("LFHD", "LBHD", "LUPA", "LELB", "LFWT", "LBWT", "LKNE", "LSHN", "LANK", "LTOE", "LMT5")
_LEFT = {
    **dict(zip(_SAME, _SAME, strict=True)),
    "LHIP": "LTHI",
    "LHEL": "LHEE",
    "LFSH": "LSHO",
    "LOWR": "LWRB",
    "LIWR": "LWRA",
}
COUNTERPARTS = {
    **{x: x for x in ("C7", "T10", "CLAV", "STRN")},
    **_LEFT,
    **{f"R{x[1:]}": f"R{y[1:]}" for x, y in _LEFT.items()},
}
"""Marker of the squatting layout → the one of the 41 that sits in the same place."""


def _told(labels: Sequence[str], match: Match, model: TopologicalModel) -> str:
    """Return how many markers of another layout got the label of their own place and side."""
    given = [
        (label.split(":")[-1], model.labels[of])
        for label, of, sure in zip(labels, match.labels, match.confidence, strict=True)
        if of >= 0 and sure >= 0.1
    ]
    there = sum(COUNTERPARTS.get(own) == label for own, label in given)
    sides = sum({own[0], label[0]} == {"L", "R"} for own, label in given)
    return f"{there} are where the label's marker sits, {sides} on the other side of the body"


def scored(name: str, model: TopologicalModel, recording: Recording, what: str) -> dict[str, Any]:
    """Label one recording whose labels are the model's, stripped and shuffled."""
    known = [c for c, x in enumerate(recording.labels) if x in model.labels]
    known = [c for c in known if recording.seen[:, c].sum() > 1]
    points, order = shuffled(recording.markers[:, known], np.random.default_rng(5))
    # markers that the learning recording lacked have no label to be given
    learnt = set(template_of(model).labels)
    names = [recording.labels[known[k]] for k in order]
    truth = np.array([model.labels.index(x) if x in learnt else -1 for x in names])
    start = time.perf_counter()
    match = match_pair_statistics(points, model)
    labels = np.where(match.confidence >= 0.1, match.labels, -1)
    score = score_of(labels, truth)
    row = {
        "set": name,
        "what": what,
        "points": score.points,
        "right": score.right,
        "wrong": score.wrong,
        "seconds": round(time.perf_counter() - start, 2),
    }
    print(row, match.note, flush=True)
    return row


def halves() -> list[dict[str, Any]]:
    """Model from the first half, test on the second: one person each."""
    rows = []
    plates = read(folder() / "plates" / "KneeltoProne01.c3d")
    segments = read_segments(folder() / "plates" / "MarkerSet.xml")
    squat = read(folder() / "formats" / "squat.c3d")
    for name, recording, groups in (
        ("plates/KneeltoProne01", plates, segments),
        ("formats/squat", squat, None),
    ):
        n = recording.n_frames // 2
        first = replace(recording, markers=recording.markers[:n], residuals=None, outputs=())
        first = replace(first, analog=None, events=())
        model = _one_segment(first, name) if groups is None else learn_model([first], name, groups)
        second = replace(first, markers=recording.markers[n:])
        rows.append(scored(name, model, second, "second half by the first (one person)"))
    return rows


def _one_segment(recording: Recording, name: str) -> TopologicalModel:
    """Return a model of a layout whose segments nobody has told: all markers in one."""
    labels = tuple(x for c, x in enumerate(recording.labels) if recording.seen[:, c].mean() > 0.1)
    return TopologicalModel(
        name,
        (Segment("limb_01", labels),),
        (),
        "limb_01",
        mirror=mirror_pairs(labels),
        statistics=(marker_statistics(recording, labels, name),),
    )


def creatures() -> list[dict[str, Any]]:
    """Synthetic bodies that are no people, each by the first half of its own recording."""
    rows = []
    for plan in (QUADRUPED, HAND):
        same = make_performance(np.random.default_rng(1), plan=plan, layout="bodies")
        half = same.recording.n_frames // 2
        first = replace(same.recording, markers=same.recording.markers[:half])
        model = replace(
            same.model,
            statistics=(marker_statistics(first, same.model.labels, plan.name),),
        )
        second = replace(same.recording, markers=same.recording.markers[half:])
        rows.append(scored(plan.name, model, second, "second half by the first (one body)"))
    return rows


def two_people() -> list[dict[str, Any]]:
    """Two people in one volume: by the model of each, of later in the file, and of two others."""
    a, b = cmu("02_05"), cmu("135_02")
    n = a.n_frames // 2
    rng = np.random.default_rng(6)
    together = np.concatenate([a.markers[:n], b.markers[:n] + np.array([0.5, 0.0, 1.0])], axis=1)
    points, order = shuffled(together, rng)
    raw = Recording(points, tuple(f"*{i}" for i in range(82)), a.rate)
    rows = []
    for name, offset, recording in (("02_05", 0, a), ("135_02", 41, b)):
        later = replace(recording, markers=recording.markers[n:], residuals=None, outputs=())
        later = replace(later, analog=None, events=())
        known = built_in_model("cmu41")
        model = replace(known, statistics=(marker_statistics(later, known.labels, name),))
        right, given = _right_of_each(label(raw, model), points, order, model)
        own = right[offset // 41]
        rows.append(
            {"set": f"two people, {name}", "what": "by the model of one (same person)",
             "points": 41, "right": own, "wrong": given - own}
        )  # fmt: skip
        print(rows[-1], flush=True)
    for name in ("06_01", "85_02"):
        model = model_of((name,))
        right, given = _right_of_each(label(raw, model), points, order, model)
        best = right.index(max(right))
        rows.append(
            {"set": f"two people, {('02_05', '135_02')[best]}",
             "what": f"by the model of {name} (another person), which chose whom to label",
             "points": 41, "right": right[best], "wrong": given - right[best]}
        )  # fmt: skip
        print(rows[-1], flush=True)
    return rows


def _right_of_each(
    found: Recording, points: np.ndarray, order: np.ndarray, model: TopologicalModel
) -> tuple[list[int], int]:
    """Return how many labels are right on each of two people, and how many were given."""
    right, given = [0, 0], 0
    for column, name in enumerate(found.labels):
        if name not in model.labels:
            continue
        given += 1
        same = [
            k
            for k in range(points.shape[1])
            if np.array_equal(found.markers[:, column], points[:, k], equal_nan=True)
        ]
        who, marker = divmod(int(order[same[0]]), 41) if same else (0, -1)
        right[who] += marker == model.labels.index(name)
    return right, given


def refusals() -> list[dict[str, Any]]:
    """Try what does not fit: the reason, or how much is labelled all the same."""
    body = cmu("06_01").markers
    squat = read(folder() / "formats" / "squat.c3d")
    static = read(folder() / "plugin-gait" / "PiG_Calibration-FlatFoot-Full.c3d")
    tried: Mapping[str, tuple[np.ndarray, Sequence[str]]] = {
        "three markers": (body[:, :3], ()),
        "one frame": (body[:1], ()),
        "standing still: one frame 200 times": (np.repeat(body[:1], 200, axis=0), ()),
        SQUATTING: (squat.markers, ()),
        "Plug-in-Gait, standing trial": (static.markers, ()),
        "random walks": (
            np.cumsum(np.random.default_rng(7).normal(scale=0.01, size=(600, 41, 3)), axis=0),
            (),
        ),
    }
    rows = []
    model = model_of(("02_05", "85_02", "135_02"))
    for what, (points, _) in tried.items():
        try:
            match = match_pair_statistics(np.asarray(points), model)
            given = int((match.confidence >= 0.1).sum())
            said = match.note
            if what == SQUATTING:
                said = _told(squat.labels, match, model)
            rows.append({"what": what, "given": given, "of": points.shape[1], "said": said})
        except KinesphereError as error:
            rows.append({"what": what, "given": 0, "of": points.shape[1], "said": str(error)})
        print(rows[-1], flush=True)
    return rows
