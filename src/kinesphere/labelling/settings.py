"""What a person may choose about labelling."""

from dataclasses import dataclass

from kinesphere.data import check_settings, setting

METHODS = ("pair-statistics", "huang-xia", "similarity-tree")


@dataclass(frozen=True)
class LabellingSettings:
    """How points without labels get them."""

    method: str = setting(
        "pair-statistics",
        "How markers are recognised.",
        choices=METHODS,
        source="measured best; Huang & Xia 2010; Li, Meng & Holstein 2005",
    )
    existing: str = setting(
        "keep",
        "Labels that are there already: keep them and label the rest, check them against what "
        "would be given, or ignore them.",
        choices=("keep", "check", "ignore"),
    )
    tracks: str = setting(
        "auto",
        "Whether a column of the file is one marker throughout (columns), or identity ends with "
        "every gap (runs) or with every frame (points); auto: columns, unless there are many more "
        "of them than labels, or points jump between them.",
        choices=("auto", "columns", "runs", "points"),
    )
    least_confidence: float = setting(
        0.1,
        "Labels less sure than this are not given.",
        low=0.0,
        high=1.0,
        source="benchmarks.accuracy.labels: least coverage lost for what it refuses",
    )

    def __post_init__(self) -> None:
        check_settings(self)
