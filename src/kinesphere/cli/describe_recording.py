"""A recording in figures, for machines and for people."""

from collections import Counter
from typing import Any

import numpy as np

from kinesphere.cli.console import print_pairs, print_table, print_title, print_warnings, stdout
from kinesphere.cli.stages import source_in_words
from kinesphere.data import Json, Recording, TopologicalModel
from kinesphere.errors import KinesphereError
from kinesphere.labelling import (
    built_in_model,
    built_in_models,
    choose_model,
    coverage,
    find_subjects,
    match_labels,
)
from kinesphere.quality import (
    check_at_size,
    check_unit,
    find_gaps,
    gathered,
    orient,
    times_in_words,
    told_unit,
)

_WORST = 8
"""Markers listed by how much of them is missing."""


def describe_recording(recording: Recording, subject: str | None = None) -> dict[str, Any]:
    """Return what is in a recording: units in the names, everything JSON can hold."""
    subjects = find_subjects(recording)
    models = {
        name: round(coverage(recording, built_in_model(name), subject), 4)
        for name in built_in_models()
    }
    chosen = choose_model(recording, subject)
    read = recording.history[0] if recording.history else None
    times = told_unit(tuple(check_unit(recording)))
    found = check_at_size(recording, times)
    return {
        "kind": "recording",
        "read": {**read.settings, **read.findings} if read else {},
        "n_frames": recording.n_frames,
        "rate_hz": recording.rate,
        "duration_s": recording.n_frames / recording.rate,
        "first_frame": recording.first_frame,
        "n_markers": recording.n_markers,
        "labels": list(recording.labels),
        "n_unlabelled": sum(label.startswith("*") for label in recording.labels),
        "subjects": list(subjects),
        "models": models,
        "model": chosen.name if chosen else None,
        "times_too_large": times,
        "up": _up(recording, chosen, subject),
        "gaps": _gaps(recording),
        "outputs": dict(Counter(output.kind for output in recording.outputs)),
        "analog": _analog(recording),
        "events": [
            {"time_s": event.time, "label": event.label, "context": event.context}
            for event in recording.events
        ],
        "warnings": [warning for step in recording.history for warning in step.warnings],
        "findings": [finding.as_json() for finding in found],
        "findings_in_short": [finding.as_json() for finding in gathered(found)],
    }


def show_recording(summary: dict[str, Any]) -> None:
    """Print the summary as tables."""
    console = stdout()
    read = summary["read"]
    print_title(console, summary["file"], str(read.get("format", "")).upper())
    print_pairs(console, _pairs(summary))
    worst = summary["gaps"]["worst"]
    if worst:
        print_title(console, "Missing most")
        rows = [
            (
                gap["marker"],
                f"{gap['missing']:.1%}",
                str(gap["gaps"]),
                f"{gap['longest_s']:.2f} s",
                f"frame {gap['longest_from_frame']}",
            )
            for gap in worst
        ]
        print_table(console, ("marker", "missing", "gaps", "longest", "from"), rows, "lrrrl")
    doubts = [*summary["warnings"], *summary["up"]["warnings"]]
    if doubts:
        print_title(console, "Read with doubts")
        print_warnings(console, doubts)
    findings = summary["findings_in_short"]
    nothing = "Nothing else looks wrong with it" if doubts else "Nothing looks wrong with it"
    print_title(console, "What is wrong with it" if findings else nothing)
    if findings:
        print_table(
            console,
            ("", "found", "remedy"),
            [(f["severity"], f["what"], f["remedy"]) for f in findings],
            doubtful=("error", "warning"),
        )


def _pairs(summary: dict[str, Any]) -> list[tuple[str, str]]:
    read, up = summary["read"], summary["up"]
    last = summary["first_frame"] + summary["n_frames"] - 1
    pairs = [
        (
            "frames",
            f"{summary['n_frames']:,} ({summary['first_frame']}–{last}) at {summary['rate_hz']:g} "
            f"Hz, {summary['duration_s']:.2f} s",
        ),
        (
            "markers",
            f"{summary['n_markers']} ({summary['n_unlabelled']} unlabelled), "
            f"{summary['gaps']['missing']:.1%} of all positions missing",
        ),
        ("unit", _unit(str(read.get("unit", "unknown")), summary["times_too_large"])),
        ("up", up["text"]),
        ("subjects", ", ".join(summary["subjects"]) or "one, without a prefix"),
        ("models", _models(summary)),
    ]
    if summary["outputs"]:
        listed = ", ".join(
            f"{n} {kind.replace('_', ' ')}" for kind, n in summary["outputs"].items()
        )
        pairs.append(("vendor outputs", listed))
    if analog := summary["analog"]:
        pairs.append(("analog", f"{len(analog['labels'])} channels at {analog['rate_hz']:g} Hz"))
    if events := summary["events"]:
        kinds = Counter(f"{e['context']} {e['label']}".strip() for e in events)
        pairs.append(("events", ", ".join(f"{n} {kind}" for kind, n in kinds.items())))
    return pairs


def _models(summary: dict[str, Any]) -> str:
    shares = ", ".join(f"{name} {share:.0%}" for name, share in summary["models"].items())
    chosen = summary["model"]
    return f"{shares} of its labels; " + (
        f"solve takes {chosen}"
        if chosen
        else "solve goes by motion alone, unless --model names one (see 'kinesphere model')"
    )


def _unit(read: str, times: float) -> str:
    return read if times == 1 else f"{read}, likely wrong: lengths are {times_in_words(times)}"


def _up(
    recording: Recording, model: TopologicalModel | None, subject: str | None
) -> dict[str, Json]:
    """Return which way is up by the file, and by the body where it says more."""
    found: dict[str, Json] = {"file": recording.up, "used": None, "from": None, "warnings": []}
    try:
        if model is not None:
            recording = match_labels(recording, model, subject)
        step = orient(recording, model).history[-1]
    except KinesphereError as error:
        found["text"] = f"{recording.up or 'not said'} by the file; {error}"
        return found
    used, source = step.findings.get("up"), step.findings.get("up_from")
    upright = step.findings.get("upright_share")
    found |= {"used": used, "from": source, "body": upright, "warnings": list(step.warnings)}
    said = f"the file says {recording.up}" if recording.up else "the file does not say"
    text = f"{used}, {source_in_words(source)}: {said}"
    if isinstance(upright, dict):
        shares = {way: share for way, share in upright.items() if isinstance(share, float)}
        if shares:
            way = max(shares, key=shares.__getitem__)
            text += f", the body stands along {way} in {shares[way]:.0%} of the frames"
    found["text"] = text + ("; mirrored" if step.findings.get("mirrored") else "")
    return found


def _gaps(recording: Recording) -> dict[str, Any]:
    missing = ~recording.seen
    by_marker: dict[int, list[Any]] = {}
    for gap in find_gaps(recording):
        by_marker.setdefault(gap.column, []).append(gap)
    # Unlabelled points come and go by nature; what is missing of them says little.
    named = [c for c in by_marker if not recording.labels[c].startswith("*")]
    columns = sorted(named or by_marker, key=lambda c: -int(missing[:, c].sum()))
    worst = []
    for column in columns[:_WORST]:
        gaps = by_marker[column]
        longest = max(gaps, key=lambda gap: int(gap.n_frames))
        worst.append(
            {
                "marker": recording.labels[column],
                "missing": round(float(missing[:, column].mean()), 6),
                "gaps": len(gaps),
                "longest_s": longest.n_frames / recording.rate,
                "longest_from_frame": recording.first_frame + longest.start,
            }
        )
    return {
        "missing": float(np.mean(missing)) if missing.size else 0.0,
        "markers_with_gaps": len(by_marker),
        "worst": worst,
    }


def _analog(recording: Recording) -> dict[str, Json] | None:
    analog = recording.analog
    if analog is None or not analog.labels:
        return None
    return {"rate_hz": analog.rate, "labels": list(analog.labels), "units": list(analog.units)}
