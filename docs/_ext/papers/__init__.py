"""The papers figure by figure: what each claims beside what zwidth computes, now.

A paper is a module with its `TITLE`, its `SOURCE` and `rows()`.  No result is typed: every
number of the third column is computed when the rows are, which takes some seconds in all.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from types import ModuleType

from papers import course, linkages, thesis, tissues, walls

PAPERS: tuple[ModuleType, ...] = (course, thesis, walls, linkages, tissues)

HEAD = ("in the paper", "what it claims", "what zwidth computes", "agrees")

Table = Callable[[Sequence[str], Iterable[Sequence[str]]], str]


def page(markdown: Table) -> str:
    """A section for each paper, with its table."""
    return "\n".join(f"## {p.TITLE}\n\n{p.SOURCE}\n\n{markdown(HEAD, p.rows())}" for p in PAPERS)
