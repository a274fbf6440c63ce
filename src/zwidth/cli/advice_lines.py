"""What to change, or what is left, as lines of a report: all of it, or the few that help most."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from rich.text import Text

from zwidth.cli.page import items
from zwidth.passivity.advice import Advice
from zwidth.quantity.text import in_words

_ORDER = (
    "stiffness", "virtual_damping", "local_damping", "velocity_filter", "time_constant", "link_delay", "rate",
    "delay", "damping", "resolution", "coulomb_friction",
)  # fmt: skip
"""What is changed most easily comes first: the law, then the loop, then the machine."""

_FEW = 3


def advice_rows(advice: Iterable[Advice], passive: bool) -> Iterator[tuple[str, str]]:
    """The few that are changed most easily, as (name, text); each of them alone does it."""
    at_limit, useful, useless = _sorted(advice)
    texts = [f"exactly at the limit: {_names(at_limit)}"] if at_limit else []
    texts += [one.text for one in useful]
    if not useful and not at_limit and useless:
        texts = [f"no change alone would do: {_names(useless)}"]
    for place, text in enumerate(texts[:_FEW]):
        yield "or" if place else "slack" if passive else "change", text


def advice_section(advice: Iterable[Advice], passive: bool) -> tuple[str, Iterator[Text]]:
    """The title and the lines of what to change, or of what is left."""
    return "slack" if passive else "what to change, any one of", _advice_lines(advice)


def _advice_lines(advice: Iterable[Advice]) -> Iterator[Text]:
    at_limit, useful, useless = _sorted(advice)
    yield from items(one.text for one in useful)
    if at_limit:
        yield from items([f"exactly at the limit: {_names(at_limit)}"])
    if useless:
        slack = useless[0].kind == "slack"
        yield from items([f"{'no slack' if slack else 'no change alone would do'}: {_names(useless)}"], "dim")


def _sorted(advice: Iterable[Advice]) -> tuple[Sequence[Advice], Sequence[Advice], Sequence[Advice]]:
    """What is exactly at its limit, what would do, and what alone would not."""
    ordered = sorted(advice, key=lambda a: _ORDER.index(a.parameter) if a.parameter in _ORDER else 99)
    at_limit = [a for a in ordered if a.kind == "slack" and a.to is not None and a.to == a.current]
    useful = [a for a in ordered if a.to is not None and a not in at_limit]
    return at_limit, useful, [a for a in ordered if a.to is None and a.current != 0]


def _names(advice: Iterable[Advice]) -> str:
    return ", ".join(_name(a.parameter) for a in advice)


def _name(parameter: str) -> str:
    """In words; "leader.damping" is that of one arm of a pair."""
    arm, _, key = parameter.rpartition(".")
    return in_words(key) + (f" of the {arm}" if arm else "")
