"""Advice on one number, and how a report lists it: what is changed most easily first."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from math import isinf
from typing import Literal

from zwidth.quantity.text import in_words

Kind = Literal["change", "slack"]

_EASIEST_FIRST = (
    "stiffness", "virtual_damping", "local_damping", "velocity_filter", "time_constant", "link_delay", "rate",
    "delay", "damping", "resolution", "coulomb_friction",
)  # fmt: skip
"""The law, then the loop, then the machine."""


@dataclass(frozen=True)
class Advice:
    """One parameter, where it is and where it may or must go, both in `unit`.

    `kind` is "change" for a loop that is not passive and "slack" for one that is; `to` is None where no value
    on the safer side was found that would do alone, and inf ("any" as plain data) where it may have any.
    `is_alone` where it is no limit that keeps it where it is: of values beside it nothing is proved or
    refuted.  Of an interval it is the end that asks for more.
    """

    parameter: str
    current: float | str
    to: float | str | None
    unit: str
    kind: Kind
    text: str
    is_alone: bool = False

    def to_dict(self) -> dict[str, object]:
        """As plain data: parameter, from, to, unit, kind, text."""
        to = "any" if isinstance(self.to, float) and isinf(self.to) else self.to
        return {
            "parameter": self.parameter,
            "from": self.current,
            "to": to,
            "unit": self.unit,
            "kind": self.kind,
            "text": self.text,
        }


@dataclass(frozen=True)
class InLines:
    """Advice as a report says it: a title, and under it what may be turned, easiest first, a line each.

    Then in one line each, "" where there is nothing: what is `at_limit`, and what it is `useless` to turn.
    """

    title: str
    changes: tuple[str, ...]
    at_limit: str
    useless: str

    @property
    def useful(self) -> tuple[str, ...]:
        """All but the useless."""
        return (*self.changes, self.at_limit) if self.at_limit else self.changes


def in_lines(advice: Iterable[Advice], passive: bool) -> InLines:
    """What to change, or what is left, as a report says it."""
    ordered = sorted(advice, key=lambda item: (*_EASIEST_FIRST, item.parameter).index(item.parameter))
    useless = [a for a in ordered if a.to is None and a.current != 0]
    at_limit = [a for a in ordered if a.kind == "slack" and a.to is not None and a.to == a.current]
    none = "no slack" if passive else "no change found that would do alone"
    return InLines(
        "slack" if passive else "what to change, any one of",
        tuple(item.text for item in ordered if item.to is not None and item not in at_limit),
        "; ".join(_where_it_is(at_limit)),
        f"{none}: {_names(useless)}" if useless else "",
    )


def _where_it_is(advice: Iterable[Advice]) -> Iterator[str]:
    """Those at a limit, and those of whose neighbours nothing is known."""
    words = "exactly at the limit", "proved where it is, and for delays of whole samples alone"
    for is_alone, where in enumerate(words):
        if these := [a for a in advice if a.is_alone == is_alone]:
            yield f"{where}: {_names(these)}"


def _names(advice: Iterable[Advice]) -> str:
    """In words; "leader.damping" is that of one arm of a pair."""
    parts = (item.parameter.rpartition(".") for item in advice)
    return ", ".join(in_words(key) + (f" of the {arm}" if arm else "") for arm, _, key in parts)
