"""Analog channels between the numbers of the file and their units."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Analog, Array
from kinesphere.io.c3d.frames import as_doubles
from kinesphere.io.c3d.layout import Layout
from kinesphere.io.c3d.parameters import Section

_SAME_RATE = 1e-3
"""Relative difference below which two rates are one."""


def analog_from_samples(
    layout: Layout, samples: NDArray[Any], warnings: list[str]
) -> Analog | None:
    """Return the channels in their units: ``(raw − OFFSET) · SCALE · GEN_SCALE``.

    Parameters
    ----------
    layout
        Of the file.
    samples : (n_samples, n_channels)
        As stored.
    warnings
        What is doubtful is added here.
    """
    n = layout.n_channels
    if n == 0:
        return None
    section = layout.section
    raw = raw_samples(layout, samples)
    offset, scale = calibration(section, n)
    with np.errstate(invalid="ignore", over="ignore"):
        values = (raw - offset) * scale
    if not np.isfinite(values).all():
        bad = ~np.isfinite(values)
        values[bad] = np.nan
        warnings.append(f"{bad.sum()} analog samples are not finite numbers; taken as missing")
    rate = layout.rate * layout.samples_per_frame
    said = section.number("ANALOG", "RATE")
    if said is not None and abs(said - rate) > _SAME_RATE * rate:
        warnings.append(
            f"ANALOG:RATE is {said:g} Hz, but there are {layout.samples_per_frame} samples a frame "
            f"at {layout.rate:g} Hz; {rate:g} Hz is taken"
        )
    labels = section.texts("ANALOG", "LABELS")[:n]
    units = section.texts("ANALOG", "UNITS")[:n]
    return Analog(
        values,
        (*labels, *(f"channel {i + 1}" for i in range(len(labels), n))),
        (*units, *("" for _ in range(len(units), n))),
        rate,
    )


def raw_samples(layout: Layout, samples: NDArray[Any]) -> Array:
    """Return the converter's numbers, (n_samples, n_channels): words may be meant unsigned."""
    raw = as_doubles(samples)
    if _is_unsigned(layout.section) and not layout.is_float:
        raw = np.where(raw < 0, raw + 65536, raw)
    return raw


def samples_from_analog(analog: Analog, section: Section) -> Array:
    """Return what to store, (n_samples, n_channels); the reverse of ``analog_from_samples``.

    A missing sample is stored as the channel's zero: the format has no other word for it.
    """
    offset, scale = calibration(section, len(analog.labels))
    divisor = np.where(scale == 0, 1.0, scale)
    return np.asarray(np.nan_to_num(analog.values) / divisor + offset)


def calibration(section: Section, n_channels: int) -> tuple[Array, Array]:
    """Return (offset, scale) of each channel, (n_channels,), the general scale included."""
    general = section.number("ANALOG", "GEN_SCALE")
    offset = section.numbers("ANALOG", "OFFSET")[:n_channels]
    if _is_unsigned(section):
        offset = np.where(offset < 0, offset + 65536, offset)
    scale = section.numbers("ANALOG", "SCALE")[:n_channels]
    offset = np.concatenate([offset, np.zeros(n_channels - len(offset))])
    scale = np.concatenate([scale, np.ones(n_channels - len(scale))])
    return offset, scale * (1.0 if general is None else general)


def _is_unsigned(section: Section) -> bool:
    return section.text("ANALOG", "FORMAT").upper() == "UNSIGNED"
