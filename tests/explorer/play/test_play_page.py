"""The page as a text: complete, harmless, small, with the verdict's own words; and what is heard."""

from __future__ import annotations

import json
import re
from pathlib import Path

import numpy as np
import pytest
from explorer.play.engines import run_node

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
    assert first["hand"] == "6 g, 500 N/m, 1.7 N·s/m"


_RUN = """\
import { Waveform } from "OURS/sound.mjs";
const forces = {
    rest: () => 0,
    press: () => 2,
    buzz: (k) => 2 + (k % 4 < 2 ? 1 : -1),
    wobble: (k) => 2 * Math.sin((2 * Math.PI * 3 * k) / 1000),
};
const heard = {};
for (const [name, force] of Object.entries(forces)) {
    const wave = new Waveform(48000, 0.001, 4);
    for (let k = 0; k < 2000; k += 1) wave.push(force(k));
    heard[name] = [...wave.take()];
    if (wave.take().length) throw new Error("taken twice");
}
console.log(JSON.stringify(heard));
"""


def test_a_buzz_is_heard_above_a_press(tmp_path: Path) -> None:
    """48 samples of sound for each of a force at 1 kHz, none beyond 1; a wobble of 3 Hz is heard as well."""
    heard = {name: np.array(wave) for name, wave in run_node(_RUN, tmp_path).items()}
    loud = {name: float(wave[len(wave) // 2 :].std()) for name, wave in heard.items()}
    assert all(abs(wave.size - 96_000) <= 1 for wave in heard.values())
    assert all(np.abs(wave).max() <= 1.0 for wave in heard.values())
    assert loud["rest"] == 0.0
    assert 0.0 < loud["press"] < 0.2 * loud["buzz"]
    assert loud["wobble"] > loud["press"]
    spectrum = np.abs(np.fft.rfft(heard["buzz"][48_000:]))
    assert abs(int(spectrum.argmax()) - 250) <= 1
