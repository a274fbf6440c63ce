"""The pages of the docs and the README, and what the docs' build makes of their blocks."""

from __future__ import annotations

import sys
from functools import cache
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
DOCS = ROOT / "docs"

sys.path.insert(0, str(DOCS / "_ext"))
try:
    import shown
finally:
    sys.path.pop(0)

NAMES = sorted(
    [
        "README.md",
        *(
            str(path.relative_to(ROOT))
            for path in DOCS.rglob("*.md")
            if not {"_build", "_generated", "gallery"} & set(path.relative_to(DOCS).parts)
        ),
    ]
)

__all__ = ["DOCS", "NAMES", "ROOT", "read", "shown"]


@cache
def read(name: str) -> str:
    return (ROOT / name).read_text(encoding="utf-8")
