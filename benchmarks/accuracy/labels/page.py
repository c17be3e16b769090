"""Results as Markdown."""

from collections.abc import Callable, Sequence
from typing import Any

Rows = Sequence[dict[str, Any]]

_HEAD = """\
# Labelling

Written by `python -m benchmarks.accuracy.labels [PART…]`, a part a table; every number is in
`benchmarks/results/labelling.json`. Labels are taken away and markers shuffled before each run. The
model never holds the person under test: `02`, `06`, `85` and `135` are four people of the CMU
database; sets of a single person say so. A label counts as given from a confidence of 0.1 on, the
default. *Wrong* counts labels given to another marker than theirs, or to no marker.
"""


def page(results: dict[str, Any]) -> str:
    """Return the page; parts that have not been run are left out."""
    parts = [_HEAD]
    for name, (title, section) in _SECTIONS.items():
        if results.get(name):
            parts += [f"## {title}\n", f"`python -m benchmarks.accuracy.labels {name}`\n"]
            parts.append(section(results[name]))
    return "\n".join(parts)


def _table(header: str, lines: Sequence[str], right: str) -> str:
    ruler = "|".join("---:" if c == "r" else "---" for c in right)
    return "\n".join([header, f"|{ruler}|", *lines]) + "\n"


def _pairs(rows: Rows) -> str:
    done = sum(row["ours"] == row["frames"] for row in rows)
    lines = [
        f"| {r['recording']} | {r['model']} | {r['frames']} | {r['ours']} | {r['huang_xia']} "
        f"| {r['similarity_tree']} | {r['markers_ours']} | {r['markers_huang_xia']} |"
        for r in rows
    ]
    return (
        "Frames in which every one of the 41 markers has its right label, as the paper counts; "
        "*markers* of 41. The similarity tree is given a real frame of the model's recording as "
        "its pose. The paper's own figures are not reached by its method as published: its "
        "alignment leaves a rotation free, and these people are not standing alike.\n\n"
        + _table(
            "| recording | model | frames | default | Huang & Xia | Li et al. | markers, default "
            "| markers, Huang & Xia |",
            lines,
            "llrrrrrr",
        )
        + f"\n{done} of {len(rows)} pairs perfect.\n"
    )


def _windows(rows: Rows) -> str:
    lines = [
        f"| {r['recording']} | {r['model']} | {r['windows']} | {r['perfect']} "
        f"| {r['right'] / r['points']:.1%} | {r['wrong']} |"
        for r in rows
    ]
    n, done = sum(r["windows"] for r in rows), sum(r["perfect"] for r in rows)
    right, wrong = sum(r["right"] for r in rows), sum(r["wrong"] for r in rows)
    return (
        _table(
            "| recording | model | windows | perfect | labelled right | wrong labels |",
            lines,
            "llrrrr",
        )
        + f"\n{done} of {n} windows perfect; of the labels given, "
        f"{right / max(right + wrong, 1):.2%} are right.\n"
    )


def _missing(rows: Rows) -> str:
    lines = []
    for count in sorted({r["missing"] for r in rows}):
        lines.append(_missing_line(str(count), [r for r in rows if r["missing"] == count]))
    lines.append(_missing_line("all", rows))
    return "By the model of the three other people.\n\n" + _table(
        "| missing | cases | given right, of those given | given right, of those there "
        "| cases without a wrong label |",
        lines,
        "lrrrr",
    )


def _missing_line(name: str, rows: Rows) -> str:
    points, right = sum(r["points"] for r in rows), sum(r["right"] for r in rows)
    wrong = sum(r["wrong"] for r in rows)
    clean = sum(r["wrong"] == 0 for r in rows) / len(rows)
    return (
        f"| {name} | {len(rows)} | {right / max(right + wrong, 1):.2%} | {right / points:.1%} "
        f"| {clean:.0%} |"
    )


def _reliability(rows: Rows) -> str:
    kinds = list(dict.fromkeys(r["cases"] for r in rows))
    lines = []
    for low in sorted({r["from"] for r in rows}):
        some = {r["cases"]: r for r in rows if r["from"] == low}
        to = next(iter(some.values()))["to"]
        cells = [_share(some[kind]["right"], some[kind]["labels"]) for kind in kinds]
        every = _share(
            sum(r["right"] for r in some.values()), sum(r["labels"] for r in some.values())
        )
        lines.append(f"| {low:g}–{to:g} | {' | '.join(cells)} | {every} |")
    return (
        "Right labels of those that were stated to be so sure, before any is refused: windows half "
        "their length later than above, other markers missing than above.\n\n"
        + _table(f"| confidence | {' | '.join(kinds)} | all |", lines, "l" + "r" * (len(kinds) + 1))
    )


def _share(right: int, of: int) -> str:
    return f"{right} of {of} ({right / of:.1%})" if of else "–"


def _broken(rows: Rows) -> str:
    lines = [_broken_line(f"{r['recording']}", r["ghosts"], r["hidden"], [r]) for r in rows]
    lines.append(_broken_line("all", "", "", rows))
    return (
        "2 mm noise, every trajectory cut into pieces of 0.2–3 s whose identities are dropped, at "
        "most 16 s of a recording, by the model of the three other people. Counted are samples of "
        "all markers together: F1 is of a recording, not the mean or the least of its markers'. "
        "*Below 0.98* counts the markers whose own F1 is.\n\n"
        + _table(
            "| recording | ghosts | hidden | pieces | precision | recall | F1 | below 0.98 |",
            lines,
            "lrrrrrrr",
        )
    )


def _broken_anew(rows: Rows) -> str:
    return (
        "The settings of the labelling of raw captures were chosen while looking at the captures "
        "above; these are the same recordings with other ghosts, gaps, cuts and noise. What went "
        "wrong in `85_02` and `135_02` with ten ghosts has since been looked at, and mended on "
        "captures of other seeds.\n\n" + _broken(rows).partition("\n\n")[2]
    )


def _broken_line(name: str, ghosts: object, hidden: object, rows: Rows) -> str:
    samples, right = sum(r["samples"] for r in rows), sum(r["right"] for r in rows)
    wrong = sum(r["wrong"] for r in rows)
    precision, recall = right / max(right + wrong, 1), right / samples
    f1 = 2 * right / max(samples + right + wrong, 1)
    counted = all("low_markers" in r for r in rows)
    low = sum(r["low_markers"] for r in rows) if counted else "not counted"
    return (
        f"| {name} | {ghosts} | {hidden} | {sum(r['pieces'] for r in rows)} | {precision:.4f} "
        f"| {recall:.4f} | {f1:.4f} | {low} |"
    )


def _elsewhere(rows: Rows) -> str:
    lines = [
        f"| {r['set']} | {r['what']} | {r['points']} | {r['right']} | {r['wrong']} |" for r in rows
    ]
    return _table("| set | how | markers | right | wrong |", lines, "llrrr")


def _refusals(rows: Rows) -> str:
    lines = [f"| {r['what']} | {r['given']} of {r['of']} | {r['said'] or '–'} |" for r in rows]
    return "By the model of `02_05`, `85_02` and `135_02`.\n\n" + _table(
        "| given | labelled | reason said |", lines, "lrl"
    )


def _speed(rows: Rows) -> str:
    lines = [
        f"| {r['recording']} | {r['frames']} | {r['batch_frames_per_s']:,} | {r['live_median_ms']} "
        f"| {r['live_p99_ms']} | {r['live_right'] / r['live_samples']:.2%} | {r['live_wrong']} |"
        for r in rows
    ]
    return (
        "Batch: the whole recording by the model of the three other people, kernels compiled. "
        "Live: 41 markers and 9 ghosts a frame, after locking on to 5 s of labelled motion. One "
        "thread of a machine that others were using.\n\n"
        + _table(
            "| recording | frames | batch, frames/s | live, median ms | live, 99 % ms "
            "| live, right | wrong |",
            lines,
            "lrrrrrr",
        )
    )


def _static(rows: Rows) -> str:
    return (
        "A standing trial tells the distances of one person and nothing of how anybody moves: it "
        "labels that person, whatever they do, and nobody else.\n\n" + _elsewhere(rows)
    )


def _creatures(rows: Rows) -> str:
    return (
        "Of each there is one body: the model is of the first half of its recording, and what is "
        "labelled the second.\n\n" + _elsewhere(rows)
    )


def _two_people(rows: Rows) -> str:
    return (
        "`02_05` and `135_02` side by side, 82 markers. *Same person*: the model is of a later "
        "part of that person's own recording, so that it need only find them. *Another person*: it "
        "knows neither of the two and labels the one it fits best.\n\n" + _elsewhere(rows)
    )


def _live(rows: Rows) -> str:
    lines = [
        f"| {r['recording']} | {r['hidden']} | {r['lock_s']} | {r['median_ms']} "
        f"| {r['right'] / r['samples']:.2%} | {r['wrong']} |"
        for r in rows
    ]
    return (
        "Crowds of points in an order of their own each frame, 9 of them ghosts, without any "
        "label: the body is recognised after 5 s by the model of the three other people, then "
        "followed. *Recognition* is how long that took. Counted is from then on.\n\n"
        + _table(
            "| recording | hidden | recognition, s | median ms | right | wrong |", lines, "lrrrrr"
        )
    )


_SECTIONS: dict[str, tuple[str, Callable[[Rows], str]]] = {
    "pairs": ("The paper's table 1, rebuilt", _pairs),
    "windows-5s": ("Windows of 5 s, model of one other person", _windows),
    "windows-2s": ("Windows of 2 s, model of three other people", _windows),
    "missing": ("Markers that are not there", _missing),
    "reliability": ("How sure, how often right", _reliability),
    "broken": ("Ghosts, hidden markers, cut trajectories", _broken),
    "broken-fresh": ("The same, broken anew", _broken_anew),
    "halves": ("Other layouts, first half against second", _elsewhere),
    "functional": ("Functional trials, one by another", _elsewhere),
    "static": ("Movements by a standing trial", _static),
    "creatures": ("Bodies that are no people", _creatures),
    "two-people": ("Two people in one volume", _two_people),
    "refusals": ("What does not fit", _refusals),
    "speed": ("Speed", _speed),
    "live": ("Live, from the first frame", _live),
}
