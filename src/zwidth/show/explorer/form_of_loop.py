"""The groups of controls of a loop, as the page shows them from above."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

from zwidth.model.device import catalogue
from zwidth.model.rendering import LAWS
from zwidth.model.specification.environments import TYPES
from zwidth.model.specification.read import Specification
from zwidth.show.explorer import starts
from zwidth.show.explorer.controls import Control, device_controls, environment_controls, law_controls
from zwidth.show.explorer.form import button, choice, flag, group, shown, upload
from zwidth.show.explorer.state import State

DOWNLOADS = {"toml": "The loop as TOML", "json": "The verdict as JSON", "report": "The report as a page"}

MARK = "nobody's measurement: the page begins with it, set your own"
"""Below a number of the device that nobody gave."""


def controls_of(state: State, loop: Specification) -> Iterator[Control]:
    """Every parameter of a loop."""
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
    return [
        group("Device", [_devices(name), upload("file", "or a TOML file"), *under("device.")]),
        group("More of the device", under("device.", more=True), folded=True),
        group("Environment", [_environments(state), *under("environment.")]),
        *laws,
        group("Laws in the chain", _boxes(state), folded=True),
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


def _boxes(state: State) -> list[dict[str, Any]]:
    """Every law, on or off."""
    on = {str(law["type"]) for law in state.laws}
    return [flag(f"with.{name}", _spoken(name), law.meaning, name in on) for name, law in LAWS.items()]


def _spoken(name: str) -> str:
    return name.replace("-", " ")
