"""A loop in lines of a report: device and environment, each in one, and what to change or what is left."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import chain

from rich.text import Text

from zwidth.cli.output import GLUE as GLUE
from zwidth.cli.page import items
from zwidth.model.device import Device, Transmission
from zwidth.model.environment import Wall
from zwidth.model.environment.environment import Environment
from zwidth.model.kind import name_of
from zwidth.model.specification.environments import TYPES
from zwidth.model.specification.table import plain
from zwidth.passivity.advice import Advice, in_lines
from zwidth.quantity.exact import Exact, Interval
from zwidth.quantity.glossary import GLOSSARY, Quantity
from zwidth.quantity.parameter import Parameter, parameters_of
from zwidth.quantity.text import shown

_OF_A_DEVICE = ("damping", "coulomb_friction", "resolution", "sample_period", "delay")
"""What a verdict depends on."""

_SHORT = ("environment", "flag", "velocity filter", "word")


def device_line(device: Device) -> str:
    """The device's name and the numbers that a verdict depends on."""
    name = plain(device.name, 40) if device.name not in ("", "device") else f"{device.motion} device"
    values = device.parameters()
    parts = [_named(GLOSSARY[key], values[key], device.motion) for key in _OF_A_DEVICE if values.get(key)]
    return f"{name}: {', '.join(parts)}{_between(device.transmission, device.motion)}"


def _between(given: Transmission | None, motion: str) -> str:
    if given is None:
        return ""
    own = parameters_of(Transmission)
    parts = [_named(own[key].quantity, value, motion) for key, value in given.parameters().items() if value]
    where = [] if given.encoder == "motor" else ["encoder at the handle"]
    return f"; transmission: {', '.join([*parts, *where]) or 'unknown'}"


def environment_line(environment: Environment, motion: str) -> str:
    """The environment's type and its parameters."""
    found = name_of(environment, TYPES)
    if found is None or not all(map(_is_short, TYPES[found].keys.values())):
        return environment.describe(motion)
    parts = [_part(environment, name, key, motion) for name, key in TYPES[found].keys.items()]
    return f"{found.replace('-', ' ')}: {', '.join(p for p in parts if p)}"


def _is_short(own: Parameter) -> bool:
    """True for a number of the glossary, and what is said in a word or two."""
    return own.quantity.name in GLOSSARY if own.is_number else own.form in _SHORT


def _part(environment: Environment, name: str, key: Parameter, motion: str) -> str:
    value = getattr(environment, name)
    if key.is_number:
        return _named(GLOSSARY[key.quantity.name], value, motion) if value or key.required else ""
    if key.form == "environment":
        return f"around {environment_line(value, motion)}"
    if key.form == "flag":
        return "never pulls" if value else ""
    if isinstance(environment, Wall):
        return environment.velocity_filter.describe() if environment.damping else ""
    return f"{value} {name}"


def _named(entry: Quantity, value: Exact | Interval, motion: str) -> str:
    return f"{entry.symbol} = {shown(value, entry.unit_for(motion), 6)}".replace(" ", GLUE)


_FEW = 3


def advice_rows(advice: Iterable[Advice], passive: bool, claim: str) -> Iterator[tuple[str, str]]:
    """The few that are changed most easily, as (name, text), less that in the claim; each alone does it."""
    told = in_lines(advice, passive)
    texts = [told.at_limit, *told.changes] if told.at_limit else [*told.changes]
    if not texts and told.useless:
        texts = [told.useless]
    for place, text in enumerate(texts[:_FEW]):
        if text not in claim:
            yield "or" if place else "slack" if passive else "change", text


def advice_section(advice: Iterable[Advice], passive: bool) -> tuple[str, Iterator[Text]]:
    """The title and the lines of what to change, or of what is left."""
    told = in_lines(advice, passive)
    return told.title, chain(items(told.useful), items([told.useless] if told.useless else [], "dim"))
