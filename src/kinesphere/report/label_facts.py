"""What is known about every label of a labelled recording: the same for page and table."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from kinesphere.data import Json, Recording
from kinesphere.labelling.findings import said_of

_TRUST = {"sure": "good", "likely": "fair", "look": "poor"}


@dataclass(frozen=True)
class LabelFact:
    """One label of the model, and what came of it."""

    name: str
    marker: str
    """What it is called in the recording; empty where no marker bears it."""
    column: int
    """−1 where no marker bears it."""
    said: str
    trust: str
    """``good``, ``fair``, ``poor``; ``none`` where nobody looked, empty where it was not given."""
    confidence: float
    """NaN where nobody looked or it was not given."""
    labelled_s: float
    look_s: tuple[tuple[float, float], ...]
    """Start and end of what a person should look at."""

    @property
    def rank(self) -> tuple[float, str]:
        """What a person should see first comes first."""
        if self.trust == "":
            return (-1.0, self.name)
        if self.trust == "none":
            return (0.0 if self.said == "not judged" else 2.0, self.name)
        return (self.confidence - (self.trust == "poor"), self.name)


def is_check(recording: Recording) -> bool:
    """Tell whether the recording's own labels were checked, and none given."""
    return "checked" in recording.history[-1].findings


def label_facts(recording: Recording) -> list[LabelFact]:
    """Return what is known about every label, what a person should look at first.

    Parameters
    ----------
    recording
        As ``kinesphere.label`` returns it: its last step says what was found.
    """
    table = recording.history[-1].findings.get("labels")
    if not isinstance(table, dict):
        return []
    found = [
        _fact(recording, name, row, check=is_check(recording))
        for name, row in table.items()
        if isinstance(row, dict)
    ]
    return sorted(found, key=lambda fact: fact.rank)


def _fact(recording: Recording, name: str, row: dict[str, Json], *, check: bool) -> LabelFact:
    marker = str(row.get("marker", name))
    column = recording.labels.index(marker) if marker in recording.labels else -1
    if column < 0 or not recording.seen[:, column].any():
        return LabelFact(name, "", -1, "not given", "", np.nan, 0.0, ())
    sure = np.nan if recording.confidence is None else float(recording.confidence[column])
    trust, other = "none", row.get("moves_like")
    if other:
        said, trust = f"moves like {other}", "poor"
    elif check and np.isnan(sure):
        said = "not judged"
    elif row.get("kept") or np.isnan(sure):
        said, sure = "kept", np.nan
    else:
        said = said_of(sure)
        trust = _TRUST[said]
    seconds = float(recording.seen[:, column].sum() / recording.rate)
    spans = row.get("look_s")
    look = tuple(_span(span) for span in spans) if isinstance(spans, list) else ()
    return LabelFact(name, marker, column, said, trust, sure, seconds, look)


def _span(span: Json) -> tuple[float, float]:
    if not isinstance(span, Sequence) or isinstance(span, str):
        return (np.nan, np.nan)
    start, end = (float(value) for value in span if isinstance(value, int | float))
    return (start, end)
