"""What is wrong with a file's content, in one line."""

from collections.abc import Mapping

from pydantic import ValidationError

_PLAIN = {
    "missing": "is missing",
    "extra_forbidden": "is no key this place knows",
    "tuple_type": "must be a list",
    "list_type": "must be a list",
    "dict_type": "must be an object",
    "model_type": "must be an object",
    "string_type": "must be text",
    "finite_number": "must be a finite number",
}
"""Pydantic's kinds of error that speak of Python, in the words of JSON."""


def first_problem(error: ValidationError) -> str:
    """Return the first thing wrong, its place (``joints[2].axes``) and what was found there."""
    problems = error.errors(include_url=False)
    first = problems[0]
    place = "".join(f"[{p}]" if isinstance(p, int) else f".{p}" for p in first["loc"]).lstrip(".")
    message = first["msg"].removeprefix("Value error, ").replace("Input should be", "must be")
    message = _PLAIN.get(first["type"], message)
    found = first["input"]
    plain = not isinstance(found, Mapping | list | tuple) and first["type"] != "extra_forbidden"
    shown = f", found {found!r:.60}" if plain else ""
    more = f" (and {len(problems) - 1} more)" if len(problems) > 1 else ""
    return f"{place or 'the whole'} {message}{shown}{more}"
