"""Pages of the docs: nothing of the papers is left out, and pictures show what is found today."""

from __future__ import annotations

import re
import sys
from pathlib import Path

import pytest

import zwidth as zw

DOCS = Path(__file__).parents[2] / "docs"

CONTENTS = {
    "course": [
        *("sampled-data system example", "detail of energy leak due to sampling", "position quantization"),
        *("conceptual derivation", "dimensionless stability plane"),
        "where do commercial haptic devices stand?",
        *(f"approach #{n}" for n in (1, 2, 3, 4)),
        "Hannaford & Ryu 2002, Fig. 10",
        *(f"bouncing ball simulation, {part}" for part in ("original", "prediction", "correction")),
        "key point",
    ],
    "thesis": ["Fig. 1", "Fig. 2.1", "Fig. 2.2", *(f"(2.{n})" for n in (1, 2, 3, 4, 5))],
    "walls": [*(f"Fig. {n}" for n in range(1, 13)), "(3)", "III-C, first", "III-C, second"],
    "linkages": [*(f"Fig. {n}" for n in range(1, 5)), "Lemma 2", "Theorem 3", "(24)"],
    "tissues": [
        *(f"Fig. {n}" for n in (1, 2, 3, 5)),
        *(f"Fig. {n}({part})" for n in (4, 6) for part in "ab"),
        *(f"Table {n}" for n in (1, 2, 3)),
        "Theorem 1",
        "(22)",
        *(f"appendix {n}" for n in (1, 2, 3)),
    ],
}
"""Every figure and table of each text, and its theorems; slides of the lecture, which numbers none."""

DIFFERS = {
    "course": {"where do commercial haptic devices stand?"},
    "thesis": set(),
    "walls": {"Fig. 11", "section IV-C: at 3 ms the boundary of the buzz moves by about 10 %"},
    "linkages": {"(24)"},
    "tissues": {"(41), (42)", "Fig. 4(b)", "Fig. 5, Table 1", "appendix 2, algorithm 1"},
}
"""What is not so, or cannot be told; each with its reason on the page."""


@pytest.fixture(scope="module")
def papers():
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(str(DOCS / "_ext"))
        import papers

        yield papers
    for name in [name for name in sys.modules if name.split(".")[0] == "papers"]:
        del sys.modules[name]


@pytest.mark.parametrize("name", CONTENTS)
def test_every_figure_and_table_has_its_row(papers, name):
    rows = getattr(papers, name).rows()
    places = " ".join(row.place for row in rows)
    assert [part for part in CONTENTS[name] if not re.search(rf"{re.escape(part)}(?!\d)", places)] == []
    assert all(row.found for row in rows)
    assert len({(row.place, row.claim) for row in rows}) == len(rows)
    differs = {row.place: row for row in rows if not row.answer.startswith("yes")}
    known = {place.split(":")[0] for place in DIFFERS[name]}
    assert set(differs) == known
    assert all(": " in row.answer for row in differs.values())
    assert "|" not in "".join(part for row in rows for part in row)


def test_gallery_pages_that_are_named_exist(papers):
    source = "".join(path.read_text(encoding="utf-8") for path in (DOCS / "_ext" / "papers").glob("*.py"))
    names = set(re.findall(r"""drawn\(["'](\w+)""", source))
    assert len(names) > 10
    examples = DOCS.parent / "examples"
    assert [name for name in names if not (examples / f"plot_{name}.py").is_file()] == []


# ---- pictures in the README and on the pages


SCREENS = ("explore", "live", "report")
"""Pages as a browser shows them."""

PADDLE = zw.catalogue.device("haptic-paddle")


@pytest.fixture(scope="module")
def pictures():
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(str(DOCS))
        patch.setattr(sys, "path", list(sys.path))  # it adds the folder of the examples
        import pictures

        yield pictures
    del sys.modules["pictures"]


def test_every_picture_is_made_by_a_command(pictures):
    files = {path.stem for path in (DOCS / "_static").glob("*.png")}
    assert files == {*pictures.PICTURES, *SCREENS}
    pages = "".join(
        path.read_text(encoding="utf-8") for path in [DOCS.parent / "README.md", *DOCS.glob("*.md")]
    )
    assert [name for name in files if f"_static/{name}.png" not in pages] == []


@pytest.mark.parametrize("name", ["check", "touch", "limit", "laws", "map", "cable", "identify"])
def test_a_picture_is_not_stale(pictures, name):
    """Its numbers and its words are those of today; `python docs/pictures.py` draws it anew."""
    assert list(pictures.stale(name)) == []


def test_the_picture_of_a_browser_is_not_stale(pictures):
    assert list(pictures.stale_live()) == []


def test_a_stale_picture_is_found(pictures, monkeypatch):
    softer = pictures.PICTURES["check"]._replace(find=lambda: zw.check(PADDLE, zw.Wall(760)))
    monkeypatch.setitem(pictures.PICTURES, "check", softer)
    assert [line.split(" ")[1] for line in pictures.stale("check")] == ["numbers", "words"]
