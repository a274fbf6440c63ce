"""The page of the papers: nothing of theirs is left out, and what differs is known to."""

from __future__ import annotations

import re
import sys
from pathlib import Path

import pytest

DOCS = Path(__file__).parents[2] / "docs"

CONTENTS = {
    "course": [
        "sampled-data system example",
        "detail of energy leak due to sampling",
        "position quantization",
        "conceptual derivation",
        "dimensionless stability plane",
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
    """Each is there, with something computed, and agrees but for what is known to differ."""
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
