"""What a version says of itself: one number and one date, and a citation that tools can read."""

from __future__ import annotations

import re
import tomllib
from datetime import date
from typing import Any

import yaml
from pages import ROOT

import zwidth

PROJECT: dict[str, Any] = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
CITATION: dict[str, Any] = yaml.safe_load((ROOT / "CITATION.cff").read_text(encoding="utf-8"))
CFF_KEYS = {
    "abstract", "authors", "cff-version", "commit", "contact", "date-released", "doi", "identifiers",
    "keywords", "license", "license-url", "message", "preferred-citation", "references", "repository",
    "repository-artifact", "repository-code", "title", "type", "url", "version",
}  # fmt: skip
"""All that the Citation File Format 1.2.0 knows."""


def test_the_citation_is_of_this_version() -> None:
    assert CITATION["version"] == zwidth.__version__
    for key in ("license", "authors", "keywords"):
        assert CITATION[key] == PROJECT[key], key


def test_the_citation_is_one_of_the_citation_file_format() -> None:
    assert set(CITATION) <= CFF_KEYS
    assert {"authors", "cff-version", "message", "title"} <= set(CITATION)
    assert CITATION["cff-version"] == "1.2.0"
    assert CITATION["type"] == "software"
    assert all(isinstance(CITATION[key], str) for key in ("abstract", "message", "title"))
    assert isinstance(CITATION.get("date-released", date.today()), date)


def test_the_changelog_begins_with_this_version() -> None:
    """Not released: nobody states a date; released, the heading and the citation state one."""
    text = (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")
    heading = re.search(r"^## (.+)$", text, re.M)[1]
    if heading == "Not released":
        assert f"{zwidth.__version__} will be the" in text.partition("## ")[0]
        assert "date-released" not in CITATION
    else:
        assert heading == f"{zwidth.__version__}, {CITATION['date-released']}"


def test_pictures_and_files_that_the_readme_shows_are_there() -> None:
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    linked = re.findall(r"(!?)\[([^\]]*)\]\(([^)#]+)[^)]*\)", readme)
    assert len(linked) > 10
    for picture, words, target in linked:
        assert re.match("https?://", target) or (ROOT / target).is_file(), target
        assert words.strip() or not picture, target


def test_what_is_installed_is_called_by_its_version(capsys) -> None:
    """It stands in `zwidth/__init__.py` alone; metadata and command line have it from there."""
    from importlib.metadata import version

    from zwidth.cli.main import main

    assert PROJECT["dynamic"] == ["version"]
    assert version("zwidth") == zwidth.__version__
    assert main(["--version"]) == 0
    assert capsys.readouterr().out == f"zwidth {zwidth.__version__}\n"


def test_no_page_says_to_install_from_an_index() -> None:
    """Of an extra the quickstart alone says how; the others name it, and lead there."""
    index = re.compile(r"install (-\S+ )*['\"]?zwidth|'zwidth\[")
    pages = [ROOT / "README.md", *(ROOT / "docs").glob("**/*.md"), *(ROOT / "examples").glob("**/*.yml")]
    assert not [page.name for page in pages if index.search(page.read_text(encoding="utf-8"))]
    extras = PROJECT["optional-dependencies"].keys() - {"test", "docs"}
    quickstart = (ROOT / "docs" / "quickstart.md").read_text(encoding="utf-8")
    assert set(re.findall(r"^- `(\w+)`, \d+ MB", quickstart, re.M)) == extras
