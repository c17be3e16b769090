"""Settings say their range and keep it."""

from dataclasses import dataclass

import pytest

from kinesphere.data import check_settings, setting, settings_as_json
from kinesphere.errors import BadSetting


@dataclass(frozen=True)
class FilterSettings:
    """A stand-in for a stage's settings."""

    window: float = setting(0.2, "speed is measured over this long", unit="s", low=0.01, high=2.0)
    method: str = setting("valley", "how the threshold is found", choices=("valley", "paper"))
    limit: float | None = setting(None, "no limit unless given", low=0.0)

    def __post_init__(self) -> None:
        check_settings(self)


def test_what_is_in_range_passes_unchanged():
    chosen = FilterSettings(window=2.0, method="paper")
    assert settings_as_json(chosen) == {"window": 2.0, "method": "paper", "limit": None}


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"window": 0.0}, "window is 0.0; it must be at least 0.01 s"),
        ({"window": 2.5}, "window is 2.5; it must be at most 2.0 s"),
        ({"window": float("nan")}, "window is nan"),
        ({"method": "otsu"}, "method is 'otsu'; known are valley, paper"),
        ({"limit": float("nan")}, "limit is nan; it must be at least 0.0$"),
        ({"limit": -1.0}, "limit is -1.0; it must be at least 0.0$"),
    ],
)
def test_what_is_out_of_range_is_named(changes, message):
    with pytest.raises(BadSetting, match=message):
        FilterSettings(**changes)
