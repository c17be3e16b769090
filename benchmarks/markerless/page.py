"""The results page, written from outcomes and nothing else."""

from collections.abc import Sequence

import numpy as np

from benchmarks.markerless.measures import ASTRAY
from benchmarks.markerless.real import NAMES, NEAR, RealOutcome
from benchmarks.markerless.rendered import CASES, Case, Outcome


def page(films: Sequence[Outcome], real: Sequence[RealOutcome]) -> str:
    """Return the page as Markdown; what has no outcome is named as not run."""
    lines = [
        "# Without markers",
        "",
        "Written by `python -m benchmarks.markerless`; see [how](../markerless.md). How fast it is "
        "stands on [a page of its own](markerless-speed.md).",
        "",
        "## Rendered films",
        "",
        "640 × 480 pixels. A *given* start is 2° and 8 mm off the true first pose, on a body whose "
        "shape is not known yet; the others are found from the images, from images of the empty "
        "room (*plates*), or from *masks* of the first frame alone. In clutter masks are needed: "
        "where things move and the light changes, plates of it tell too little. Of push-ups, whose "
        "arms and legs touch the floor, plates are enough. *Astray*: frames in which a "
        f"joint is more than {ASTRAY * 1e3:.0f} mm from the truth. Of several seeds the worst is "
        "shown. Limits stand in brackets; where there are any, no frame may be astray or unsolved.",
        "",
        "| film | method | start | cameras | frames | seeds | elbows, mean | elbows, RMS | joints, "
        "mean | joints, 95 % | frames astray | unsolved | overlap | limits |",
        "|---|---|---|--:|--:|---|--:|--:|--:|--:|--:|--:|--:|---|",
    ]
    done = dict.fromkeys(outcome.case for outcome in films)
    lines += [_row(case, [o for o in films if o.case == case]) for case in done]
    lines += _not_run([case.name for case in CASES if case not in done])
    lines += [
        "",
        "## Real footage",
        "",
        "Overlap is that with the masks that came with the recording. "
        f"*Wrists*: frames in which both lie within {NEAR * 1e3:.0f} mm of the keypoint solution, "
        "a second opinion and no truth. *Lost*: frames in which the tracker itself holds a limb "
        "lost. A *disturbed* start is 2° a joint and 8 mm off the one found.",
        *(
            f"Of {one.name.split(',')[0]} the largest piece of each mask counts, as specks are in "
            f"them (with them: {one.overlap_of_all:.2f}), and its calibration is mended as the "
            "check before tracking advises."
            for one in real
            if np.isfinite(one.overlap_of_all)
        ),
        "",
        "| recording | frames | overlap | wrists | lost | limits |",
        "|---|--:|--:|--:|--:|---|",
    ]
    for one in real:
        wrists = f"{100 * one.wrists_near:.0f} %" if np.isfinite(one.wrists_near) else "–"
        wrists += f" ({100 * one.wrists_wanted:.0f} %)" if one.wrists_wanted else ""
        lines.append(
            f"| {one.name} | {one.n_frames} | {_number(one.overlap, 2)} ({one.overlap_wanted:g}) | "
            f"{wrists} | {one.frames_lost} | {one.failed or _verdict(one.missed)} |"
        )
    lines += _not_run([name for name in NAMES if name not in {one.name for one in real}])
    return "\n".join(lines) + "\n"


def _not_run(names: Sequence[str]) -> list[str]:
    return ["", f"Not run: {'; '.join(names)}."] if names else []


def _row(case: Case, all_seeds: Sequence[Outcome]) -> str:
    errors = [o.errors for o in all_seeds if o.errors is not None]
    failed = [o for o in all_seeds if o.errors is None]
    note = _verdict(any(o.missed for o in all_seeds)) if case.limited else "none set"
    if case.to_fail:
        n = sum(o.fails for o in all_seeds)
        note = f"**fails** on {n} of {len(all_seeds)} seeds, as it is to show"
    if failed:
        note = f"{len(failed)} not tracked: {failed[0].failed}"
    start = "given" if case.given else f"found by {case.by}" if case.by else "found"
    counts = sorted({o.n_frames for o in all_seeds})
    frames = f"{counts[0]}" if len(counts) == 1 else f"{counts[0]} to {counts[-1]}"
    seeds = ", ".join(str(o.seed) for o in all_seeds)
    if left := [str(s) for s in case.seeds if s not in {o.seed for o in all_seeds}]:
        seeds += f" (not {', '.join(left)})"
    head = f"| {case.name} | {case.method} | {start} | {case.n_cameras} | {frames} | {seeds} |"
    if not errors:
        return head + " |" * 7 + f" {note} |"

    def worst(name: str) -> float:
        return max(getattr(e, name) for e in errors)

    return (
        f"{head} {_number(worst('elbow_mean'), 2)}°{_limit(case.mean, '°')} | "
        f"{_number(worst('elbow_rms'), 2)}°{_limit(case.rms, '°')} | "
        f"{_number(worst('joints_mean'), 1)} mm{_limit(case.joints, ' mm')} | "
        f"{_number(worst('joints_p95'), 1)} mm | {int(worst('frames_astray'))} | "
        f"{int(worst('frames_unsolved'))} | {_number(min(e.overlap for e in errors), 2)} | "
        f"{note} |"
    )


def _verdict(missed: bool) -> str:
    return "**missed**" if missed else "met"


def _limit(limit: float | None, unit: str) -> str:
    return "" if limit is None else f" ({limit:g}{unit})"


def _number(value: float, digits: int) -> str:
    return "–" if not np.isfinite(value) else f"{value:.{digits}f}"
