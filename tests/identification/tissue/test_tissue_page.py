"""The page on soft tissue runs, and says what comes out."""

from __future__ import annotations

import re
from pathlib import Path

from printed import shows

PAGE = Path(__file__).parents[3] / "docs" / "tissue.md"


def test_the_page_says_what_comes_out():
    """Its Python blocks in a row; the fit that it prints is the one that they make."""
    page = PAGE.read_text(encoding="utf-8")
    names: dict[str, object] = {}
    for block in re.findall(r"```python\n(.*?)```", page, re.DOTALL):
        exec(block, names)
    (printed,) = re.findall(r"```text\n(.*?)```", page, re.DOTALL)
    assert shows(repr(names["fit"]) + "\n", printed)
    assert names["models"].best.model.name == "standard-linear-solid"
    assert names["verdict"].outcome == "passive"
