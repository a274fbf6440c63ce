"""The page on hands says what the hands are."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from zwidth.model import operator as operators
from zwidth.model.operator import OPERATORS, Operator

PAGE = (Path(__file__).parents[2] / "docs" / "operators.md").read_text(encoding="utf-8")


def _section(title: str) -> str:
    return PAGE.split(f"\n## {title}\n", 1)[1].split("\n## ", 1)[0]


@pytest.mark.parametrize("name", OPERATORS)
def test_every_number_stands_on_the_page_with_its_default(name: str) -> None:
    kind = OPERATORS[name]
    rows = re.findall(
        r"^\| `(\w+)` \| (\S+ \S+) \| \S", _section(f"{kind.__name__} (`{name}`)"), re.MULTILINE
    )
    hand = kind()
    expected = [
        (key, f"{getattr(hand, key):.6g} {q.unit_for(kind.motion)}") for key, q in kind.parameters().items()
    ]
    assert sorted(rows) == sorted(expected)


def test_every_hand_has_a_section() -> None:
    titles = {title.split(" ")[0] for title in re.findall(r"^## (.+)$", PAGE, re.MULTILINE)}
    hands = {
        n
        for n in operators.__all__
        if isinstance(k := getattr(operators, n), type) and issubclass(k, Operator)
    }
    assert hands - {"Operator", "ParametricOperator"} <= titles


def test_the_links_of_the_table_lead_to_sections() -> None:
    titles = re.findall(r"^## (.+)$", PAGE, re.MULTILINE)
    anchors = {re.sub(r"[^\w -]", "", title).lower().replace(" ", "-") for title in titles}
    links = re.findall(r"\]\(#([\w-]+)\)", PAGE)
    assert len(links) > 9
    assert set(links) <= anchors
