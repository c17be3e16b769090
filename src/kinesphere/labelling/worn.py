"""Which of the layouts that a model was learnt from is worn.

Laboratories share a layout and add markers of their own to it. A model of several recordings knows
the labels of all of them together; a person wears those of one, and the additions of another
laboratory are no places that markers could slide into.
"""

import numpy as np
from numpy.typing import NDArray

from kinesphere.data import TopologicalModel
from kinesphere.geometry.signature import Signature
from kinesphere.labelling.layout import Layout, layout_of
from kinesphere.labelling.problem import Labels, problem_of
from kinesphere.labelling.solving import FEW, scale_by_labels

DEARER = 60.0
"""Nats by which labels of one recording's layout alone may fit worse than those of all together:
additions beside a marker take it for 0 to 46, a body that wears two of them costs 205."""
FILLED = 0.8
"""Least share of a smaller layout's labels that must have points: a few are always missing."""


def smaller_layout(model: TopologicalModel, layout: Layout, n_points: int) -> Layout | None:
    """Return the smallest layout of one recording that these points fill nearly.

    None where the points fill the whole model nearly, or no layout of one recording.
    """
    if n_points >= FEW * layout.template.n:
        return None
    every = set(layout.template.labels)
    worn = {tuple(x for x in model.labels if x in every & {*s.labels}) for s in model.statistics}
    fitting = [x for x in worn if FILLED * len(x) <= n_points <= len(x) < layout.template.n]
    if not fitting:
        return None
    return layout_of(model, min(fitting, key=lambda labels: (len(labels), labels)))


def layout_held(model: TopologicalModel, layout: Layout, start: Labels) -> Layout:
    """Return the smaller layout if labels of points, (n_points,), nearly fill it and are all of it.

    Parameters
    ----------
    start : (n_points,)
        By index into the model's labels, −1 for none.
    """
    smaller = smaller_layout(model, layout, len(start))
    held = {model.labels[i] for i in start if i >= 0}
    if smaller is None or len(held) < FILLED * smaller.template.n:
        return layout
    return smaller if held <= set(smaller.template.labels) else layout


def is_worn(found: Signature, smaller: Labels, whole: Labels, layout: Layout) -> bool:
    """Tell whether labels of a smaller layout fit about as well as those of the whole one.

    Parameters
    ----------
    smaller, whole : (n_points,)
        Labels of all the points, both as the whole layout numbers them; −1 for none.
    """
    fits = []
    for labels in (smaller, whole):
        if (labels >= 0).sum() < 2:
            return False
        scale = scale_by_labels(found, labels, layout.template)
        fits.append(problem_of(found, scale, layout.template).energy(labels))
    return bool(fits[0] <= fits[1] + DEARER)


def numbered(labels: Labels, some: NDArray[np.intp], own: Layout, layout: Layout, n: int) -> Labels:
    """Return labels of some of n points as another layout numbers them."""
    at = {label: i for i, label in enumerate(layout.template.labels)}
    into = np.array([at[label] for label in own.template.labels], dtype=np.int64)
    every = np.full(n, -1, dtype=np.int64)
    every[some] = np.where(labels >= 0, into[labels], -1)
    return every
