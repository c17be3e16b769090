"""The page of what the browser shows."""

from typing import Any

COLUMNS = (
    ("served, s", "served_s", 1, 1),
    ("processor, s", "served_cpu_s", 1, 1),
    ("open, s", "open_s", 1, 1),
    ("sent, Hz", "sent_hz", 1, 0),
    ("drawn, Hz", "drawn_hz", 1, 0),
    ("without body, Hz", "plain_hz", 1, 0),
    ("alone, Hz", "alone_hz", 1, 0),
    ("pose, ms", "frame_s", 1e3, 1),
)
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
        f"time on the wall; the load average was {results['load']:.1f} on {results['cores']}",
        "cores.",
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
        f"it is (aim: under {MOST_OPEN_S:.0f} s); *processor* is what that took of a core. It is",
        "*open* when the page has its controls. *Sent* are the poses that leave the server each",
        "second, at most 60; *drawn* is how often the page paints, with the body and without: here",
        "by software, elsewhere a graphics card does. *Alone* is what the server does with no page",
        "open, and *pose* what one costs it in processor time.",
        "",
        f"| | take | {' | '.join(name for name, *_ in COLUMNS)} |",
        f"|---|---|{'---:|' * len(COLUMNS)}",
    ]
    for one in results["pages"]:
        cells = [
            f"{one[key] * scale:.{digits}f}" if key in one else "–"
            for _, key, scale, digits in COLUMNS
        ]
        lines.append(f"| {one['what']} | {one['take']} | {' | '.join(cells)} |")
    edits = results["edits"]
    lines += [
        "",
        f"An edit of all 24,000 frames is seen {1e3 * edits['seen_s']:.0f} ms after the slider",
        f"moved; the next 64 frames are worked out in {1e3 * edits['chunk_s']:.0f} ms.",
        "",
    ]
    return "\n".join(lines)
