"""docs/json.md as the docs' build makes it."""

from __future__ import annotations

import re
import sys
from functools import cache
from pathlib import Path

DOCS = Path(__file__).parents[1] / "docs"


@cache
def json_page() -> str:
    """The page, and the tables that it includes."""
    sys.path.insert(0, str(DOCS / "_ext"))
    try:
        import tables
    finally:
        sys.path.pop(0)
    page, made = (DOCS / "json.md").read_text(encoding="utf-8"), tables.generated()
    included = re.findall(r"\{include\} _generated/(.+)\.md", page)
    return "\n".join([page, *(made[name]() for name in included)])
