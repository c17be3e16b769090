"""Recordings, models of other people, and how names are taken away."""

import os
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path

import numpy as np

from kinesphere import read
from kinesphere.data import Array, MarkerStatistics, Recording, TopologicalModel
from kinesphere.labelling import built_in_model, match_labels
from kinesphere.labelling.pair_statistics import match_pair_statistics
from kinesphere.skeleton.statistics import marker_statistics

ROOT = Path(__file__).parents[3]
CMU = ("06_01", "02_05", "85_02", "135_02")
"""Four recordings of four people: the number before the underscore is the person's."""


def folder() -> Path:
    """Return where the real recordings are."""
    return Path(os.environ.get("KINESPHERE_DATA", ROOT.parent / "shared" / "data"))


@cache
def cmu(name: str) -> Recording:
    """Return a 41-marker recording, its markers in the order of the model."""
    model = built_in_model("cmu41")
    recording = match_labels(read(folder() / "cmu41" / f"{name}.c3d"), model)
    return replace(
        recording,
        markers=recording.markers[:, recording.columns(model.labels)],
        labels=model.labels,
    )


@cache
def statistics(name: str) -> MarkerStatistics:
    """Return the statistics of one 41-marker recording."""
    return marker_statistics(cmu(name), built_in_model("cmu41").labels, name)


def model_of(names: Sequence[str]) -> TopologicalModel:
    """Return the layout with the statistics of these recordings and no others."""
    learnt = tuple(statistics(name) for name in names)
    return replace(built_in_model("cmu41"), statistics=learnt)


def others(name: str) -> tuple[str, ...]:
    """Return the recordings of other people."""
    return tuple(other for other in CMU if other.split("_")[0] != name.split("_")[0])


@dataclass(frozen=True)
class Score:
    """Labels against the truth."""

    points: int
    """That have a true label."""
    right: int
    wrong: int
    """Given another label than theirs, points that have none included."""

    @property
    def perfect(self) -> bool:
        """Every point labelled, none wrongly."""
        return self.right == self.points and self.wrong == 0


def shuffled(points: Array, rng: np.random.Generator) -> tuple[Array, np.ndarray]:
    """Return the columns in another order, and which one each was."""
    order = rng.permutation(points.shape[1])
    return points[:, order], order


def score_of(labels: np.ndarray, truth: np.ndarray) -> Score:
    """Return the score of labels (n_points,) against the truth, −1 meaning none in both."""
    given = labels >= 0
    right = int((given & (labels == truth)).sum())
    return Score(int((truth >= 0).sum()), right, int(given.sum()) - right)


def given_labels(points: Array, model: TopologicalModel, least: float = 0.1) -> np.ndarray:
    """Return the labels the default method gives, those it is too unsure of left out."""
    match = match_pair_statistics(points, model)
    return np.where(match.confidence >= least, match.labels, -1)
