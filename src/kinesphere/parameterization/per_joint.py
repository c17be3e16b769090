"""What a user says joint by joint: windows of main movements, numbers of axes."""

import numpy as np

from kinesphere.errors import BadSetting


def parse_windows(text: str) -> dict[str, tuple[float, float]]:
    """Return joint → (start, end) in s from ``"left_hip=0:12, knee=12:24"``.

    Raises
    ------
    BadSetting
        If an entry is no ``JOINT=START:END`` with 0 <= START < END, or a joint comes twice.
    """
    windows: dict[str, tuple[float, float]] = {}
    for entry in filter(None, (part.strip() for part in text.split(","))):
        name, _, span = (part.strip() for part in entry.partition("="))
        try:
            start, end = (float(part) for part in span.split(":"))
        except ValueError:
            start, end = np.nan, np.nan
        if not name or not 0 <= start < end < np.inf:
            raise BadSetting(
                f"windows holds {entry!r}; write JOINT=START:END in seconds, as in left_hip=0:12"
            )
        if name in windows:
            raise BadSetting(f"windows names {name} twice; write one window for each joint")
        windows[name] = (start, end)
    return windows


def parse_counts(text: str) -> dict[str, int]:
    """Return joint → number of axes from ``"left_wrist=1, hip=2"``.

    Raises
    ------
    BadSetting
        If an entry is no ``JOINT=N`` with N from 1 to 3, or a joint comes twice.
    """
    counts: dict[str, int] = {}
    for entry in filter(None, (part.strip() for part in text.split(","))):
        name, _, number = (part.strip() for part in entry.partition("="))
        if not name or number not in ("1", "2", "3"):
            raise BadSetting(f"counts holds {entry!r}; write JOINT=N with N 1, 2 or 3")
        if name in counts:
            raise BadSetting(f"counts names {name} twice; write one number for each joint")
        counts[name] = int(number)
    return counts
