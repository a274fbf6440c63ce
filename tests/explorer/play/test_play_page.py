"""The page as a text: complete, harmless, small, and with the verdict's own words."""

from __future__ import annotations

import json
import re

import pytest

import zwidth as zw
from zwidth.show.explorer.play import Played, play_page, presets
from zwidth.show.explorer.play import played as play

MOST_BYTES = 300_000


@pytest.fixture(scope="module")
def loops() -> list[Played]:
    return presets()


def _facts(page: str) -> list[dict[str, object]]:
    found = re.search(r'<script type="application/json" id="facts">(.*?)</script>', page, re.DOTALL)
    facts: list[dict[str, object]] = json.loads(found[1])
    return facts


def test_the_page_is_whole_and_small(loops: list[Played]) -> None:
    page = play_page(loops)
    assert len(page.encode()) <= MOST_BYTES
    assert not re.search(r"https?://|src=|href=|@import|url\(|<!-- ", page)
    assert "import " not in page.partition('"use strict";')[2].replace("important", "")


def test_every_verdict_is_that_of_check(loops: list[Played]) -> None:
    for loop, facts in zip(loops, _facts(play_page(loops)), strict=True):
        verdict = zw.check(*loop.loop)  # type: ignore[call-overload]
        assert (facts["outcome"], facts["claim"]) == (verdict.outcome, verdict.claim)
        assert facts["assumptions"] == list(verdict.small_print())


def test_the_loops_show_both_outcomes(loops: list[Played]) -> None:
    assert {"passive", "active"} <= {loop.verdict.outcome for loop in loops}
    assert len({loop.name for loop in loops}) == len(loops)
    assert all(loop.do and loop.notice for loop in loops)


def test_text_of_others_is_shown_and_not_obeyed() -> None:
    """A name that closes the script, or is markup, stays text."""
    evil = "</script><script>alert(1)</script><img onerror=alert(2)>"
    device = zw.Device(mass=0.05, damping=0.2, rate=1000, name=evil)
    page = play_page([play(device, zw.Wall(100), name=evil)], title=evil)
    assert "<script>alert" not in page
    assert "<img" not in page
    assert page.count("</script>") == 2
    assert _facts(page)[0]["name"] == evil


def test_numbers_have_their_units(loops: list[Played]) -> None:
    numbers = {loop.name: dict(row[1:] for row in loop.facts()["numbers"]) for loop in loops}
    wheel = next(n for name, n in numbers.items() if "wheel" in name)
    assert wheel["damping"] == "0.02 N·m·s/rad"
    assert wheel["delay"] == "10 ms"
    first = next(iter(numbers.values()))
    assert first["law"] == "wall, 300 N/m"
    assert (first["resolution"], first["sample period"]) == ("22.4 µm", "1 ms")
    assert first["hand"] == "0.006 kg, 500 N/m, 1.7 N·s/m"


def test_a_page_without_loops_is_refused() -> None:
    with pytest.raises(zw.InputError, match="at least"):
        play_page([])
