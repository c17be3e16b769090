"""A layout ready to be searched for, and what a search found."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Array, TopologicalModel
from kinesphere.labelling.blocks import Moves, block_moves, twins
from kinesphere.labelling.problem import Labels, Problem
from kinesphere.labelling.search import nearest_labels
from kinesphere.labelling.template import Template, template_of


@dataclass(frozen=True)
class Layout:
    """A template and what the search needs beside it."""

    template: Template
    moves: Moves
    near: Labels
    twin: NDArray[np.int64]
    into: NDArray[np.int64]
    """(n_template_labels,) index into the model's labels."""


class Solved(NamedTuple):
    """A problem, and the labels of least energy."""

    problem: Problem
    labels: Labels
    energy: float
    margins: Array
    rivals: list[tuple[float, Labels]]
    """Energies and labels of other ends of the search."""
    converged: float = 1.0
    """0…1: how far starts ended in these labels, 1 from as many on as are looked for."""


def layout_of(model: TopologicalModel, labels: Sequence[str] | None = None) -> Layout:
    """Return what a model knows, of some labels if given; BadModel if it has no statistics."""
    template = template_of(model, labels)
    into = {label: i for i, label in enumerate(model.labels)}
    return Layout(
        template,
        block_moves(model, template.labels, template.mean),
        nearest_labels(template.mean),
        twins(model, template.labels),
        np.array([into[label] for label in template.labels], dtype=np.int64),
    )
