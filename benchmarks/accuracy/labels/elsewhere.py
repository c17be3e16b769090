"""Other layouts: plates and a squat in halves, functional trials, bodies that are no people."""

import time
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from benchmarks.accuracy.labels.sources import cmu, folder, model_of, others, score_of, shuffled
from kinesphere import read
from kinesphere.data import Recording, Segment, TopologicalModel
from kinesphere.errors import KinesphereError
from kinesphere.io import read_segments
from kinesphere.labelling import built_in_model, label, match_labels
from kinesphere.labelling.pair_statistics import match_pair_statistics
from kinesphere.skeleton import learn_model
from kinesphere.skeleton.naming import mirror_pairs
from kinesphere.skeleton.statistics import marker_statistics
from kinesphere.synthetic import HAND, QUADRUPED, make_performance


def _score(name: str, model: TopologicalModel, recording: Recording, what: str) -> dict[str, Any]:
    """Label one recording whose labels are the model's, stripped and shuffled."""
    known = [c for c, x in enumerate(recording.labels) if x in model.labels]
    known = [c for c in known if recording.seen[:, c].sum() > 1]
    points, order = shuffled(recording.markers[:, known], np.random.default_rng(5))
    truth = np.array([model.labels.index(recording.labels[known[k]]) for k in order])
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
        rows.append(_score(name, model, second, "second half by the first (one person)"))
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


def functional() -> list[dict[str, Any]]:
    """Every functional trial by the model of each other one: one person."""
    known = built_in_model("plugin-gait")
    files = sorted((folder() / "functional").glob("*.c3d"))
    trials = {f.stem: match_labels(read(f), known) for f in files}
    rows = []
    for learnt in ("Test_func_lhip", "Test_func_trunk"):
        model = replace(
            known, statistics=(marker_statistics(trials[learnt], known.labels, learnt),)
        )
        for name, trial in trials.items():
            if name != learnt:
                rows.append(_score(f"functional/{name}", model, trial, f"by {learnt} (one person)"))
    return rows


def static() -> list[dict[str, Any]]:
    """Movements by the model of a standing trial, of the same person and of another one."""
    known = built_in_model("plugin-gait")
    rows = []

    def trial(path: str) -> Recording:
        return match_labels(read(folder() / path), known)

    people = {
        "functional/anatomical_posture": [
            f"functional/Test_func_{x}"
            for x in ("anat", "lankle", "lhip", "lknee", "rankle", "rhip", "rknee", "trunk")
        ],
        "plugin-gait/PiG_Calibration-FlatFoot-Full": ["plugin-gait/PiG_Motion-FlatFoot-Full"],
        "plugin-gait/pycgm_static": ["plugin-gait/pycgm_movement"],
    }
    for standing, own in people.items():
        learnt = marker_statistics(trial(f"{standing}.c3d"), known.labels, standing)
        model = replace(known, statistics=(learnt,))
        for moving in [m for trials in people.values() for m in trials]:
            if moving in own:
                rows.append(
                    _score(moving, model, trial(f"{moving}.c3d"), f"by {standing} (one person)")
                )
            elif moving in (
                people["functional/anatomical_posture"][-1],
                "plugin-gait/pycgm_movement",
                "plugin-gait/PiG_Motion-FlatFoot-Full",
            ):
                rows.append(
                    _score(moving, model, trial(f"{moving}.c3d"), f"by {standing} (another person)")
                )
    return rows


def creatures() -> list[dict[str, Any]]:
    """Synthetic bodies that are no people, by the models of two others of their kind."""
    rows = []
    for plan in (QUADRUPED, HAND):
        actors = [
            make_performance(np.random.default_rng(seed), plan=plan, layout="bodies")
            for seed in (1, 2, 3)
        ]
        same = actors[0]
        half = same.recording.n_frames // 2
        first = replace(same.recording, markers=same.recording.markers[:half])
        model = replace(
            same.model,
            statistics=(marker_statistics(first, same.model.labels, plan.name),),
        )
        second = replace(same.recording, markers=same.recording.markers[half:])
        rows.append(_score(plan.name, model, second, "second half by the first (one body)"))
    return rows


def two_people() -> list[dict[str, Any]]:
    """Two people in one volume, told apart by the model of each: learnt from later in the file."""
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
        found = label(raw, model)
        right = wrong = 0
        for column, given in enumerate(found.labels):
            if given not in model.labels:
                continue
            same = [
                k
                for k in range(82)
                if np.array_equal(found.markers[:, column], points[:, k], equal_nan=True)
            ]
            truth = order[same[0]] if same else -1
            right += truth == offset + model.labels.index(given)
            wrong += truth != offset + model.labels.index(given)
        rows.append(
            {"set": f"two people, {name}", "what": "by the model of one (same person)",
             "points": 41, "right": int(right), "wrong": int(wrong)}
        )  # fmt: skip
        print(rows[-1], flush=True)
    return rows


def refusals() -> list[dict[str, Any]]:
    """Try what does not fit: the reason, or how much is labelled all the same."""
    body = cmu("06_01").markers
    squat = read(folder() / "formats" / "squat.c3d")
    static = read(folder() / "plugin-gait" / "PiG_Calibration-FlatFoot-Full.c3d")
    tried: Mapping[str, tuple[np.ndarray, Sequence[str]]] = {
        "three markers": (body[:, :3], ()),
        "one frame": (body[:1], ()),
        "standing still: one frame 200 times": (np.repeat(body[:1], 200, axis=0), ()),
        "a similar layout of 53 markers, squatting": (squat.markers, ()),
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
            rows.append({"what": what, "given": given, "of": points.shape[1], "said": match.note})
        except KinesphereError as error:
            rows.append({"what": what, "given": 0, "of": points.shape[1], "said": str(error)})
        print(rows[-1], flush=True)
    return rows


def speed() -> list[dict[str, Any]]:
    """Frames labelled a second in batch, and the time a live frame takes once locked on."""
    from kinesphere.labelling.live import LiveLabels

    rows = []
    for name in ("135_02", "02_05"):
        recording = cmu(name)
        points, truth = shuffled(recording.markers, np.random.default_rng(8))
        model = model_of(others(name))
        match_pair_statistics(points, model)
        start = time.perf_counter()
        match_pair_statistics(points, model)
        batch = time.perf_counter() - start
        n = round(5 * recording.rate)
        live = LiveLabels(recording.markers[:n], recording.labels, recording.rate)
        rng = np.random.default_rng(9)
        # ghosts make 50 points of the 41
        low, high = np.nanmin(recording.markers), np.nanmax(recording.markers)
        times, right, wrong = [], 0, 0
        for frame in recording.markers[n:]:
            crowd = np.concatenate([frame, rng.uniform(low, high, size=(9, 3))])
            order = rng.permutation(len(crowd))
            start = time.perf_counter()
            given = live.label(crowd[order])
            times.append(time.perf_counter() - start)
            ok = given == np.where(order < 41, order, -1)
            right += int((ok & (given >= 0)).sum())
            wrong += int((~ok & (given >= 0)).sum())
        rows.append(
            {
                "recording": name,
                "frames": recording.n_frames,
                "batch_frames_per_s": round(recording.n_frames / batch),
                "live_points": 50,
                "live_median_ms": round(1e3 * float(np.median(times)), 3),
                "live_p99_ms": round(1e3 * float(np.percentile(times, 99)), 3),
                "live_right": right,
                "live_wrong": wrong,
                "live_samples": int(recording.seen[n:].sum()),
            }
        )
        del truth
        print(rows[-1], flush=True)
    return rows
