"""Findings as a person reads them: what many markers have alike is one line."""

from collections.abc import Sequence

from kinesphere.quality.findings import Finding

GATHERED = "gap"
"""Rule whose findings are gathered: reconstructions in pieces have one for nearly every marker."""


def gathered(findings: Sequence[Finding]) -> tuple[Finding, ...]:
    """Return the findings with gaps of one severity as one, in the place of the first.

    Markers and figures of each stay with the findings given.
    """
    told: list[Finding] = []
    done: set[str] = set()
    for finding in findings:
        alike = [f for f in findings if f.rule == GATHERED and f.severity == finding.severity]
        if finding.rule != GATHERED or len(alike) == 1:
            told.append(finding)
        elif finding.severity not in done:
            done.add(finding.severity)
            told.append(_one(alike))
    return tuple(told)


def _one(alike: Sequence[Finding]) -> Finding:
    shares = {f.markers[0]: dict(f.numbers)["missing_share"] for f in alike}
    longest = {f.markers[0]: dict(f.numbers)["longest_s"] for f in alike}
    most, last = max(shares, key=lambda m: shares[m]), max(longest, key=lambda m: longest[m])
    low, high = f"{min(shares.values()):.1%}", f"{max(shares.values()):.1%}"
    share = high if low == high else f"{low} to {high}"
    return Finding(
        GATHERED,
        alike[0].severity,
        f"{len(alike)} markers are missing in {share} of the frames, most {most}; the longest gap "
        f"is {last}'s, {longest[last]:.2f} s",
        "fill them where the trial is reconstructed; meanwhile the limbs' other markers must do",
        markers=tuple(shares),
        numbers=(("markers", len(alike)),),
    )
