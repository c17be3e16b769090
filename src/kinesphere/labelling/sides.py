"""Two sides of one person: a hand whose distances are not the other hand's is labelled wrongly.

Within a segment the distances of one side are those of the other to 6 mm in the median, where the
layout is symmetric: much nearer than those of other people.
"""

import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Array, TopologicalModel
from kinesphere.geometry.pair_distances import pair_distances
from kinesphere.geometry.signature import FRAMES, evenly_spread
from kinesphere.labelling.blocks import twins
from kinesphere.labelling.problem import Labels
from kinesphere.labelling.template import of_one_segment, template_of

OTHER_SIDE = 0.02
"""m, by which a distance within a segment differs from that of the other side: 10 to 12 mm and
less in three of four, 60 in a few."""
SYMMETRIC = 0.1
"""Share by which the two sides of other people differ where the layout is not symmetric."""
MATES = 1
"""Distances within the segment that tell two markers from each other, at least."""
BETTER = 4.0
"""Mean squares of deviations by which two exchanged labels must fit the other side better."""


def symmetric_pairs(mean: Array, kin: NDArray[np.bool_], twin: Labels) -> NDArray[np.bool_]:
    """Return which distances of a layout the other side tells, (n, n).

    Parameters
    ----------
    mean : (n, n) m
        Of other people, NaN where nothing is known.
    kin : (n, n)
        Labels of one segment.
    twin : (n,)
        The label of the other side; unpaired ones are their own.
    """
    both = (mean > 0) & (mean[np.ix_(twin, twin)] > 0)
    ratio = np.divide(mean, mean[np.ix_(twin, twin)], out=np.ones_like(mean), where=both)
    paired = twin != np.arange(len(twin))
    alike = (np.abs(np.log(ratio)) < SYMMETRIC) | (
        np.abs(mean - mean[np.ix_(twin, twin)]) < OTHER_SIDE
    )
    told = kin & both & alike & (paired[:, None] | paired)
    np.fill_diagonal(told, False)
    return np.asarray(told)


def denied_by_other_side(
    mean: Array, told: NDArray[np.bool_], kin: NDArray[np.bool_], twin: Labels
) -> NDArray[np.bool_]:
    """Return which labels would better be exchanged with another of their segment, (n,).

    Parameters
    ----------
    mean : (n, n) m
        Mean distances of the person's labels, NaN where not known.
    told : (n, n)
        As ``symmetric_pairs`` returns them.
    """
    n = len(mean)
    other = mean[np.ix_(twin, twin)]
    denied = np.zeros(n, dtype=bool)
    for i in range(n):
        for j in np.flatnonzero(kin[i] & (np.arange(n) > i) & (twin[i] != np.arange(n))):
            mates = told[i] & told[j]
            mates[np.array([i, j, twin[i], twin[j]])] = False
            wanted = np.stack([other[i, mates], other[j, mates]])
            here = np.stack([mean[i, mates], mean[j, mates]])
            known = np.isfinite(wanted + here).all(axis=0)
            if known.sum() < MATES:
                continue
            off = [((x - wanted)[:, known] / OTHER_SIDE) ** 2 for x in (here, here[::-1])]
            if off[0].mean() > off[1].mean() + BETTER:
                denied[i] = denied[j] = True
    return denied


def one_sided(points: Array, labels: Labels, model: TopologicalModel) -> NDArray[np.bool_]:
    """Return which points bear labels that the person's other side denies, (n_points,).

    Parameters
    ----------
    points : (n_frames, n_points, 3) m
        NaN where not seen.
    labels : (n_points,)
        Index into the model's, −1 for none; none twice.
    """
    given = np.flatnonzero(labels >= 0)
    mean = np.full((len(model.labels), len(model.labels)), np.nan)
    mean[np.ix_(labels[given], labels[given])] = pair_distances(
        points[evenly_spread(len(points), FRAMES)][:, given]
    ).mean
    template = template_of(model)
    into = [model.labels.index(label) for label in template.labels]
    kin, twin = of_one_segment(model, template.labels), twins(model, template.labels)
    told = symmetric_pairs(template.size * template.mean, kin, twin)
    denied = np.zeros(len(model.labels) + 1, dtype=bool)
    denied[into] = denied_by_other_side(mean[np.ix_(into, into)], told, kin, twin)
    return denied[labels]
