"""Units of length: how files spell them, what is guessed where they name none."""

import numpy as np
import pytest

from kinesphere.io.units import guess_unit, length_unit, metres_from_unit


def moving(rng, extent):
    """Markers that span about ``extent`` along their widest axis, (201, 4, 3), some not seen."""
    points = rng.normal(scale=0.01 * extent, size=(201, 4, 3))
    points[..., 1] += np.linspace(0, extent / 0.9, 201)[:, None]  # the outer tenth is left out
    points[5:9, 2] = np.nan
    return points


@pytest.mark.parametrize(
    ("spelling", "metres"),
    [
        *(("mm", 1e-3), ("MM.", 1e-3), (" Millimeters \0", 1e-3), ("cm", 1e-2), ("m", 1.0)),
        *(("Metres", 1.0), ("in", 0.0254), ("ft", 0.3048), ("µm", 1e-6)),
        *(("", None), ("furlong", None)),
    ],
)
def test_spellings(spelling, metres):
    assert metres_from_unit(spelling) == metres


@pytest.mark.parametrize(("extent", "unit"), [(0.3, "m"), (15.0, "m"), (30.0, "mm"), (4e3, "mm")])
def test_whichever_unit_lets_the_markers_span_a_room_is_guessed(rng, extent, unit):
    points = moving(rng, extent)
    assert guess_unit(points) == unit
    found, metres, (warning,) = length_unit("", points)
    assert (found, metres) == (unit, metres_from_unit(unit))
    assert "names no unit" in warning


def test_markers_never_seen_are_millimetres(rng):
    assert guess_unit(np.full((7, 4, 3), np.nan)) == "mm"


@pytest.mark.parametrize(
    ("extent", "doubtful"), [(2.0, True), (20.0, False), (1e5, False), (4e5, True), (0.0, False)]
)
def test_a_unit_that_makes_people_ants_or_giants_is_doubted_but_kept(rng, extent, doubtful):
    unit, metres, warnings = length_unit("mm", moving(rng, extent))
    assert (unit, metres) == ("mm", 1e-3)
    assert [("but then the markers span" in said) for said in warnings] == [True] * doubtful
