"""How well parameters rebuild a joint's poses, in the paper's measures and in plainer ones."""

from collections.abc import Callable

import numpy as np

from kinesphere.data import Array, Json
from kinesphere.geometry.rotations import carried
from kinesphere.geometry.vectors import lengths


def lever(centre_in_child: Array, length: float, long_axis: Array) -> Array:
    """Return the vector from the joint to the limb's mid point, in the limb, (3,) m.

    The origin of a normalized limb frame is the mid point; half the length along the limb where
    the frame's origin is the joint itself; NaN where no length is known either.
    """
    if np.linalg.norm(centre_in_child) > 1e-3:
        return -centre_in_child
    return 0.5 * length * long_axis


def mid_point_residuals(measured: Array, rebuilt: Array, mid_point: Array) -> Array:
    """Return the distance between the mid point of measured and rebuilt poses, (n,) m."""
    return lengths(carried(measured - rebuilt, mid_point))


def paper_measures(
    measured: Array, rebuilt: Array, long_axis: Array, mid_point: Array
) -> dict[str, Json]:
    """Return position and twist deviation as the paper's section 5 reports them.

    "We summed the angular deviations of the three axis-pairs … per axis" may mean the sum or its
    third: both are given, and the geodesic angle. None of them measures the axes: two axes and a
    twist rebuild almost any pose, right or wrong.
    """
    reach = float(np.linalg.norm(mid_point))
    apart = measured - rebuilt
    position = lengths(carried(apart, long_axis)) * reach * 1e3
    # chords of the axis pairs: precise for small angles, where cosines are not
    chords = np.einsum("nij,nij->nj", apart, apart)
    summed = np.rad2deg(2 * np.arcsin(np.minimum(np.sqrt(chords) / 2, 1)) @ np.ones(3))
    geodesic = np.rad2deg(2 * np.arcsin(np.minimum(np.sqrt(chords @ np.ones(3) / 8), 1)))
    return {
        "position_deviation_mean_mm": number(position, np.mean),
        "position_deviation_median_mm": number(position, np.median),
        "twist_deviation_sum_mean_deg": number(summed, np.mean),
        "twist_deviation_sum_median_deg": number(summed, np.median),
        "twist_deviation_per_axis_mean_deg": number(summed / 3, np.mean),
        "geodesic_mean_deg": number(geodesic, np.mean),
    }


def number(values: Array, of: Callable[[Array], float]) -> float | None:
    """Return a statistic as JSON has it: None where nothing is known."""
    known = values[np.isfinite(values)]
    return float(of(known)) if len(known) else None
