"""`zwidth play`: a page in a file or in a browser, and one clear line on bad input."""

from __future__ import annotations

import re
from pathlib import Path
from urllib.parse import unquote, urlparse
from urllib.request import url2pathname

import pytest

from zwidth.cli.main import main

PADDLE = ["play", "haptic-paddle", "--stiffness", "770"]


def test_a_page_is_saved(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """It holds the loop that was asked for; the outcome and the file are named; nobody's browser opens."""
    page = tmp_path / "wall.html"
    assert main([*PADDLE, "-o", str(page)]) == 0
    said = capsys.readouterr().out
    assert "ACTIVE: wall, 770 N/m" in said
    assert f"written: {page}" in said
    assert "wall, 770 N/m" in page.read_text(encoding="utf-8")


def test_laws_are_played(tmp_path: Path) -> None:
    """What is behind --law is in the loop."""
    page = tmp_path / "wall.html"
    assert main([*PADDLE, "--law", "force-bounding", "-o", str(page)]) == 0
    assert "force bounding" in page.read_text(encoding="utf-8")


def test_no_browser_opens_where_none_is_wanted(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """It is said where the page is."""
    monkeypatch.setattr("webbrowser.open", lambda _: pytest.fail("a browser was opened"))
    assert main([*PADDLE, "--no-browser"]) == 0
    outcome, written = capsys.readouterr().out.splitlines()
    assert outcome == "ACTIVE: wall, 770 N/m"
    Path(written.removeprefix("written: ").partition(" (")[0]).unlink()


def test_the_loops_to_begin_with_are_one_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """How many there are of each outcome, and where the page is."""
    assert main(["play", "-o", str(tmp_path / "page.html")]) == 0
    count, _ = capsys.readouterr().out.splitlines()
    assert count.startswith("11 loops to play: ")
    assert sum(map(int, re.findall(r"(\d+) \w", count.partition(":")[2]))) == 11


@pytest.mark.parametrize("found", [True, False])
def test_a_browser_opens_the_page(
    found: bool, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Without -o; where there is no browser it is said where the page is."""
    opened: list[str] = []
    monkeypatch.setattr("webbrowser.open", lambda address: opened.append(address) or found)
    assert main(PADDLE) == 0
    said = capsys.readouterr().out
    page = Path(url2pathname(unquote(urlparse(opened[0]).path)))
    assert page.read_text(encoding="utf-8").startswith("<!DOCTYPE html>")
    assert str(page) in said
    assert ("no browser" in said) != found
    page.unlink()


@pytest.mark.parametrize(
    ("given", "named"),
    [
        (["-o", "wall.png"], ".html"),
        (["--damping", "0.1 .. 0.2"], "a single value, the one that you take, for damping"),
        (["--delay", "1000 s"], "at most 10 s"),
    ],
)
def test_what_cannot_be_played_is_one_line(
    given: list[str], named: str, capsys: pytest.CaptureFixture[str]
) -> None:
    """Status 2, and a message that says what to give."""
    assert main([*PADDLE, *given]) == 2
    said = capsys.readouterr().err
    assert named in said
    assert said.count("\n") == 1


def test_a_page_that_is_there_is_kept(tmp_path: Path) -> None:
    """Unless --force says otherwise."""
    page = tmp_path / "wall.html"
    page.write_text("mine", encoding="utf-8")
    assert main([*PADDLE, "-o", str(page)]) == 2
    assert page.read_text(encoding="utf-8") == "mine"
    assert main([*PADDLE, "-o", str(page), "--force"]) == 0
    assert page.read_text(encoding="utf-8") != "mine"
