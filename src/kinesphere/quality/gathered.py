"""Findings as a person reads them: what many markers have alike is one line."""

from collections.abc import Callable, Mapping, Sequence

from kinesphere.quality.at_zero import AT_ZERO
from kinesphere.quality.findings import Finding
from kinesphere.quality.marker_checks import COINCIDENT, JUMP

LISTED = 5
"""Pairs of markers that are named in one line."""
FEW_JUMPS = 5
"""Markers that jump, each of which has a line of its own."""


def gathered(findings: Sequence[Finding]) -> tuple[Finding, ...]:
    """Return the findings; gaps, zeros and copies of one severity are one, in place of the first.

    So are jumps of more than five markers. What each marker did stays with the findings given.
    """
    told: list[Finding] = []
    done: set[tuple[str, str]] = set()
    for finding in findings:
        kind = (finding.rule, finding.severity)
        alike = [f for f in findings if (f.rule, f.severity) == kind]
        few = FEW_JUMPS if finding.rule == JUMP else 1
        if finding.rule not in GATHERED or len(alike) <= few:
            told.append(finding)
        elif kind not in done:
            done.add(kind)
            told.append(GATHERED[finding.rule](alike))
    return tuple(told)


def _gaps(alike: Sequence[Finding]) -> Finding:
    shares = {f.markers[0]: dict(f.numbers)["missing_share"] for f in alike}
    longest = {f.markers[0]: dict(f.numbers)["longest_s"] for f in alike}
    most, last = max(shares, key=lambda m: shares[m]), max(longest, key=lambda m: longest[m])
    return Finding(
        "gap",
        alike[0].severity,
        f"{len(alike)} markers are missing in {_from_to(shares)} of the frames, most {most}; the "
        f"longest gap is {last}'s, {longest[last]:.2f} s",
        "fill them where the trial is reconstructed; meanwhile the limbs' other markers must do",
        markers=tuple(shares),
        numbers=(("markers", len(alike)),),
    )


def _zeros(alike: Sequence[Finding]) -> Finding:
    shares = {f.markers[0]: dict(f.numbers)["zero_share"] for f in alike}
    samples = int(sum(dict(f.numbers)["frames"] for f in alike))
    frames = [f.frame for f in alike if f.frame is not None]
    most = max(alike, key=lambda f: dict(f.numbers)["frames"])
    return Finding(
        AT_ZERO,
        alike[0].severity,
        f"{len(alike)} markers are exactly at the origin in {_from_to(shares)} of the frames, "
        f"{samples:,} positions from frame {min(frames)} on, most {most.markers[0]}: likely "
        "missing, written as zero",
        alike[0].remedy,
        markers=tuple(shares),
        frame=min(frames),
        numbers=(("markers", len(alike)), ("positions", samples)),
    )


def _copies(alike: Sequence[Finding]) -> Finding:
    frames = [f.frame for f in alike if f.frame is not None]
    pairs = [" and ".join(f.markers) for f in alike]
    listed = ", ".join(pairs if len(pairs) <= LISTED else [*pairs[:LISTED], "…"])
    return Finding(
        COINCIDENT,
        alike[0].severity,
        f"{len(alike)} pairs of markers are at the same place: {listed}",
        "one of each is a copy: leave it out",
        markers=tuple(dict.fromkeys(marker for f in alike for marker in f.markers)),
        frame=min(frames),
        numbers=(("pairs", len(alike)),),
    )


def _jumps(alike: Sequence[Finding]) -> Finding:
    times = {f.markers[0]: int(dict(f.numbers)["jumps"]) for f in alike}
    speeds = {f.markers[0]: dict(f.numbers)["fastest_m_per_s"] for f in alike}
    frames = [f.frame for f in alike if f.frame is not None]
    most, fastest = max(times, key=lambda m: times[m]), max(speeds, key=lambda m: speeds[m])
    return Finding(
        JUMP,
        alike[0].severity,
        f"{len(alike)} markers jump {sum(times.values()):,} times, first into frame "
        f"{min(frames)}, most {most} ({times[most]}); the fastest is {fastest}, with "
        f"{speeds[fastest]:.0f} m/s",
        alike[0].remedy,
        markers=tuple(times),
        frame=min(frames),
        numbers=(("markers", len(alike)), ("jumps", sum(times.values()))),
    )


def _from_to(shares: Mapping[str, float]) -> str:
    low, high = f"{min(shares.values()):.1%}", f"{max(shares.values()):.1%}"
    return high if low == high else f"{low} to {high}"


GATHERED: Mapping[str, Callable[[Sequence[Finding]], Finding]] = {
    "gap": _gaps,
    AT_ZERO: _zeros,
    COINCIDENT: _copies,
    JUMP: _jumps,
}
"""Rules that are gathered: reconstructions in pieces, exports without a sign for what is missing
files that hold everything twice and those full of bad samples have one finding for nearly every
marker."""
