"""Results as Markdown."""

from typing import Any


def page(results: dict[str, Any]) -> str:
    """Return the page."""
    return str(sorted(results)) + "\n"
