"""The page of what the browser shows."""

from typing import Any

MOST_BUILD_S, MOST_OPEN_S, MOST_BYTES = 10.0, 3.0, 5e6


def page(results: dict[str, Any]) -> str:
    """Return the page as Markdown."""
    lines = [
        "# Report and viewer",
        "",
        "Written by `make bench` (`python -m benchmarks.browser`) into",
        f"`benchmarks/results/browser.json`. Chromium {results['chromium']} without a window and",
        "without a graphics card: software draws everything, on the cores that also serve it, in",
        f"1280 × 800 pixels. Python {results['python']}. Building is processor time, the rest is",
        "time on the wall, with whatever else the machine was doing.",
        "",
        "## Building the report",
        "",
        "| take | built in, s | size, MB | aim |",
        "|---|---:|---:|---|",
    ]
    for one in results["reports"]:
        minute = "minute" in one["take"]
        aim = f"under {MOST_BYTES / 1e6:.0f} MB" if minute else f"under {MOST_BUILD_S:.0f} s"
        lines.append(f"| {one['take']} | {one['built_s']:.2f} | {one['bytes'] / 1e6:.2f} | {aim} |")
    lines += [
        "",
        "## Opening and playing",
        "",
        "The viewer is *served* when `kinesphere view` has read the solved folder and said where",
        f"it is (aim: under {MOST_OPEN_S:.0f} s), *open* when the page has its controls. *Sent*",
        "are the poses that leave the server each second, at most 60; *drawn* is how often the",
        "page paints, which a graphics card does at the rate of the screen. *Alone* is what the",
        "server does with no page open, and what a pose costs it in processor time.",
        "",
        "| | take | served, s | open, s | sent, Hz | drawn, Hz | alone, Hz | pose, ms |",
        "|---|---|---:|---:|---:|---:|---:|---:|",
    ]
    for one in results["pages"]:
        cells = [
            f"{one[key] * scale:.{digits}f}" if key in one else "–"
            for key, scale, digits in (
                ("served_s", 1, 1), ("open_s", 1, 1), ("sent_hz", 1, 0), ("drawn_hz", 1, 0),
                ("alone_hz", 1, 0), ("frame_s", 1e3, 1),
            )
        ]  # fmt: skip
        lines.append(f"| {one['what']} | {one['take']} | {' | '.join(cells)} |")
    edits = results["edits"]
    lines += [
        "",
        f"An edit of all 24,000 frames is seen {1e3 * edits['seen_s']:.0f} ms after the slider",
        f"moved; the next 64 frames are worked out in {1e3 * edits['chunk_s']:.0f} ms.",
        "",
    ]
    return "\n".join(lines)
