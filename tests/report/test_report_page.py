"""The report as a page: verdict first, everything in it, nothing in it obeyed."""

from __future__ import annotations

import json
import re
from base64 import b64decode
from hashlib import sha256
from html.parser import HTMLParser
from pathlib import Path

import pytest

import zwidth as zw
from zwidth.passivity.certificate import read_document, verify_document
from zwidth.passivity.verdict import Verdict

PADDLE = zw.catalogue.device("haptic-paddle")
VOID = {"meta", "img"}


class Read(HTMLParser):
    """What a browser makes of the tags: each is closed, in order."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.open: list[str] = []
        self.tags: list[tuple[str, dict[str, str | None]]] = []
        self.texts: list[tuple[str, str]] = []
        self.feed(text)
        self.close()
        assert self.open == []

    def handle_starttag(self, tag, attrs):
        assert len({name for name, _ in attrs}) == len(attrs)
        self.tags.append((tag, dict(attrs)))
        if tag not in VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag, attrs):
        assert tag in VOID
        self.tags.append((tag, dict(attrs)))

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        self.texts.append((self.open[-1] if self.open else "", data))

    def inside(self, *tags: str) -> list[str]:
        return [text for tag, text in self.texts if tag in tags]


def _text(page: str) -> str:
    return " ".join(" ".join(text for tag, text in Read(page).texts if tag != "style").split())


def test_the_verdict_stands_first_and_the_rest_below(active: Verdict, active_page: str) -> None:
    read, said = Read(active_page), _text(active_page)
    assert active_page.startswith('<!doctype html>\n<html lang="en">')
    assert read.inside("h1") == ["haptic-paddle: wall, 770 N/m"]
    assert read.inside("h2") == [
        "In numbers", "What to change, any one of", "What the claim covers and takes for granted",
        "The evidence", "The first steps of the motion", "Figures", "The actuator, beside the claim",
        "What is not covered", "Where each number comes from", "What the checker read",
        "How to check it again",
    ]  # fmt: skip
    lines = [active.claim, *active.small_print(), *(a.text for a in active.advice if a.to is not None)]
    places = [said.index(line) for line in ("active", *lines[:1])]
    assert places == sorted(places)
    assert not [line for line in lines if line not in said]
    assert active.witness.describe() in said


def test_the_first_steps_are_those_of_the_motion(active: Verdict, active_page: str) -> None:
    """Positions of the witness, the force of the wall at the sample before, and the energy of all of it."""
    table = re.search(r"energy out so far.*?</table>", active_page, re.DOTALL)
    assert table
    rows = [re.findall(r"<td>([^<]*)</td>", row) for row in table[0].split("<tr>")[2:]]
    shown = [1e-3 * float(row[1]) for row in rows]
    assert shown == pytest.approx(list(active.witness.positions), rel=1e-3)
    read = active.witness.positions[1] // 22.4e-6 * 22.4e-6
    assert float(rows[1][2]) == pytest.approx(770 * read, rel=1e-3)
    assert float(rows[-1][3]) == pytest.approx(1e3 * active.witness.energy, rel=1e-3)


def test_text_of_others_is_shown_and_not_obeyed(hostile_page: str) -> None:
    read = Read(hostile_page)
    assert "<script>alert(1)</script> & $\\frac{$ ?[2J ?\"'" in read.inside("h1")[0]
    assert "script" not in {tag for tag, _ in read.tags}
    policy = next(given["content"] for tag, given in read.tags if given.get("http-equiv"))
    assert policy.startswith("default-src 'none';")
    addresses = [given[name] for _, given in read.tags for name in ("src", "href") if name in given]
    assert addresses
    assert all(str(address).startswith("data:") for address in addresses)


def test_the_proof_is_in_the_page(
    active: Verdict, active_page: str, hostile: Verdict, hostile_page: str, tmp_path: Path
) -> None:
    """As `save` writes it, so that its SHA-256 can be compared, and the checker accepts it."""
    for verdict, page in ((active, active_page), (hostile, hostile_page)):
        found = re.search(r'href="data:application/json;base64,([^"]+)"', page)
        assert found
        document = b64decode(found[1])
        verdict.save(tmp_path / "verdict.json")
        assert document == (tmp_path / "verdict.json").read_bytes()
        assert sha256(document).hexdigest() in page
        assert json.loads(document)["outcome"] == verdict.outcome
        assert verify_document(read_document(tmp_path / "verdict.json")).valid


def test_every_picture_says_what_is_in_it(active_page: str) -> None:
    read = Read(active_page)
    said = [str(given["alt"]) for tag, given in read.tags if tag == "img"]
    assert len(said) == len(read.inside("figcaption")) == 4
    for words, number in zip(said, ("0.385 N·s/m", "0.1948", "0.15", "extracts 1.427 mJ"), strict=True):
        assert number in words


LOOPS = {
    "passive in contact": (zw.Device(damping=0.12, rate=1000, delay=0.0004), zw.Wall(100, 0.03)),
    "undecided": (zw.Device(damping=0.12, rate=1000, delay=0.0004), zw.Wall(100, 0.03, clamped=True)),
    "passive": (PADDLE.replace(damping=(0.14, 0.2)), zw.Wall((200, 250))),
    "passive of two arms": (zw.Pair(PADDLE, PADDLE, stiffness=100),),
    "active": (zw.rotary(damping=0.05, coulomb_friction=0.1, counts_per_turn=2400, rate=1000), zw.Wall(80)),
}


@pytest.mark.parametrize("outcome", LOOPS)
def test_a_report_of_every_outcome(outcome: str) -> None:
    verdict = zw.check(*LOOPS[outcome])
    said = _text(zw.report.html(verdict))
    assert verdict.outcome == outcome.removesuffix(" of two arms")
    assert said.startswith(f"{verdict.outcome}: ")
    assert not [line for line in (verdict.claim, *verdict.assumptions) if line not in said]
    assert "rejects it" not in said
    assert ("accepts it" in said) == (outcome != "undecided")
    assert "N*" not in said


def test_a_report_is_written_under_its_own_endings(active: Verdict, active_page: str, tmp_path: Path) -> None:
    with pytest.raises(zw.InputError, match=r"written as \.html, got 'report.doc'"):
        zw.report.save(active, tmp_path / "report.doc")
    path = tmp_path / "report.html"
    zw.report.save(active, path)
    assert path.read_text(encoding="utf-8") == active_page
    with pytest.raises(zw.InputError, match="exists"):
        zw.report.save(active, path)
