"""docs/warnings.md explains warnings in the very words in which they are said."""

import ast
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PAGE = ROOT / "docs" / "warnings.md"
QUOTED = re.compile(r"“([^”]+)”")


def said():
    """Return every piece of text in the source, between whatever is filled in."""
    pieces = []
    for path in (ROOT / "src" / "kinesphere").rglob("*.py"):
        tree = ast.parse(path.read_text(encoding="utf-8"))
        told = {
            id(node.value) for node in ast.walk(tree) if isinstance(node, ast.Expr)
        }  # docstrings
        pieces += [
            node.value
            for node in ast.walk(tree)
            if isinstance(node, ast.Constant)
            and isinstance(node.value, str)
            and id(node) not in told
        ]
    return "\n".join(pieces)


@pytest.fixture(scope="module")
def source():
    return said()


def explained():
    """Return what the first columns of the page's tables quote."""
    rows = [line for line in PAGE.read_text(encoding="utf-8").splitlines() if line.startswith("| ")]
    return [
        quote for row in rows for quote in QUOTED.findall(row.split(" | ")[0]) if quote != "said"
    ]


def test_the_page_explains_something():
    assert len(explained()) > 40


@pytest.mark.parametrize("quote", explained())
def test_what_is_explained_is_said(quote, source):
    assert quote in source
