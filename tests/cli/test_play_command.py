"""`zwidth play`: a page in a file or in a browser, and one clear line on bad input."""

import re
from pathlib import Path
from urllib.parse import unquote, urlparse
from urllib.request import url2pathname

import pytest

PADDLE = "play haptic-paddle --stiffness 770"


def test_a_page_is_saved(run):
    """It holds the loop that was asked for; the outcome and the file are named; nobody's browser opens."""
    run(f"{PADDLE} -o wall.html").says("ACTIVE: wall, 770 N/m", "written: wall.html")
    assert "wall, 770 N/m" in Path("wall.html").read_text(encoding="utf-8")
    run(f"{PADDLE} --law force-bounding -o bounded.html")
    assert "force bounding" in Path("bounded.html").read_text(encoding="utf-8")


def test_no_browser_opens_where_none_is_wanted(run, monkeypatch):
    monkeypatch.setattr("webbrowser.open", lambda _: pytest.fail("a browser was opened"))
    outcome, written = run(f"{PADDLE} --no-browser").out.splitlines()
    assert outcome == "ACTIVE: wall, 770 N/m"
    Path(written.removeprefix("written: ").partition(" (")[0]).unlink()


def test_the_loops_to_begin_with_are_one_line(run):
    count, _ = run("play -o page.html").out.splitlines()
    assert count.startswith("11 loops to play: ")
    assert sum(map(int, re.findall(r"(\d+) \w", count.partition(":")[2]))) == 11


@pytest.mark.parametrize("found", [True, False])
def test_a_browser_opens_the_page(run, found, monkeypatch):
    """Without -o; where there is no browser it is said where the page is."""
    opened = []
    monkeypatch.setattr("webbrowser.open", lambda address: opened.append(address) or found)
    said = run(PADDLE).out
    page = Path(url2pathname(unquote(urlparse(opened[0]).path)))
    assert page.read_text(encoding="utf-8").startswith("<!DOCTYPE html>")
    assert str(page) in said
    assert ("no browser" in said) != found
    page.unlink()


@pytest.mark.parametrize(
    ("given", "named"),
    [
        ("-o wall.png", ".html"),
        ("-o there.html", "exists"),
        ("--mass '0.1 .. 0.2 kg'", "a single value, the one that you take, for mass"),
        ("--delay '1000 s'", "at most 10 s"),
    ],
)
def test_what_cannot_be_played_is_one_line(run, refused, given, named):
    """A page that is there is kept, unless --force says otherwise."""
    Path("there.html").write_text("mine", encoding="utf-8")
    assert named in refused(f"{PADDLE} {given}")
    assert Path("there.html").read_text(encoding="utf-8") == "mine"
    if "there.html" in given:
        run(f"{PADDLE} {given} --force")
        assert Path("there.html").read_text(encoding="utf-8") != "mine"
