"""Curves over frames as a standalone SVG, a panel a joint."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from xml.sax.saxutils import escape

import numpy as np

from kinesphere.data import Array

_COLOURS = ("#d9480f", "#3b5bdb", "#868e96")
_DASHES = ("", "5 3", "2 3")
_WIDTH, _HEIGHT = 420, 190
_LEFT, _TOP, _RIGHT, _BOTTOM = 44, 30, 10, 24
_COLUMNS = 2
_LEGEND = 34


@dataclass(frozen=True, eq=False)
class Panel:
    """One plot: series of equal length, the most important first."""

    title: str
    series: Mapping[str, Array]


def curves_svg(panels: Sequence[Panel], x: str, y: str) -> str:
    """Return an SVG of panels in two columns, with one legend above; NaN leaves gaps."""
    rows = -(-len(panels) // _COLUMNS)
    width, height = _COLUMNS * _WIDTH, rows * _HEIGHT + _LEGEND
    out = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" '
        f'width="{width}" height="{height}" font-family="sans-serif" font-size="11">',
        f'<rect width="{width}" height="{height}" fill="#fff"/>',
    ]
    for k, name in enumerate(panels[0].series):
        at = _LEFT + 130 * k
        out.append(f'<path d="M{at} 16h26" {_pen(k)}/>')
        out.append(f'<text x="{at + 32}" y="20">{escape(name)}</text>')
    out.append(
        f'<text x="{width - _RIGHT}" y="20" text-anchor="end" fill="#666">{escape(y)} over '
        f"{escape(x)}</text>"
    )
    for i, panel in enumerate(panels):
        left, top = i % _COLUMNS * _WIDTH, i // _COLUMNS * _HEIGHT + _LEGEND
        out.append(f'<g transform="translate({left} {top})">{_panel(panel)}</g>')
    return "\n".join([*out, "</svg>", ""])


def _panel(panel: Panel) -> str:
    values = np.concatenate(list(panel.series.values()))
    low, high = np.floor(np.nanmin(values) / 10) * 10, np.ceil(np.nanmax(values) / 10) * 10
    high = max(high, low + 10)
    n = len(next(iter(panel.series.values())))
    across, down = _WIDTH - _LEFT - _RIGHT, _HEIGHT - _TOP - _BOTTOM

    def place(frame: float, value: float) -> tuple[float, float]:
        return (
            _LEFT + across * frame / max(n - 1, 1),
            _TOP + down * (high - value) / (high - low),
        )

    out = [f'<text x="{_LEFT}" y="18" font-weight="bold">{escape(panel.title)}</text>']
    for level in np.linspace(low, high, 3):
        _, row = place(0, level)
        out.append(f'<path d="M{_LEFT} {row:.1f}h{across}" stroke="#ddd"/>')
        out.append(
            f'<text x="{_LEFT - 5}" y="{row + 4:.1f}" text-anchor="end" fill="#666">'
            f"{level:.0f}</text>"
        )
    for frame in np.linspace(0, n - 1, 5):
        column, _ = place(frame, low)
        out.append(
            f'<text x="{column:.1f}" y="{_HEIGHT - 8}" text-anchor="middle" fill="#666">'
            f"{frame:.0f}</text>"
        )
    for k, series in reversed(list(enumerate(panel.series.values()))):
        pen, path = "M", []
        for frame, value in enumerate(series):
            if not np.isfinite(value):
                pen = "M"
                continue
            column, row = place(frame, value)
            path.append(f"{pen}{column:.1f} {row:.1f}")
            pen = "L"
        out.append(f'<path d="{"".join(path)}" {_pen(k)}/>')
    return "".join(out)


def _pen(k: int) -> str:
    dash = f' stroke-dasharray="{_DASHES[k]}"' if _DASHES[k] else ""
    return f'fill="none" stroke="{_COLOURS[k]}" stroke-width="1.6"{dash}'
