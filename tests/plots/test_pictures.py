"""The pictures in the README and on the pages show what is found today."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

import zwidth as zw

ROOT = Path(__file__).parents[2]

SCREENS = ("explore", "live", "report")
"""Pages as a browser shows them."""

PADDLE = zw.catalogue.device("haptic-paddle")


@pytest.fixture(scope="module")
def pictures():
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(str(ROOT / "docs"))
        patch.setattr(sys, "path", list(sys.path))  # it adds the folder of the examples
        import pictures

        yield pictures
    del sys.modules["pictures"]


def test_every_picture_is_made_by_a_command(pictures):
    files = {path.stem for path in (ROOT / "docs" / "_static").glob("*.png")}
    assert files == {*pictures.PICTURES, *SCREENS}
    pages = "".join(
        path.read_text(encoding="utf-8") for path in [ROOT / "README.md", *ROOT.glob("docs/*.md")]
    )
    assert [name for name in files if f"_static/{name}.png" not in pages] == []


@pytest.mark.parametrize("name", ["check", "touch", "limit", "laws", "map", "identify"])
def test_a_picture_is_not_stale(pictures, name):
    """Its numbers and its words are those of today; `python docs/pictures.py` draws it anew."""
    assert list(pictures.stale(name)) == []


def test_the_picture_of_a_browser_is_not_stale(pictures):
    assert list(pictures.stale_live()) == []


def test_a_stale_picture_is_found(pictures, monkeypatch):
    softer = pictures.PICTURES["check"]._replace(find=lambda: zw.check(PADDLE, zw.Wall(760)))
    monkeypatch.setitem(pictures.PICTURES, "check", softer)
    assert [line.split(" ")[1] for line in pictures.stale("check")] == ["numbers", "words"]
