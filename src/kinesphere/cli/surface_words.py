"""What the surface stage found, in words."""

from pathlib import Path
from typing import Any


def surface_in_words(found: dict[str, Any], _: dict[str, Any]) -> str:
    """Return which body rides on the skeleton and how it was taken, or why there is none."""
    body = str(found.get("body", ""))
    asked, __, why = body.partition(": ")
    if asked == "none":
        return f"no body: {why}" if why else "no body, as asked"
    if "tall_m" not in found:  # solved by an earlier version
        return f"{body} body"
    text = f"{'the bundled body' if body == 'bundled' else Path(body).name}"
    if "weights" in found:
        pose = found["pose"] if len(found["pose"]) > 1 else f"{found['pose']}-pose"
        text += (
            f", {pose}, up {found['up']}, facing {found['facing']}, unit {found['unit']}; "
            f"weights {found['weights']}"
        )
    text += f"; {found['tall_m']:.2f} m tall"
    if turned := found.get("inverted_triangles"):
        text += f"; {turned} triangles lie folded over"
    return text
