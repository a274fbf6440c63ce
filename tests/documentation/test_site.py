"""A page of the built site that is broken is named, and one that is not, is not."""

from __future__ import annotations

import runpy
from collections.abc import Callable
from pathlib import Path

import pytest
from pages import ROOT

SITE = runpy.run_path(str(ROOT / ".ci" / "site.py"), run_name="site")
WORDS = "a page with enough words to be read as one " * 3


def page(body: str, title: str = "A page") -> str:
    head = f"<title>{title}</title><link href='style.css'>"
    return f"<html><head>{head}</head><body><article role='main'>{body}</article></body></html>"


@pytest.fixture
def site(tmp_path: Path) -> Callable[[str], list[str]]:
    (tmp_path / "style.css").write_text("", encoding="utf-8")
    (tmp_path / "dot.png").write_bytes(b"png")
    other = page(f"<h1 id='top'>Other</h1><p id='a-ä'>{WORDS}<br>")
    (tmp_path / "other.html").write_text(other, encoding="utf-8")

    def said(body: str, **told: str) -> list[str]:
        (tmp_path / "index.html").write_text(page(body, **told), encoding="utf-8")
        return list(SITE["complaints"](tmp_path))

    return said


GOOD = f"<h1>One</h1><p>{WORDS}</p>"


def test_a_good_page(site: Callable[..., list[str]]) -> None:
    links = "<a href='other.html#a-%C3%A4'>x</a><a href='https://example.org/x'>x</a>"
    links += "<a href='#here'>x</a><a name='here'>"
    pictures = "<img src='dot.png' alt='a dot'><img src='data:image/png;base64,AA' alt='a dot'>"
    assert site(GOOD + links + pictures) == []


@pytest.mark.parametrize(
    ("body", "part"),
    [
        (GOOD + "<a href='gone.html'>x</a>", "leads nowhere: gone.html"),
        (GOOD + "<a href='other.html#gone'>x</a>", "no such place: other.html#gone"),
        (GOOD + "<a href='#gone'>x</a>", "no such place: #gone"),
        (GOOD + "<a href='file:///etc/hosts'>x</a>", "leads out of the site: file:///etc/hosts"),
        (GOOD + "<a href='../secret.html'>x</a>", "leads nowhere: ../secret.html"),
        (GOOD + "<a href='https://'>x</a>", "leads out of the site: https://"),
        (GOOD + "<img src='gone.png' alt='a dot'>", "no picture gone.png"),
        (GOOD + "<img src='https://example.org/x' alt='a dot'>", "no picture https://example.org/x"),
        (GOOD + "<img src='dot.png'>", "a picture without words (alt): dot.png"),
        (GOOD + "<img src='dot.png' alt=' '>", "a picture without words (alt): dot.png"),
        (f"<p>{WORDS}</p>", "no heading"),
        ("<h1>One</h1>", "nearly empty"),
        (GOOD + "<pre>&lt;zwidth.Log object at 0x7f&gt;</pre>", "prints an object"),
        (GOOD + "<pre>[&lt;matplotlib.lines.Line2D at 0x7f&gt;]</pre>", "prints an object"),
        (GOOD + "<pre>&lt;Figure size 640x480 with 1 Axes&gt;</pre>", "prints an object"),
        (GOOD + "<pre>&lt;Axes: xlabel='t'&gt;</pre>", "prints an object"),
    ],
)
def test_a_broken_page(site: Callable[..., list[str]], body: str, part: str) -> None:
    (complaint,) = site(body)
    assert complaint.startswith(f"index.html: {part}")


def test_a_page_without_title_and_a_site_without_pages(
    site: Callable[..., list[str]], tmp_path: Path
) -> None:
    assert site(GOOD, title=" ") == ["index.html: no title"]
    empty = tmp_path / "empty"
    empty.mkdir()
    assert SITE["main"](empty) == 1
    assert SITE["main"](tmp_path) == 1
