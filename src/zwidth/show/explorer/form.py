"""Controls in the browser, and words beside them: what Python says of each, and what comes back.

An event is one change; it is answered before the next is sent (`form.js`).
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Any, ClassVar

import param
from panel.custom import JSComponent

from zwidth.errors import InputError
from zwidth.show.explorer.controls import Control
from zwidth.show.explorer.state import LARGEST_FILE
from zwidth.showing import Html

_HERE = Path(__file__).parent

Event = Mapping[str, Any]

Soon = Callable[[Callable[[], None]], Any]
"""Has something done in the thread of the page, with its document to itself."""


def _read(name: str) -> str:
    return (_HERE / name).read_text(encoding="utf-8")


class Told(JSComponent):  # type: ignore[misc]  # Panel has no types
    """What the browser shows and is told by Python; of the other way `_says` alone is listened to.

    Panel takes whatever is set here for a change by the browser as well, and tends to it while a move waits.
    """

    _says: ClassVar[tuple[str, ...]] = ()

    @property
    def _linked_properties(self) -> tuple[str, ...]:
        return self._says


class Form(Told):
    """Groups of controls; `on_event` is told what is changed."""

    groups = param.List(default=[])
    event = param.Dict(default={})
    views = param.Boolean(default=False)
    told = param.Dict(default={"heard": 0})

    _esm = _read("form.js")
    _says = ("event",)
    _priority_changes = _busy__ignore = ["event"]  # noqa: RUF012  # else each waits 50 ms for others
    _stylesheets = [_read("form.css")]  # noqa: RUF012  # as Panel has it

    def listen(self, hear: Callable[[Event], Mapping[str, Any]], soon: Soon) -> None:
        """Have each event answered, in its turn: `hear` returns what is told to the page."""

        def heed(event: Event) -> None:
            try:
                answer = hear(event)
            except InputError as error:
                answer = {"error": str(error)}
            self.told = {"heard": event["number"], **answer}

        def on_event(change: Any) -> None:
            if isinstance(change.new.get("number"), int):
                soon(partial(heed, change.new))

        self.param.watch(on_event, "event")


class Words(Told):
    """Words that change, told by a screen reader when they do if they are `live`."""

    html = param.String(default="")
    live = param.Boolean(default=False)

    _esm = """
export function render({ model }) {
  const div = document.createElement("div");
  if (model.live) div.setAttribute("aria-live", "polite");
  const draw = () => { if (div.innerHTML !== model.html) div.innerHTML = model.html; };
  model.on("html", draw);
  draw();
  return div;
}
"""
    _stylesheets = [_read("words.css")]  # noqa: RUF012


def words(html: Html, live: bool = False) -> Words:
    """Words that are shown as they are."""
    return Words(html=str(html), live=live, sizing_mode="stretch_width")


def group(title: str, controls: Iterable[Mapping[str, Any]], folded: bool = False) -> dict[str, Any]:
    """Controls under a heading; folded up where they are not needed at first."""
    return {"title": title, "controls": list(controls), "folded": folded}


def shown(control: Control, below: str = "") -> dict[str, Any]:
    """A control as the page takes it, with a line below it until it is set."""
    return {
        "path": control.path,
        "sort": "choice" if control.sort == "word" else control.sort,
        "label": control.label,
        "meaning": control.meaning,
        "text": control.text,
        "place": control.place,
        "required": control.required,
        "below": below,
        "words": [[word, word] for word in control.words],
    }


def choice(
    path: str, label: str, options: Sequence[tuple[str, str]], chosen: str, meaning: str = ""
) -> dict[str, Any]:
    """One of several, each with its words; `meaning` is said below, of the one that is chosen."""
    return {
        "path": path,
        "sort": "choice",
        "label": label,
        "words": [list(o) for o in options],
        "text": chosen,
        "below": meaning,
    }


def flag(path: str, label: str, meaning: str, on: bool) -> dict[str, Any]:
    """On or off."""
    text = "true" if on else "false"
    return {"path": path, "sort": "flag", "label": label, "meaning": meaning, "text": text}


def button(path: str, label: str) -> dict[str, Any]:
    """Something to press."""
    return {"path": path, "sort": "button", "label": label}


def upload(path: str, label: str) -> dict[str, Any]:
    """A file to give."""
    return {"path": path, "sort": "file", "label": label, "largest": LARGEST_FILE}
