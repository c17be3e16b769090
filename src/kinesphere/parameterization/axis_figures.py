"""What is told of each axis of a joint: lists with as many entries as the joint has axes."""

from collections.abc import Mapping, Sequence

import numpy as np

from kinesphere.data import Array, Json
from kinesphere.parameterization.anatomy import matches
from kinesphere.parameterization.confidence import AxesQuality
from kinesphere.parameterization.free_hinge import FreeHinge
from kinesphere.parameterization.joint_fit import or_null

PER_AXIS = ("ranges_deg", "conditioning", "halves_disagreement_deg", "alike_deg")
"""Findings that hold one figure for every axis, null where nothing tells it."""


def quality_findings(quality: AxesQuality | None) -> dict[str, Json]:
    """Return the figures of what speaks for and against axes; null for one that nothing tells."""
    if quality is None:
        return {}
    return {
        "ranges_deg": or_null(np.rad2deg(quality.ranges)),
        "conditioning": or_null(quality.conditioning),
        "explained": quality.explained,
        "halves_disagreement_deg": or_null(np.rad2deg(quality.halves)),
        "alike_deg": or_null(np.rad2deg(quality.alike)),
    }


def free_findings(free: FreeHinge) -> dict[str, Json]:
    """Return the figures of an axis from all movement; null for what only main movements have."""
    return {
        "ranges_deg": [float(np.rad2deg(free.moved))],
        "conditioning": [None],
        "halves_disagreement_deg": [None],
        "alike_deg": [float(np.rad2deg(np.hypot(free.reading, free.coupled)))],
    }


def nearest_places(found: Array, serving: Array) -> list[int]:
    """Return which of the axes that serve each found one is nearest to.

    Parameters
    ----------
    found : (n_found, 3)
        Unit vectors, at most as many as serve, any sign.
    serving : (n_axes, 3)
    """
    return [column for column, _ in sorted(matches(found @ serving.T), key=lambda pair: pair[1])]


def with_places(
    findings: Mapping[str, Json], places: Sequence[int], n_axes: int
) -> dict[str, Json]:
    """Return findings whose per-axis lists have an entry for each axis of the joint.

    Parameters
    ----------
    findings
        As `quality_findings` gives them; lists that are missing are all null.
    places
        Where each axis that they are about stands among the joint's axes.
    n_axes
    """
    listed: dict[str, Json] = {}
    for name in PER_AXIS:
        figures: list[Json] = [None] * n_axes
        for place, value in zip(places, listed_in(findings, name), strict=False):
            figures[place] = value
        listed[name] = figures
    return {**findings, **listed}


def listed_in(findings: Mapping[str, Json], name: str) -> list[Json]:
    """Return a list among findings; empty if there is none of that name."""
    value = findings.get(name)
    return list(value) if isinstance(value, list | tuple) else []
