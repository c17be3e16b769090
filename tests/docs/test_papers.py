"""docs/papers.md names functions and settings that are there."""

import re
from functools import reduce
from importlib import import_module
from pathlib import Path

import pytest

from kinesphere.pipeline.settings import changes_from_text, settings_from

PAGE = (Path(__file__).parents[2] / "docs" / "papers.md").read_text(encoding="utf-8")
CODE = sorted(set(re.findall(r"`([^`]+)`", PAGE)))
FUNCTIONS = [code for code in CODE if re.fullmatch(r"[a-z_.]+:[\w.]+", code)]
CHOICES = [code for code in CODE if re.fullmatch(r"[a-z]+\.[a-z_]+=[\w-]+", code)]


@pytest.mark.parametrize("name", FUNCTIONS)
def test_a_function_is_where_the_page_says(name):
    module, _, inside = name.partition(":")
    found = reduce(getattr, inside.split("."), import_module(f"kinesphere.{module}"))
    assert found.__doc__, "what is worth naming is worth a sentence"


@pytest.mark.parametrize("choice", CHOICES)
def test_a_choice_is_one(choice):
    settings_from(changes_from_text([choice]))


def test_the_page_is_read_rightly():
    assert "normalization.anatomy:Anatomy.mid_point" in FUNCTIONS
    assert "axes.method=direction-joining" in CHOICES
    odd = [code for code in CODE if ":" in code and code not in FUNCTIONS]
    assert odd == ["MODULE:NAME"]
