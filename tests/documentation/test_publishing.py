"""What a version says of itself: one number and one date, and a citation that tools can read."""

from __future__ import annotations

import re
import tomllib
from datetime import date
from pathlib import Path
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
    for key in ("version", "license", "authors", "keywords"):
        assert CITATION[key] == PROJECT[key], key


def test_the_citation_is_one_of_the_citation_file_format() -> None:
    assert set(CITATION) <= CFF_KEYS
    assert {"authors", "cff-version", "message", "title"} <= set(CITATION)
    assert CITATION["cff-version"] == "1.2.0"
    assert CITATION["type"] == "software"
    assert all(isinstance(CITATION[key], str) for key in ("abstract", "message", "title"))
    assert isinstance(CITATION["date-released"], date)


def test_the_changelog_begins_with_this_version_and_its_date() -> None:
    text = (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")
    heading = re.search(r"^## (\S+), (\d{4}-\d\d-\d\d)$", text, re.M)
    assert heading[1] == PROJECT["version"]
    assert date.fromisoformat(heading[2]) == CITATION["date-released"]


def test_pictures_and_files_that_the_readme_shows_are_there() -> None:
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    linked = re.findall(r"(!?)\[([^\]]*)\]\(([^)#]+)[^)]*\)", readme)
    assert len(linked) > 10
    for picture, words, target in linked:
        assert re.match("https?://", target) or (ROOT / target).is_file(), target
        assert words.strip() or not picture, target


def test_what_is_installed_is_called_by_its_version() -> None:
    from importlib.metadata import version

    assert version("zwidth") == PROJECT["version"]
    assert Path(zwidth.__file__).name == "__init__.py"
