"""A picture under a tab: what it is, when it is drawn, and what it asks of its page."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, NamedTuple, Protocol

from panel.pane import Bokeh

from zwidth.errors import InputError
from zwidth.passivity.verdict import Verdict
from zwidth.show.explorer.controls import Control, read_entry
from zwidth.show.explorer.form import Event, Form, Words
from zwidth.show.explorer.state import State
from zwidth.show.explorer.working import Answer
from zwidth.showing import Html, element


class Asked(Protocol):
    """What a picture asks of its page."""

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

    Parameters
    ----------
    key, name
        In the address, and on the tab.
    parts
        From above.
    moved
        Draws what follows a move.
    released
        Has what takes longer computed.
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
