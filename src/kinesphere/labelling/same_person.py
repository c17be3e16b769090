"""The person a model was learnt from, recorded again: their distances, to the millimetre.

Within a segment a person's distances come back as they were, whatever the segments do; between
segments one recording tells next to nothing: a trial that moves one joint makes all others look
rigid, a static trial all of them. So this template holds the first tightly and the second loosely,
and its labels count only where the distances prove to be that person's. A static trial suffices to
learn from, and to be labelled.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Array, MarkerStatistics, TopologicalModel
from kinesphere.labelling.template import Template, of_one_segment

SKIN = 0.01
"""m, spread of a mean distance within a segment from trial to trial: medians of 1 to 6 mm, 95 % of
them below 15 mm, on three people."""
RIGID = 0.01
"""m, deviation over time from which on two markers are not of one rigid segment."""
POSE_SHARE = 0.25
"""Spread of a mean distance between segments, as a share of it, from pose to pose..."""
POSE_FLOOR = 0.06
"""m, ...and at least."""
ALIKE = 0.015
"""m, difference up to which a distance is the person's own. Those of other people differ by 16 to
34 mm in the median."""
PROVED = 0.75
"""Share of the distances within segments that must be."""
LEAST_PAIRS = 6
"""Distances within segments that can prove anything."""
MIRRORED = 0.75
"""Share of the mean difference of distances below which labels with left and right exchanged prove
that the person is mirrored: at most 0.5 in mirrored trials of three people, 2 and more in the
trials as they are."""
MIRROR_IMAGE = (
    "the markers have the distances of the person of model {}, but left and right are mirrored: "
    "the axes of the recording, or those of what the model was learnt from, are left-handed"
)
"""What is said then."""


def rigid_pairs(
    model: TopologicalModel, labels: tuple[str, ...], statistics: Sequence[MarkerStatistics]
) -> NDArray[np.bool_]:
    """Return which two labels keep their distance, (n, n): of one segment, and seen to be rigid.

    All false if the recordings show several people, or no segment has enough markers to tell.
    """
    n = len(labels)
    mean, deviation = np.full((2, len(statistics), n, n), np.nan)
    for k, one in enumerate(statistics):
        at = {label: i for i, label in enumerate(one.labels)}
        here = [i for i, label in enumerate(labels) if label in at]
        there = [at[labels[i]] for i in here]
        mean[k][np.ix_(here, here)] = one.mean[np.ix_(there, there)]
        deviation[k][np.ix_(here, here)] = one.deviation[np.ix_(there, there)]
    low, high = np.fmin.reduce(mean, axis=0), np.fmax.reduce(mean, axis=0)
    rigid = of_one_segment(model, labels) & (np.fmax.reduce(deviation, axis=0) < RIGID)
    np.fill_diagonal(rigid, False)
    alike = (high - low)[rigid] <= ALIKE
    if rigid.sum() < 2 * LEAST_PAIRS or alike.mean() < PROVED:
        return np.zeros((n, n), dtype=bool)
    return np.asarray(rigid & (high - low <= ALIKE))


def template_of_person(template: Template, rigid: NDArray[np.bool_]) -> Template:
    """Return the template for further recordings of the person it was learnt from.

    Parameters
    ----------
    rigid : (n, n)
        As ``rigid_pairs`` returns them.
    """
    pose = (POSE_SHARE * template.mean) ** 2 + (POSE_FLOOR / template.size) ** 2
    return replace(
        template,
        variance=np.where(rigid, (SKIN / template.size) ** 2, pose),
        # how much the segments move against each other is of the trial, not of the person
        log_variance=np.where(rigid, template.log_variance, np.inf),
    )


def is_the_person(
    mean: Array, labels: NDArray[np.int64], template: Template, rigid: NDArray[np.bool_]
) -> bool:
    """Tell whether labelled points have the distances of the person.

    Parameters
    ----------
    mean : (n_points, n_points) m
        Mean distances.
    labels : (n_points,)
        −1 for none.
    """
    off = _differences(mean, labels, template, rigid)
    possible = np.triu(rigid, 1).sum()
    return len(off) >= max(LEAST_PAIRS, possible / 4) and float((off <= ALIKE).mean()) >= PROVED


def is_mirrored(
    mean: Array,
    labels: NDArray[np.int64],
    twin: NDArray[np.int64],
    template: Template,
    rigid: NDArray[np.bool_],
) -> bool:
    """Tell whether labels are those of the person in a mirror: nobody is quite symmetric.

    A search that is told left from right exchanges them in mirrored points; distances, which no
    mirror changes, then fit the other side's.

    Parameters
    ----------
    mean : (n_points, n_points) m
        Mean distances.
    labels : (n_points,)
        As they agree with the person's handedness, −1 for none.
    twin : (n_labels,)
        The label of the other side; unpaired ones are their own.
    """
    exchanged = np.where(labels >= 0, twin[labels], -1)
    if not is_the_person(mean, exchanged, template, rigid):
        return False
    off = _differences(mean, labels, template, rigid)
    return float(_differences(mean, exchanged, template, rigid).mean()) < MIRRORED * float(
        off.mean() if len(off) else np.inf
    )


def _differences(
    mean: Array, labels: NDArray[np.int64], template: Template, rigid: NDArray[np.bool_]
) -> Array:
    """Return by how much the known distances within segments are off, (n_known,) m."""
    given = np.flatnonzero(labels >= 0)
    rows, columns = np.triu_indices(len(given), 1)
    i, j = labels[given[rows]], labels[given[columns]]
    seen = mean[given[rows], given[columns]]
    known = rigid[i, j] & np.isfinite(seen)
    return np.asarray(np.abs(seen[known] - template.size * template.mean[i, j][known]))
