"""A picture under a tab: what it is, when it is drawn, and what it asks of its page."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from types import MappingProxyType
from typing import Any, NamedTuple, Protocol

from panel.pane import Bokeh

from zwidth.errors import InputError
from zwidth.passivity.linear_verdict import LinearVerdict
from zwidth.passivity.scope import COLOUR
from zwidth.passivity.verdict import Verdict
from zwidth.quantity.text import unit_text
from zwidth.show.explorer.controls import Control, read_entry
from zwidth.show.explorer.form import Event, Form, Words
from zwidth.show.explorer.state import State
from zwidth.show.explorer.working import Answer
from zwidth.showing import Html, Lines, Table, element, join


class Asked(Protocol):
    state: State
    verdict: Verdict | None

    def compute(self, kind: str, work: Callable[..., Any], then: Callable[[Answer], None]) -> None:
        """Have something computed of the state beside the page."""

    def listen(self, form: Form, hear: Callable[[Event], Mapping[str, Any]]) -> None:
        """Have the events of a form answered."""

    def keep(self, state: State) -> Mapping[str, Any]:
        """Take another state whose loop is the same; what is told to the page."""


class View(NamedTuple):
    """A picture under a tab.

    `key`, `name`: in the address, and on the tab.
    `moved`: draws what follows a move.
    `released`: has what takes longer computed.
    """

    key: str
    name: str
    parts: list[Any]
    moved: Callable[[], None]
    released: Callable[[], None]


def said(target: Words, text: str | Html) -> None:
    """Say it below a picture."""
    target.html = str(element("p", text))


def wide(figure: Any) -> Any:
    """A picture as wide as there is room."""
    return Bokeh(figure, sizing_mode="stretch_width")


def given(controls: Mapping[str, Control], event: Event) -> tuple[Control, object]:
    """Which control an event is of, and its value as `State.changed` takes it."""
    path, value = str(event.get("path")), event.get("value")
    control = controls.get(path)
    if control is None:
        raise InputError(f"there is no {path[:60]!r} on this page any more")
    if event.get("kind") != "move":
        return control, read_entry(control, str(value))
    if control.scale is None or not isinstance(value, int | float):
        raise InputError("a slider stands for a number")
    return control, control.said(float(value))


# The verdict in words: the outcome, what is claimed and of what, the limit, and what to change.


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


def head(verdict: Verdict | None, note: str = "", doubts: Iterable[str] = ()) -> Html:
    """Outcome and claim; None while it is being worked out.

    `note`: a line below, such as that more is being worked out.
    `doubts`: why it is not to be taken for the answer.
    """
    marks = join(*(element("p", line, **{"class": "bad"}) for line in doubts))
    quiet = element("p", note, **{"class": "quiet"}) if note else join()
    said = (quiet or element("p", WAITING)) if verdict is None else join(headline(verdict), quiet)
    return join(marks, said)


def details(verdict: Verdict | None) -> Html:
    """The numbers, what to change, and what the claim covers."""
    if verdict is None:
        return join()
    numbers = element("div", Table(rows=verdict.rows()).html, **{"class": "numbers"})
    return join(numbers, _advice(verdict), Lines(verdict.small_print(), "What this covers").html)


def _advice(verdict: Verdict) -> Html:
    if not verdict.advice:
        return join()
    title, *lines = verdict.advised()
    heading = element("h3", f"{str(title)[:1].upper()}{str(title)[1:]}")
    return join(heading, *(line.html for line in lines if isinstance(line, Lines)))


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
