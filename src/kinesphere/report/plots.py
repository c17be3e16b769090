"""Plots as SVG whose coordinates are the data's own: a script can read values back from them."""

from dataclasses import dataclass

import numpy as np
from markupsafe import Markup

from kinesphere.data import Array

MOST_POINTS = 600
"""Points of a curve: more than a plot has pixels on most screens."""
MOST_DOTS = 400


@dataclass(frozen=True)
class Curve:
    """One line of a plot."""

    css: str
    values: Array
    """(n,); NaN leaves a gap."""


@dataclass(frozen=True)
class Tick:
    """A label on an axis, at a share of its length from left or top."""

    at: str
    text: str


@dataclass(frozen=True)
class Plot:
    """A drawing with the labels that stand beside it."""

    svg: Markup
    x: tuple[Tick, ...]
    y: tuple[Tick, ...]


def curves(times: Array, lines: list[Curve]) -> Plot:
    """Draw series over time, (n,) s; at most MOST_POINTS of each."""
    stride = -(-len(times) // MOST_POINTS)
    shown = slice(None, None, max(stride, 1))
    t = times[shown]
    x, y = _range(t, 0.0), _range(np.concatenate([line.values for line in lines]), 0.06)
    drawn = [_grid(x, y)]
    for line in lines:
        drawn += [
            f'<polyline class="{line.css}" points="{points}"/>'
            for points in _pieces(t, line.values[shown])
        ]
    return _plot(drawn, x, y)


def dots(mean: Array, difference: Array, levels: tuple[tuple[str, float], ...]) -> Plot:
    """Draw differences against means, (n,) each, with horizontal lines at ``(css, level)``."""
    known = np.flatnonzero(np.isfinite(mean) & np.isfinite(difference))
    known = known[:: max(1, -(-len(known) // MOST_DOTS))]
    finite = [level for _, level in levels if np.isfinite(level)]
    x = _range(mean[known], 0.06)
    y = _range(np.r_[difference[known], finite, 0.0], 0.08)
    drawn = [_grid(x, y)]
    drawn += [
        f'<path class="{css}" d="M{x[0]:.4g} {-level:.6g}H{x[1]:.6g}"/>'
        for css, level in levels
        if np.isfinite(level)
    ]
    path = "".join(
        f"M{a:.5g} {-b:.5g}h0" for a, b in zip(mean[known], difference[known], strict=True)
    )
    drawn.append(f'<path class="dots" d="{path}"/>')
    return _plot(drawn, x, y)


def _plot(drawn: list[str], x: tuple[float, float], y: tuple[float, float]) -> Plot:
    box = f"{x[0]:.6g} {-y[1]:.6g} {x[1] - x[0]:.6g} {y[1] - y[0]:.6g}"
    svg = (
        f'<svg viewBox="{box}" preserveAspectRatio="none" aria-hidden="true">{"".join(drawn)}</svg>'
    )
    return Plot(
        Markup(svg),
        tuple(Tick(f"{100 * (v - x[0]) / (x[1] - x[0]):.2f}%", _text(v, x)) for v in _steps(x, 6)),
        tuple(Tick(f"{100 * (y[1] - v) / (y[1] - y[0]):.2f}%", _text(v, y)) for v in _steps(y, 4)),
    )


def _grid(x: tuple[float, float], y: tuple[float, float]) -> str:
    return "".join(
        f'<path class="{"zero" if abs(v) < 1e-9 else "rule"}" d="M{x[0]:.6g} {-v:.6g}H{x[1]:.6g}"/>'
        for v in _steps(y, 4)
    )


def _pieces(t: Array, values: Array) -> list[str]:
    """Return the points of each unbroken stretch; a lone point becomes a short line."""
    known = np.isfinite(values)
    edges = np.flatnonzero(np.diff(np.r_[False, known, False].astype(int))).reshape(-1, 2)
    found = []
    for start, end in edges:
        points = [f"{a:.3f},{-b:.2f}" for a, b in zip(t[start:end], values[start:end], strict=True)]
        found.append(" ".join(points if len(points) > 1 else points * 2))
    return found


def _range(values: Array, margin: float) -> tuple[float, float]:
    known = values[np.isfinite(values)]
    low, high = (float(known.min()), float(known.max())) if len(known) else (0.0, 1.0)
    least = 1e-3 if margin == 0 else 1.0  # a degree: below it a plot of noise would look like much
    if high - low < least:
        middle = (low + high) / 2
        low, high = middle - least / 2, middle + least / 2
    more = margin * (high - low)
    return low - more, high + more


def _steps(span: tuple[float, float], most: int) -> list[float]:
    """Return round numbers inside a range, not more than ``most``."""
    length = span[1] - span[0]
    power = 10 ** np.floor(np.log10(length / most))
    step = next((power * k for k in (1, 2, 5, 10) if length / (power * k) <= most), power * 10)
    first = int(np.ceil(span[0] / step - 1e-9))
    last = int(np.floor(span[1] / step + 1e-9))
    return [float(k * step) for k in range(first, last + 1)]


def _text(value: float, span: tuple[float, float]) -> str:
    decimals = max(0, int(np.ceil(-np.log10((span[1] - span[0]) / 8))))
    return f"{value + 0.0:.{decimals}f}".replace("-", "−")
