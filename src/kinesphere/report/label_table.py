"""``NAME.labels.csv``: every label, how sure it is, and where to look, as a table."""

import csv
import io
from pathlib import Path

import numpy as np

from kinesphere.data import Recording
from kinesphere.io import replacing
from kinesphere.report.label_facts import LabelFact, label_facts

_NAMES = ("label", "marker", "said", "confidence", "labelled_s", "look_at_s")


def write_label_table(recording: Recording, path: str | Path) -> None:
    """Write one row a label, those to look at first.

    Parameters
    ----------
    recording
        As ``kinesphere.label`` returns it.

    Raises
    ------
    UnwritableFile
        If the place cannot be written to.
    """
    text = io.StringIO()
    table = csv.writer(text, lineterminator="\n")
    table.writerow(_NAMES)
    table.writerows(_row(fact) for fact in label_facts(recording))
    with replacing(path) as temporary:
        temporary.write_text(text.getvalue(), encoding="utf-8", newline="\n")


def _row(fact: LabelFact) -> tuple[str, ...]:
    return (
        fact.name,
        fact.marker,
        fact.said,
        "" if np.isnan(fact.confidence) else f"{fact.confidence:.3f}",
        f"{fact.labelled_s:.3f}",
        "; ".join(f"{start:.3f} to {end:.3f}" for start, end in fact.look_s),
    )
