"""The built documentation, read as a visitor would: `python .ci/site.py FOLDER` names what is broken.

Links inside it lead to a page, and to a place on it; pictures are there and say what they show; every page
has a title and something to read; no page prints what Python calls an object that it has no words for.  What
leads abroad is not fetched: it has the name of a host.  The exit status is 1 where something is broken.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Iterator
from dataclasses import dataclass, field
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

REPRS = re.compile(r" object at 0x|<Figure size|<Axes|\[?<matplotlib|<xarray\.|<function ")
BORN_BY_SPHINX = {"genindex.html", "py-modindex.html", "search.html", "sg_execution_times.html"}
"""Pages that are lists or need JavaScript."""

THUMBNAIL = "_thumb."
"""In the gallery the title stands beside it, so that it needs no words of its own."""

LEAST_WORDS = 20
VOID = {"area", "base", "br", "col", "hr", "img", "input", "link", "meta", "source", "wbr"}


@dataclass
class Page(HTMLParser):
    """What a page links to, can be linked to by, shows and says."""

    links: list[str] = field(default_factory=list)
    places: set[str] = field(default_factory=set)
    pictures: list[tuple[str, str | None]] = field(default_factory=list)
    title: str = ""
    heading: str = ""
    text: str = ""
    _open: list[str] = field(default_factory=list)
    _reads: bool = False

    def __post_init__(self) -> None:
        """As the parser wants it."""
        super().__init__(convert_charrefs=True)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        """Collects links, places, pictures."""
        told = dict(attrs)
        self.places |= {value for key in ("id", "name") if (value := told.get(key))}
        if tag in {"a", "link"} and (href := told.get("href")):
            self.links.append(href)
        if tag == "script" and (source := told.get("src")):
            self.links.append(source)
        if tag == "img":
            self.pictures.append((told.get("src") or "", told.get("alt")))
        if tag not in VOID:
            self._open.append(tag)
            self._reads |= tag == "article" or told.get("role") == "main"

    def handle_endtag(self, tag: str) -> None:
        """Back to what was open before."""
        while tag in self._open and self._open.pop() != tag:
            pass

    def handle_data(self, data: str) -> None:
        """What is read."""
        if "script" in self._open or "style" in self._open:
            return
        if "title" in self._open and "svg" not in self._open:
            self.title += data
        if "h1" in self._open:
            self.heading += data
        if self._reads:
            self.text += data


def read(path: Path) -> Page:
    """A page of the site."""
    page = Page()
    page.feed(path.read_text(encoding="utf-8"))
    return page


def complaints(site: Path) -> Iterator[str]:
    """All that is broken, the page first."""
    pages = {
        path.resolve(): read(path) for path in sorted(site.rglob("*.html")) if "_static" not in path.parts
    }
    if not pages:
        yield f"{site}: no pages"
    for path, page in pages.items():
        for complaint in (
            *_of_text(path, page),
            *_of_pictures(path, page, site),
            *_of_links(path, page, pages, site),
        ):
            yield f"{path.relative_to(site.resolve())}: {complaint}"


def _of_text(path: Path, page: Page) -> Iterator[str]:
    if not page.title.strip() or page.title.lstrip().startswith("<no title>"):
        yield "no title"
    if path.name in BORN_BY_SPHINX:
        return
    if not page.heading.strip():
        yield "no heading"
    if len(page.text.split()) < LEAST_WORDS:
        yield "nearly empty"
    for found in REPRS.finditer(page.text):
        around = page.text[max(0, found.start() - 30) : found.end() + 30]
        yield f"prints an object: {' '.join(around.split())}"


def _of_pictures(path: Path, page: Page, site: Path) -> Iterator[str]:
    for source, words in page.pictures:
        if words is None or not (words.strip() or THUMBNAIL in source):
            yield f"a picture without words (alt): {source}"
        if source.startswith("data:"):
            continue
        file = _target(path, urlsplit(source).path, site)
        if urlsplit(source).scheme or not file.is_file() or not file.stat().st_size:
            yield f"no picture {source}"


def _of_links(path: Path, page: Page, pages: dict[Path, Page], site: Path) -> Iterator[str]:
    for link in dict.fromkeys(page.links):
        parts = urlsplit(link)
        if parts.scheme or parts.netloc:
            if parts.scheme not in {"http", "https", "mailto", "data"} or not (parts.netloc or parts.path):
                yield f"leads out of the site: {link}"
            continue
        target = _target(path, parts.path, site)
        if not target.is_file():
            yield f"leads nowhere: {link}"
        elif not target.is_relative_to(site.resolve()):
            yield f"leads out of the site: {link}"
        elif parts.fragment and target in pages and unquote(parts.fragment) not in pages[target].places:
            yield f"no such place: {link}"


def _target(page: Path, link: str, site: Path) -> Path:
    if not link:
        return page
    base = site if link.startswith("/") else page.parent
    target = (base / unquote(link).lstrip("/")).resolve()
    return target / "index.html" if target.is_dir() else target


def main(site: Path) -> int:
    """0 where nothing is broken."""
    found = list(complaints(site))
    print("\n".join(found) if found else f"{sum(1 for _ in site.rglob('*.html'))} pages, nothing broken")
    return 1 if found else 0


if __name__ == "__main__":
    raise SystemExit(main(Path(sys.argv[1])))
