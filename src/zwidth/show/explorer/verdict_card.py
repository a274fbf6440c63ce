"""The verdict in words: the outcome, what is claimed and of what, the limit, and what to change.

Every sentence is the verdict's own.
"""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Any

from zwidth.passivity.linear_verdict import LinearVerdict
from zwidth.passivity.scope import COLOUR
from zwidth.passivity.verdict import Verdict
from zwidth.quantity.text import unit_text
from zwidth.showing import Html, Lines, Table, element, join

WAITING = "Working it out …"


def headline(answer: Any) -> Html:
    """Outcome and claim of anything that has both."""
    badge = element(
        "span", answer.outcome, style=f"background:{COLOUR[answer.outcome]}", **{"class": "badge"}
    )
    return join(element("p", badge), element("p", answer.claim, **{"class": "claim"}))


def not_measured(begun: Mapping[str, str]) -> list[str]:
    """A sentence about each number of the device that nobody gave, {"damping": "0.1 N*s/m"}."""
    return [
        f"The {key} {unit_text(text)} is nobody's measurement: none is given, and the page begins with it. "
        "The verdict is of that number; set your own."
        for key, text in begun.items()
    ]


def head(verdict: Verdict | None, note: str = "", begun: Mapping[str, str] = MappingProxyType({})) -> Html:
    """Outcome and claim; None while it is being worked out.

    Parameters
    ----------
    verdict
        What `zwidth.check` said.
    note
        A line below, such as that more is being worked out.
    begun
        Numbers of the device that nobody gave.
    """
    marks = join(*(element("p", line, **{"class": "bad"}) for line in not_measured(begun)))
    quiet = element("p", note, **{"class": "quiet"}) if note else join()
    said = (quiet or element("p", WAITING)) if verdict is None else join(headline(verdict), quiet)
    return join(marks, said)


def details(verdict: Verdict | None) -> Html:
    """The numbers, what to change, and what the claim covers."""
    if verdict is None:
        return join()
    return join(_numbers(verdict), _advice(verdict), _scope(verdict))


def _numbers(verdict: Verdict) -> Html:
    return element("div", Table(rows=verdict.rows()).html, **{"class": "numbers"})


def _advice(verdict: Verdict) -> Html:
    if not verdict.advice:
        return join()
    title, *lines = verdict.advised()
    heading = element("h3", f"{str(title)[:1].upper()}{str(title)[1:]}")
    return join(heading, *(line.html for line in lines if isinstance(line, Lines)))


def _scope(verdict: Verdict) -> Html:
    """What the claim covers and takes for granted."""
    return Lines(verdict.small_print(), "What this covers").html


def badge(verdict: Verdict | None, note: str = "", begun: Mapping[str, str] = MappingProxyType({})) -> Html:
    """The outcome in a line, for where there is little room."""
    if verdict is None:
        return element("p", note or WAITING, **{"class": "quiet"})
    word = element(
        "span", verdict.outcome, style=f"background:{COLOUR[verdict.outcome]}", **{"class": "badge"}
    )
    limit = f" {verdict.limit}" if isinstance(verdict, LinearVerdict) else ""
    mark = element("span", f" {' and '.join(begun)} not measured", **{"class": "bad"}) if begun else join()
    return element("p", word, limit, mark)
