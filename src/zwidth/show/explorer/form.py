"""Controls in the browser and words beside them: what Python says of each, what comes back, groups of a loop.

An event is one change; it is answered before the next is sent (`form.js`).
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Any, ClassVar

import param
from panel.custom import JSComponent

from zwidth.errors import InputError
from zwidth.model.device import catalogue
from zwidth.model.rendering import LAWS
from zwidth.model.specification.environments import TYPES
from zwidth.model.specification.read import Specification
from zwidth.show.explorer import starts
from zwidth.show.explorer.controls import Control, device_controls, environment_controls, law_controls
from zwidth.show.explorer.state import LARGEST_FILE, State
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

    def __init__(self, **given: Any) -> None:
        self.refused: dict[str, str] = {}
        """By the path of a control: why what it says cannot be used."""
        self._marked: Callable[[], None] = lambda: None
        super().__init__(**given)

    def draw(self, groups: list[dict[str, Any]]) -> None:
        """Show these controls, none of them refused."""
        self.groups, was, self.refused = groups, self.refused, {}
        if was:
            self._marked()

    def listen(
        self, hear: Callable[[Event], Mapping[str, Any]], soon: Soon, marked: Callable[[], None]
    ) -> None:
        """Have each event answered, in its turn: `hear` returns what is told to the page.

        `marked`: is called when something else is refused than before.
        """
        self._marked = marked

        def heed(event: Event) -> None:
            path, before = str(event.get("path")), {**self.refused}
            try:
                answer = hear(event)
                if event.get("kind") in _SETS:
                    self.refused.pop(path, None)
            except InputError as error:
                paths = {one["path"] for group in self.groups for one in group["controls"]}
                here = event.get("kind") in _SETS and path in paths
                answer = {"error": "" if here else str(error)}
                if here:
                    self.refused[path] = _refusal(str(error), path, event.get("before"))
            self.told = {"heard": event["number"], "refused": {**self.refused}, **answer}
            if self.refused != before:
                marked()

        def on_event(change: Any) -> None:
            if isinstance(change.new.get("number"), int):
                soon(partial(heed, change.new))

        self.param.watch(on_event, "event")


_SETS = ("move", "typed", "choose")
"""Events that set what their control says."""


def _refusal(error: str, path: str, before: Any) -> str:
    """A sentence for beside the control, which ends in what may be typed: what was there before."""
    said = error.removeprefix(f"{path.partition('.')[0]}: ")
    return said if not before or "such as" in said else f"{said}; type a value such as {str(before)[:60]}"


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
    own = ("path", "label", "meaning", "text", "place", "required")
    return {
        **{key: getattr(control, key) for key in own},
        "sort": "choice" if control.sort == "word" else control.sort,
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
    text = "true" if on else "false"
    return {"path": path, "sort": "flag", "label": label, "meaning": meaning, "text": text}


def button(path: str, label: str) -> dict[str, Any]:
    return {"path": path, "sort": "button", "label": label}


def upload(path: str, label: str) -> dict[str, Any]:
    return {"path": path, "sort": "file", "label": label, "largest": LARGEST_FILE}


DOWNLOADS = {"toml": "The loop as TOML", "json": "The verdict as JSON", "report": "The report as a page"}

MARK = "nobody's measurement: the page begins with it, set your own"
"""Below a number of the device that nobody gave."""


def controls_of(state: State, loop: Specification) -> Iterator[Control]:
    motion = loop.device.motion
    laws = getattr(loop.environment, "laws", ())
    met = loop.environment.environment if laws else loop.environment  # type: ignore[attr-defined]
    yield from device_controls(state, loop.device)
    yield from environment_controls(state, met, motion)
    for number, law in enumerate(laws, 1):
        yield from law_controls(state, number, law, motion)


def groups_of(state: State, name: str, controls: Sequence[Control]) -> list[dict[str, Any]]:
    """The groups; `name` is the device's."""

    def under(path: str, more: bool = False) -> list[dict[str, Any]]:
        marks = {f"device.{key}": MARK for key in state.begun}
        return [
            shown(one, marks.get(one.path, ""))
            for one in controls
            if one.path.startswith(path) and one.more == more
        ]

    laws = [
        group(f"Law {number}: {_spoken(str(law['type']))}", under(f"law.{number}."))
        for number, law in enumerate(state.laws, 1)
        if under(f"law.{number}.")
    ]
    on = {str(law["type"]) for law in state.laws}
    boxes = [flag(f"with.{key}", _spoken(key), law.meaning, key in on) for key, law in LAWS.items()]
    return [
        group("Device", [_devices(name), upload("file", "or a TOML file"), *under("device.")]),
        group("More of the device", under("device.", more=True), folded=True),
        group("Environment", [_environments(state), *under("environment.")]),
        *laws,
        group("Laws in the chain", boxes, folded=True),
        group("Take it with you", [button(key, text) for key, text in DOWNLOADS.items()]),
    ]


def _devices(name: str) -> dict[str, Any]:
    options = [(one, catalogue.entry(one).title) for one in catalogue.names()]
    options += [
        (starts.OWN_LINEAR, "a linear device of your own"),
        (starts.OWN_ROTARY, "a rotary device of your own"),
    ]
    if name not in dict(options):
        options.insert(0, (name, name))
    return choice("device", "device", options, name)


def _environments(state: State) -> dict[str, Any]:
    options = [(name, _spoken(name)) for name in TYPES]
    chosen = str(state.environment["type"])
    return choice("environment", "kind", options, chosen, TYPES[chosen].meaning)


def _spoken(name: str) -> str:
    return name.replace("-", " ")
