"""The pages: those the program writes are current, and every link leads somewhere."""

import importlib.util
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PAGES = sorted([*ROOT.glob("*.md"), *(ROOT / "docs").rglob("*.md")])
LINK = re.compile(r"!?\[[^\]]*\]\(([^)\s]+)\)")
NAMED = re.compile(r"`((?:docs|src|tests|benchmarks)/[\w./-]+\w)`")


@pytest.fixture(scope="module")
def generate():
    spec = importlib.util.spec_from_file_location("generate", ROOT / "docs" / "generate.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def anchors(page):
    """Return the anchors of a page as GitHub makes them of its headings."""
    headings = re.findall(r"^#+ (.+)$", page.read_text(encoding="utf-8"), re.MULTILINE)
    return {re.sub(r"[^\w -]", "", h.strip().lower()).replace(" ", "-") for h in headings}


def test_pages_written_by_the_program_are_current(generate):
    for name, text in generate.pages().items():
        written = (ROOT / "docs" / name).read_text(encoding="utf-8")
        assert written == text, f"docs/{name} is not what the program says; run `make docs`"


def test_every_option_and_setting_is_told(generate):
    cli, settings = (generate.pages()[name] for name in ("cli.md", "settings.md"))
    for word in ("`-o`, `--output` `DIR`", "`--set` `STAGE.KEY=VALUE`", "`--json`", "| `FILE` |"):
        assert word in cli
    assert "| `min_range_deg` | `15` deg | 0 … 180 |" in settings
    rows = [line for line in settings.splitlines() if line.startswith("| `")]
    assert all(line.replace("\\|", "").count("|") == 6 for line in rows)


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_links_lead_somewhere(page):
    text = page.read_text(encoding="utf-8")
    for link in LINK.findall(text):
        if re.match(r"[a-z]+:", link):
            continue
        file, _, anchor = link.partition("#")
        target = page.parent / file if file else page
        assert target.exists(), f"{link}: nothing is there"
        if anchor:
            assert anchor in anchors(target), f"{link}: no such heading"
    for name in NAMED.findall(text):
        assert (ROOT / name).exists(), f"{name}: nothing is there"
