"""Curves of the vendor's flexion and ours, as one SVG."""

from dataclasses import dataclass

import numpy as np

from kinesphere.data import Array

_WIDTH, _HEIGHT, _GAP = 230, 120, 34
_COLUMNS = 4
_STYLE = """
text { font: 11px system-ui, sans-serif; fill: #667085; } .name { fill: #344054; font-weight: 600; }
path { fill: none; } .rule { stroke: #98a2b3; stroke-opacity: 0.35; }
.vendor { stroke: #98a2b3; stroke-width: 4; stroke-opacity: 0.65; }
.offset { stroke: #3b5bdb; stroke-width: 1.3; } .aligned { stroke: #e8590c; stroke-width: 1.3; }
@media (prefers-color-scheme: dark) { .name { fill: #d0d5dd; } text { fill: #98a2b3; }
.offset { stroke: #8ea4ff; } .aligned { stroke: #ff9d5c; } }
"""


@dataclass(frozen=True, eq=False)
class Panel:
    """Flexion of one joint in one recording, (n,) deg each."""

    recording: str
    joint: str
    times: Array
    vendor: Array
    ours: Array
    """Without the constant offset."""
    aligned: Array
    """After a constant turn of both frames."""


def picture(panels: list[Panel]) -> str:
    """Return all panels, four in a row."""
    rows = -(-len(panels) // _COLUMNS)
    width, height = _COLUMNS * (_WIDTH + _GAP) + 10, rows * (_HEIGHT + _GAP + 14) + 34
    legend = (
        '<path class="vendor" d="M40 14h26"/><text x="72" y="18">vendor</text>'
        '<path class="offset" d="M140 14h26"/><text x="172" y="18">ours, constant offset taken out'
        '</text><path class="aligned" d="M364 14h26"/><text x="396" y="18">ours, limb frames '
        "aligned</text>"
    )
    drawn = [
        f'<g transform="translate({(i % _COLUMNS) * (_WIDTH + _GAP) + 36} '
        f'{(i // _COLUMNS) * (_HEIGHT + _GAP + 14) + 54})">{_panel(panel)}</g>'
        for i, panel in enumerate(panels)
    ]
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" role="img">'
        f"<title>Flexion over time, the vendor's and ours</title><style>{_STYLE}</style>"
        f"{legend}{''.join(drawn)}</svg>\n"
    )


def _panel(panel: Panel) -> str:
    series = [panel.vendor, panel.ours, panel.aligned]
    low, high = float(np.min(series)), float(np.max(series))
    y = lambda v: _HEIGHT * (high - v) / (high - low)  # noqa: E731
    x = _WIDTH * (panel.times - panel.times[0]) / (panel.times[-1] - panel.times[0])
    name = f"{panel.joint.replace('_', ' ')}, {panel.recording.split('_')[0]}"
    parts = [f'<text class="name" y="-8">{name}</text>']
    step = next(s for s in (5, 10, 20, 50) if (high - low) / s <= 5)
    for value in np.arange(np.ceil(low / step) * step, high, step):
        parts.append(
            f'<path class="rule" d="M0 {y(value):.1f}h{_WIDTH}"/>'
            f'<text x="-5" y="{y(value) + 4:.1f}" text-anchor="end">{value + 0.0:.0f}°</text>'
        )
    for css, values in zip(("vendor", "offset", "aligned"), series, strict=True):
        points = " ".join(f"{a:.1f} {b:.1f}" for a, b in zip(x, y(values), strict=True))
        parts.append(f'<path class="{css}" d="M{points}"/>')
    parts.append(
        f'<text x="{_WIDTH}" y="{_HEIGHT + 14}" text-anchor="end">'
        f"{panel.times[-1] - panel.times[0]:.1f} s</text>"
    )
    return "".join(parts)
