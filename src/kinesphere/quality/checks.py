"""What is wrong with a recording, before anything is done with it."""

from collections.abc import Callable, Iterable, Iterator

import numpy as np

from kinesphere.data import Array, Recording
from kinesphere.quality.body import HEAD, HEELS, SHOULDERS, TOES, Body, find_bodies
from kinesphere.quality.findings import Finding
from kinesphere.quality.gaps import runs

LONG_GAP = 0.5
"""s; up to here a gap can be interpolated between its ends without much harm."""
MUCH_MISSING, HALF_MISSING = 0.05, 0.5
"""Shares of frames without a marker from which on that is worth a note and a warning."""
FASTEST = 20.0
"""m/s; a boxer's fist reaches 10 to 15, a thrower's hand 20."""
LONGEST_STEP = 1.0
"""s; over a longer gap a mean speed says nothing."""
SAME_PLACE = 1e-3
"""m; two markers are 9 mm and more across."""
STILL = 1e-6
"""m; a real marker jitters by a hundred times as much."""
SAMPLED_FRAMES = 300
"""Frames, evenly spread, that a comparison of all pairs looks at."""
BODY_HEIGHT = (0.3, 2.5)
"""m between feet and head (or shoulders), from a crouching child to a giant on tiptoe."""
SCENE = (0.01, 50.0)
"""m across all markers of a frame, from a finger to a hall."""


def check_recording(recording: Recording) -> tuple[Finding, ...]:
    """Return everything that looks wrong, worst first; empty where nothing does.

    Positions are taken to be in metres. Unlabelled points are not looked at one by one: they come
    and go by nature. Frames are named in the file's own count.
    """
    if recording.n_frames == 0 or recording.n_markers == 0:
        kind = "frames" if recording.n_frames == 0 else "markers"
        return (
            Finding("empty", "error", f"the recording has no {kind}", "export it again with data"),
        )
    if not recording.seen.any():
        return (
            Finding(
                "nothing-seen",
                "error",
                f"no marker is seen in any of the {recording.n_frames} frames",
                "reconstruct the trial again, or export another one",
            ),
        )
    rules: Iterable[Callable[[Recording], Iterator[Finding]]] = (
        _one_frame,
        _unit,
        _never_seen,
        _at_zero,
        _constant,
        _coincident,
        _jumps,
        _empty_frames,
        _gaps,
    )
    found = [finding for rule in rules for finding in rule(recording)]
    order = ("error", "warning", "note")
    return tuple(sorted(found, key=lambda finding: order.index(finding.severity)))


def _labelled(recording: Recording) -> list[int]:
    return [c for c, label in enumerate(recording.labels) if not label.startswith("*")]


def _one_frame(recording: Recording) -> Iterator[Finding]:
    if recording.n_frames == 1:
        yield Finding(
            "one-frame",
            "warning",
            "the recording has a single frame: nothing moves in it",
            "a skeleton can only be measured from a recording with motion",
            frame=recording.first_frame,
        )


def _unit(recording: Recording) -> Iterator[Finding]:
    heights = [h for body in find_bodies(recording) if np.isfinite(h := _height(body))]
    low, high = BODY_HEIGHT
    for height in heights:
        if not low <= height <= high:
            yield Finding(
                "unit",
                "warning",
                f"feet and head are {height:.3g} m apart, a person's are {low} to {high} m",
                "check the length unit of the file",
                numbers=(("height_m", round(height, 6)),),
            )
    if heights:
        return
    points = recording.markers[recording.seen.any(axis=1)]
    across = float(np.linalg.norm(np.median(np.nanmax(points, 1) - np.nanmin(points, 1), axis=0)))
    low, high = SCENE
    if recording.n_markers > 1 and not low <= across <= high:
        yield Finding(
            "unit",
            "warning",
            f"the markers of a frame are {across:.3g} m across, {low} to {high} m is likely",
            "check the length unit of the file",
            numbers=(("across_m", round(across, 6)),),
        )


def _height(body: Body) -> float:
    """Return the median distance between feet and head, in m; NaN where either is missing."""
    head, shoulders, feet = body.middle(*HEAD), body.middle(*SHOULDERS), body.middle(*TOES, *HEELS)
    upper = shoulders if head is None else head
    if upper is None or feet is None:
        return float("nan")
    lengths = np.linalg.norm(upper - feet, axis=1)
    return float(np.median(lengths[np.isfinite(lengths)])) if np.isfinite(lengths).any() else np.nan


def _never_seen(recording: Recording) -> Iterator[Finding]:
    never = [c for c in _labelled(recording) if not recording.seen[:, c].any()]
    if never:
        labels = tuple(recording.labels[c] for c in never)
        yield Finding(
            "never-seen",
            "warning",
            f"never seen: {', '.join(labels)}",
            "label the trial again, or leave these markers out of the model",
            markers=labels,
        )


def _at_zero(recording: Recording) -> Iterator[Finding]:
    zero = (recording.markers == 0).all(axis=2)
    for c in _labelled(recording):
        if zero[:, c].any():
            n, first = int(zero[:, c].sum()), int(zero[:, c].argmax())
            yield Finding(
                "at-zero",
                "warning",
                f"{recording.labels[c]} is exactly at the origin in {n} frames, from frame "
                f"{recording.first_frame + first} on: likely missing, written as zero",
                "export missing markers as missing (residual -1 in C3D, blank in TRC)",
                markers=(recording.labels[c],),
                frame=recording.first_frame + first,
                numbers=(("frames", n),),
            )


def _constant(recording: Recording) -> Iterator[Finding]:
    labelled = _labelled(recording)
    seen = recording.seen[:, labelled]
    points = recording.markers[:, labelled]
    enough = seen.sum(axis=0) >= max(2.0, recording.rate)  # a second of it
    high = np.where(seen[..., None], points, -np.inf).max(axis=0, initial=-np.inf)
    low = np.where(seen[..., None], points, np.inf).min(axis=0, initial=np.inf)
    still = enough & ((high - low) < STILL).all(axis=1)
    if still.all() or not (enough & ~still).any():
        return  # a statue, or nothing to compare with
    for i in np.flatnonzero(still):
        label = recording.labels[labelled[i]]
        if not (points[seen[:, i], i] == 0).all():
            yield Finding(
                "constant",
                "warning",
                f"{label} never moves while others do",
                "leave it out, or label the trial again",
                markers=(label,),
                frame=recording.first_frame + int(seen[:, i].argmax()),
            )


def _coincident(recording: Recording) -> Iterator[Finding]:
    labelled = _labelled(recording)
    wanted = min(SAMPLED_FRAMES, recording.n_frames)
    frames = np.unique(np.linspace(0, recording.n_frames - 1, wanted).astype(int))
    points = recording.markers[frames][:, labelled]
    for i in range(len(labelled) - 1):
        distances = np.linalg.norm(points[:, i + 1 :] - points[:, i : i + 1], axis=2)
        together = np.isfinite(distances).sum(axis=0)
        same = (distances < SAME_PLACE).sum(axis=0)  # NaN compares as False
        for j in np.flatnonzero((same > 0) & (2 * same >= together)):
            pair = (recording.labels[labelled[i]], recording.labels[labelled[i + 1 + j]])
            frame = recording.first_frame + int(frames[(distances[:, j] < SAME_PLACE).argmax()])
            yield Finding(
                "coincident",
                "warning",
                f"{pair[0]} and {pair[1]} are at the same place from frame {frame} on",
                "one of them is a copy: leave it out",
                markers=pair,
                frame=frame,
            )


def _jumps(recording: Recording) -> Iterator[Finding]:
    for c in _labelled(recording):
        at = np.flatnonzero(recording.seen[:, c])
        if len(at) < 2:
            continue
        lasts = np.diff(at) / recording.rate
        steps = np.linalg.norm(np.diff(recording.markers[at, c], axis=0), axis=1)
        speeds: Array = np.where(lasts <= LONGEST_STEP, steps / lasts, 0.0)
        fast = np.flatnonzero(speeds > FASTEST)
        if len(fast) == 0:
            continue
        worst = int(speeds.argmax())
        first = recording.first_frame + int(at[fast[0] + 1])
        label = recording.labels[c]
        yield Finding(
            "jump",
            "warning",
            f"{label} jumps {_times(len(fast))}, first into frame {first}; the fastest by "
            f"{steps[worst] * 1e3:.0f} mm into frame {recording.first_frame + int(at[worst + 1])} "
            f"({speeds[worst]:.0f} m/s)",
            "look for a swap with another marker, or a ghost, around these frames",
            markers=(label,),
            frame=first,
            numbers=(("jumps", len(fast)), ("fastest_m_per_s", round(float(speeds[worst]), 1))),
        )


def _empty_frames(recording: Recording) -> Iterator[Finding]:
    nobody = ~recording.seen[:, _labelled(recording)].any(axis=1)
    if nobody.any():
        frame = recording.first_frame + int(nobody.argmax())
        yield Finding(
            "empty-frames",
            "note",
            f"no labelled marker is seen in {nobody.mean():.1%} of the frames, first in {frame}",
            "cut the recording to where the person is in view",
            frame=frame,
            numbers=(("empty_share", round(float(nobody.mean()), 4)),),
        )


def _gaps(recording: Recording) -> Iterator[Finding]:
    labelled = _labelled(recording)
    seen = recording.seen[:, labelled]
    missing = ~seen & seen.any(axis=1, keepdims=True)  # frames without anybody are told once
    columns, starts, stops = runs(missing)
    shares = missing.mean(axis=0)
    for i in np.flatnonzero(shares):
        if not seen[:, i].any():
            continue  # told as never seen
        start, stop = starts[columns == i], stops[columns == i]
        at = int((stop - start).argmax())
        share, seconds = float(shares[i]), float((stop - start)[at] / recording.rate)
        if share < MUCH_MISSING and seconds <= LONG_GAP:
            continue
        label, frame = recording.labels[labelled[i]], recording.first_frame + int(start[at])
        yield Finding(
            "gap",
            "warning" if share >= HALF_MISSING else "note",
            f"{label} is missing in {share:.1%} of the frames, longest from frame {frame} on for "
            f"{seconds:.2f} s",
            "fill it where the trial is reconstructed; meanwhile the limb's other markers must do",
            markers=(label,),
            frame=frame,
            numbers=(("missing_share", round(share, 4)), ("longest_s", round(seconds, 4))),
        )


def _times(n: int) -> str:
    return "once" if n == 1 else f"{n} times"
