"""Figures of an earlier prototype: its own reading of the rules, other draws of the generator."""

from collections.abc import Mapping

FILTER: Mapping[str, tuple[str, ...]] = {
    "log-speed": (
        "0.988 [0.988]",
        "0.988",
        "0.989",
        "0.989 [0.977]",
        "0.990",
        "0.987 [0.972]",
        "0.952 [0.935]",
    ),
    "paper": ("0.96 [0.95]", "0.86", "0.11", "0.04", "0.83", "0.21", "0.08"),
}
"""Method → F1 in each condition, mean [worst]."""

AXES: Mapping[str, Mapping[str, tuple[str, ...]]] = {
    cone: {method: tuple(row.split()) for method, row in rows.items()}
    for cone, rows in {
        "90°": {
            "pca": "34.8/52.7/100 37.1/53.3/100 36.2/53.3/100 "
            "33.1/52.1/100 34.2/51.0/100 34.4/52.4/100",
            "em": "0.19/52.7/17 0.21/53.3/23 0.46/0.99/7 0.52/1.13/3 1.58/3.60/0 2.77/5.24/7",
            "em-restarts": "0.17/0.30/0 0.20/0.38/0 0.45/0.94/0 "
            "0.52/1.10/0 1.54/3.55/0 2.70/4.82/0",
            "direction-joining": "0.15/0.28/0 0.26/0.47/0 0.88/2.60/0 "
            "0.53/0.97/0 1.76/3.92/0 2.45/4.10/0",
            "phase-log-pca": "0.13/0.27/0 0.19/0.40/0 0.43/0.81/0 "
            "0.67/1.25/0 1.78/3.87/0 3.98/5.68/0",
            "universal-joint": "0.00/0.00/0 0.29/0.75/0 0.80/2.34/0 "
            "1.11/3.05/0 3.58/9.64/0 4.75/10.3/0",
        },
        "75°": {
            "em-restarts": "16.9 16.9 17.1 17.0 17.2 –",
            "direction-joining": "16.7 16.6 16.5 16.6 16.6 –",
            "small-circle": "0.24 0.48 – 1.15 4.18 –",
            "phase-log-pca": "0.13 0.19 0.44 0.67 1.75 –",
            "universal-joint": "0.00 0.29 0.79 1.11 3.63 –",
        },
    }.items()
}
"""Cone → method → median / 90th percentile of the worse axis, deg / percent failed, per noise."""

FREE = ("0.00", "0.58", "1.6", "2.2", "9.2, 37 % failed")
"""Universal joint in free motion without twist, median in deg per noise."""

BRANCHES: Mapping[str, tuple[str, ...]] = {
    "viterbi": ("–", "1.5 %", "0.04 %", "1.1 %", "5.8 %"),
    "smallest-twist": ("–", "1.9 %", "1.3 %", "1.8 %", "4.7 %"),
    "default-sign": ("0 %", "5.3 %", "27.7 %", "28.0 %", "29.9 %"),
}
"""Rule → frames on the wrong branch per swing."""
