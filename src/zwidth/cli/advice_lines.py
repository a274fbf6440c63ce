"""What to change, or what is left, as lines of a report: all of it, or the few that help most."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import chain

from rich.text import Text

from zwidth.cli.page import items
from zwidth.passivity.advice import Advice, in_lines

_FEW = 3


def advice_rows(advice: Iterable[Advice], passive: bool) -> Iterator[tuple[str, str]]:
    """The few that are changed most easily, as (name, text); each of them alone does it."""
    told = in_lines(advice, passive)
    texts = [told.at_limit, *told.changes] if told.at_limit else [*told.changes]
    if not texts and told.useless:
        texts = [told.useless]
    for place, text in enumerate(texts[:_FEW]):
        yield "or" if place else "slack" if passive else "change", text


def advice_section(advice: Iterable[Advice], passive: bool) -> tuple[str, Iterator[Text]]:
    """The title and the lines of what to change, or of what is left."""
    told = in_lines(advice, passive)
    return told.title, chain(items(told.useful), items([told.useless] if told.useless else [], "dim"))
