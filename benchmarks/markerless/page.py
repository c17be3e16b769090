"""The results page, written from outcomes and nothing else."""

from collections.abc import Sequence

import numpy as np

from benchmarks.markerless.measures import ASTRAY
from benchmarks.markerless.real import NEAR, RealOutcome
from benchmarks.markerless.rendered import Case, Outcome


def page(films: Sequence[Outcome], real: Sequence[RealOutcome], n_frames: int) -> str:
    """Return the page as Markdown."""
    lines = [
        "# Without markers",
        "",
        "Written by `python -m benchmarks.markerless`; see [how](../markerless.md).",
        "",
        "## Rendered films",
        "",
        f"{n_frames} frames at 640 × 480. A *given* start is 2° and 8 mm off the true first pose, "
        "the others are found from the images. *Astray*: frames in which a joint is more than "
        f"{ASTRAY * 1e3:.0f} mm from the truth. Of several seeds the worst is shown. Speed is that "
        "of tracking alone: without rendering, start and fitting of the shape.",
        "",
        "| film | start | cameras | seeds | elbows, mean (limit) | elbows, RMS (limit) | joints, "
        "mean (limit) | joints, 95 % | frames astray | unsolved | overlap | frames/s | |",
        "|---|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|---|",
    ]
    for case in dict.fromkeys(outcome.case for outcome in films):
        lines.append(_row(case, [o for o in films if o.case == case]))
    lines += [
        "",
        "## Real footage",
        "",
        f"*Wrists*: frames in which both lie within {NEAR * 1e3:.0f} mm of the keypoint solution, "
        "a second opinion and no truth.",
        "",
        "| recording | frames | overlap with given masks | wrists | frames with a lost limb | "
        "frames/s | |",
        "|---|--:|--:|--:|--:|--:|---|",
    ]
    for one in real:
        lines.append(
            f"| {one.name} | {one.n_frames} | {_number(one.overlap, 2)} | "
            f"{_number(100 * one.wrists_near, 0)} % | {one.frames_lost} | "
            f"{_number(one.frames_per_s, 1)} | {one.failed} |"
        )
    return "\n".join(lines) + "\n"


def _row(case: Case, all_seeds: Sequence[Outcome]) -> str:
    errors = [o.errors for o in all_seeds if o.errors is not None]
    failed = [o for o in all_seeds if o.errors is None]
    missed = "**missed**" if any(o.missed for o in all_seeds) else ""
    note = f"{len(failed)} not tracked: {failed[0].failed}" if failed else missed
    start = "given" if case.given else "found"
    if not errors:
        return (
            f"| {case.name} | {start} | {case.n_cameras} | {len(all_seeds)} |"
            + " |" * 8
            + f" {note} |"
        )

    def worst(name: str) -> float:
        return max(getattr(e, name) for e in errors)

    return (
        f"| {case.name} | {start} | {case.n_cameras} | {len(all_seeds)} | "
        f"{_number(worst('elbow_mean'), 2)}°{_limit(case.mean, '°')} | "
        f"{_number(worst('elbow_rms'), 2)}°{_limit(case.rms, '°')} | "
        f"{_number(worst('joints_mean'), 1)} mm{_limit(case.joints, ' mm')} | "
        f"{_number(worst('joints_p95'), 1)} mm | {int(worst('frames_astray'))} | "
        f"{int(worst('frames_unsolved'))} | {_number(min(e.overlap for e in errors), 2)} | "
        f"{_number(min(e.frames_per_s for e in errors), 1)} | {note} |"
    )


def _limit(limit: float | None, unit: str) -> str:
    return "" if limit is None else f" ({limit:g}{unit})"


def _number(value: float, digits: int) -> str:
    return "–" if not np.isfinite(value) else f"{value:.{digits}f}"
