"""Every page stands in one section, where a line says what it is; no section is longer than a glance."""

from __future__ import annotations

import re
from collections import Counter

from pages import NAMES, read

MOST = 9
OPEN_ENDED = {"docs/theory.md"}
"""Sections that are grouped within."""


def entries(page: str) -> list[str]:
    blocks = re.findall(r"^```\{toctree\}\n(.*?)^```", read(page), re.M | re.S)
    return [line for block in blocks for line in block.splitlines() if line and not line.startswith(":")]


SECTIONS = {name: found for name in NAMES if (found := entries(name))}


def test_every_page_is_in_one_section() -> None:
    """But for the first one, and for what a gallery makes."""
    listed = Counter(f"docs/{entry}.md" for found in SECTIONS.values() for entry in found)
    pages = {name for name in NAMES if name.startswith("docs/")} - {"docs/index.md"}
    assert pages - set(listed) == set()
    assert [name for name, times in listed.items() if times > 1] == []


def test_a_section_says_what_is_in_it() -> None:
    for name, found in SECTIONS.items():
        linked = set(re.findall(r"\]\(([\w/-]+?)(?:\.md)?(?:#[\w-]+)?\)", read(name)))
        assert set(found) - linked == set(), name


def test_a_section_can_be_looked_over() -> None:
    assert [name for name, found in SECTIONS.items() if len(found) > MOST and name not in OPEN_ENDED] == [
        "docs/index.md"
    ]
    assert len(entries("docs/index.md")) <= 12
