"""Every parameter of a loop as a control, made from the fields of the classes: nothing is typed twice.

A number has a slider and an entry; a word a list to choose from; true or false a box; what is none of these,
such as the coefficients of H(z), an entry as TOML has it.
"""

from __future__ import annotations

import tomllib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from decimal import Decimal
from types import MappingProxyType
from typing import Any, Literal

from zwidth.errors import InputError
from zwidth.model.device import Device, Transmission
from zwidth.model.kind import Kind
from zwidth.model.rendering import LAWS
from zwidth.model.specification.environments import TYPES
from zwidth.model.specification.table import quoted
from zwidth.model.specification.values import FILTERS
from zwidth.model.specification.write import toml
from zwidth.quantity.exact import Exact, Interval
from zwidth.quantity.glossary import GLOSSARY, Quantity
from zwidth.quantity.parameter import Parameter, parameters_of
from zwidth.quantity.spoken import spoken
from zwidth.quantity.text import in_words, shown, unit_text
from zwidth.show.explorer.state import Scale, State, Values, scale_of, usual

Sort = Literal["number", "word", "flag", "text"]

_SMALL = ("rad", "N*m", "rad/s")
"""Units whose numbers have a prefix where they are small."""

_FIRST = ("damping", "coulomb_friction", "resolution", "sample_period", "delay")
"""Of a device what a verdict depends on."""


_FILTER_BEGINS: Mapping[str, Mapping[str, object]] = MappingProxyType(
    {
        "window": {"samples": 2},
        "one-pole": {"time_constant": "2 ms"},
        "filter": {"numerator": [1000, -1000], "denominator": [1, 0]},
    }
)
"""Numbers of a filter of the velocity when it is chosen."""


@dataclass(frozen=True)
class Control:
    """One parameter as the page shows it.

    `path`: where it stands, as `State.changed` takes it.
    `text`: the value as it is typed; "" where none is given.
    `scale`: of a number, what its slider stands for.
    `place`: where the slider is, 0 to 1.
    `words`: that may be chosen.
    `required`: False where it may be left out.
    `more`: True for what a verdict does not depend on.
    """

    path: str
    sort: Sort
    label: str
    unit: str = ""
    meaning: str = ""
    text: str = ""
    scale: Scale | None = None
    place: float = 0.0
    words: tuple[str, ...] = ()
    required: bool = True
    more: bool = False

    def said(self, share: float) -> str:
        """What a place of the slider says, with its unit, as a specification reads it."""
        assert self.scale is not None
        factor, unit = spoken(self.unit)
        return f"{self.scale.value(share) * factor:.12g} {unit}".strip()

    def place_of(self, other: Control) -> float:
        """Where the number of another control stands on the slider of this one."""
        if self.scale is None or other.scale is None:
            return other.place
        return self.scale.share(other.scale.value(other.place))


def device_controls(state: State, device: Device) -> tuple[Control, ...]:
    """Those of a device; the sample period as a rate."""
    found = []
    for key, own in parameters_of(Device).items():
        more = key not in _FIRST
        name = "rate" if key == "sample_period" else key
        path = "inertia" if key == "mass" and device.motion == "rotary" else name
        value = getattr(device, name)
        quantity = GLOSSARY[name]
        shape = own._replace(quantity=quantity, required=name in ("damping", "rate"))
        given = None if key in device.assumed else value
        bound = "> 0" if name == "rate" else own.bound
        label = in_words(path, device.motion)
        found.append(_number(f"device.{path}", label, shape, given, device.motion, bound, more))
    between = device.transmission
    for key, own in parameters_of(Transmission).items() if between is not None else ():
        if own.is_number:
            path, label = f"device.transmission.{key}", f"transmission: {in_words(key)}"
            given = getattr(between, key)
            found.append(_number(path, label, own, given, device.motion, own.bound, False))
    order = [f"device.{'rate' if key == 'sample_period' else key}" for key in _FIRST]
    return tuple(sorted(found, key=lambda one: order.index(one.path) if one.path in order else len(order)))


def environment_controls(state: State, environment: Any, motion: str) -> tuple[Control, ...]:
    """Those of an environment, and of the one behind a coupling."""
    return tuple(_of_table("environment", state.environment, TYPES, environment, motion))


def law_controls(state: State, number: int, law: Any, motion: str) -> tuple[Control, ...]:
    """Those of a law in the chain, the first of which has the number 1."""
    return tuple(_of_table(f"law.{number}", state.laws[number - 1], LAWS, law, motion))


def _of_table(
    path: str, values: Values, kinds: Mapping[str, Kind], thing: Any, motion: str
) -> Iterator[Control]:
    for key, own in kinds[str(values["type"])].keys.items():
        here, value = f"{path}.{key}", getattr(thing, key)
        if own.form == "velocity filter":
            yield from _of_filter(here, _label(key, own, motion), own, values[key], value)
        elif own.form == "environment":
            inner = values[key]
            assert isinstance(inner, Mapping)
            yield from _of_table(here, inner, kinds, value, motion)
        elif own.is_number and not isinstance(value, str):
            yield _number(here, _label(key, own, motion), own, value, motion, own.bound)
        else:
            yield _else(here, key, own, values.get(key), motion)


def _of_filter(path: str, label: str, own: Parameter, table: object, value: Any) -> Iterator[Control]:
    assert isinstance(table, Mapping)
    name = str(table["type"])
    yield Control(path, "word", label, meaning=own.meaning, text=name, words=tuple(FILTERS))
    for key in FILTERS[name]:
        if key not in table:
            continue  # a one-pole filter has a time constant or a cutoff
        here, words = f"{path}.{key}", f"{in_words(key)} of the filter"
        if name == "filter":
            meaning = "coefficients, the highest power of z first"
            yield Control(here, "text", words, meaning=meaning, text=toml(table[key]))
            continue
        unit = "s" if key == "time_constant" else "1"
        quantity = Quantity(key, "", unit, unit, words)
        number = own._replace(quantity=quantity, form="uncertain", required=True, bound="> 0")
        yield number_control(here, number, getattr(value, key), "linear", words)


def _label(key: str, own: Parameter, motion: str) -> str:
    """A key as words; of an environment `damping` is virtual, as on the command line."""
    return in_words(own.quantity.name if key == "damping" and own.quantity.name in GLOSSARY else key, motion)


def number_control(path: str, own: Parameter, value: Any, motion: str, label: str = "") -> Control:
    """A number that stands alone, such as one of a hand; `value` None where it is not given."""
    return _number(path, label or _label(path.rpartition(".")[2], own, motion), own, value, motion, own.bound)


def _number(
    path: str, label: str, own: Parameter, value: Any, motion: str, bound: str, more: bool = False
) -> Control:
    unit = own.unit_for(motion)
    known = isinstance(value, (Exact, int, float)) and not isinstance(value, bool)
    number = float(value) if known else None
    whole = isinstance(value, int)
    scale = scale_of(number, unit, bound != "> 0" and not whole, whole)
    symbol, meaning = own.quantity.symbol, in_words(own.meaning, motion)
    return Control(
        path, "number",
        label=label,
        unit="" if unit == "1" else unit,
        meaning=f"{symbol}: {meaning}" if symbol else meaning,
        text=typed(value, unit),
        scale=scale,
        place=scale.share(usual(unit) if number is None else number),
        required=own.required,
        more=more,
    )  # fmt: skip


def typed(value: Any, unit: str) -> str:
    """A number with its unit as a person would type it, to six digits; "" where there is none."""
    if value is None:
        return ""
    if isinstance(value, Interval):
        factor, told = spoken(unit)
        ends = (float(end) * factor for end in (value.low, value.high))
        return f"{' .. '.join(f'{end:.6g}' for end in ends)} {unit_text(told)}".strip()
    return shown(float(value), unit, 6) if unit in _SMALL else shown(value, unit, 6)


def _else(path: str, key: str, own: Parameter, value: object, motion: str) -> Control:
    """A word, a flag, or a text as TOML has it."""
    label, meaning = in_words(key, motion), in_words(own.meaning, motion)
    if own.form == "flag":
        return Control(path, "flag", label, meaning=meaning, text="true" if value is True else "false")
    if own.form == "word" or own.words:
        word = str(value) if isinstance(value, str) else own.words[0]
        return Control(path, "word", label, meaning=meaning, text=word, words=own.words)
    text = "" if value is None else value if isinstance(value, str) else toml(value)
    return Control(path, "text", label, meaning=meaning, text=text, required=own.required)


def read_entry(control: Control, text: str) -> object:
    """What was typed, as `State.changed` takes it; None where the entry was emptied."""
    text = text.strip()
    if len(text) > 4000:
        raise InputError(f"{control.label}: more than 4000 characters; give it in a file")
    if not text:
        if control.required:
            raise InputError(f"{control.label} is needed: no verdict exists without it")
        return None
    if control.sort == "flag":
        return text == "true"
    if control.path.endswith("velocity_filter"):
        return {"type": text, **_FILTER_BEGINS.get(text, {})}
    if control.sort == "text" and text.startswith(("[", "{")):
        try:
            return tomllib.loads(f"value = {text}", parse_float=Decimal)["value"]
        except (ValueError, ArithmeticError, RecursionError):
            raise InputError(
                f"{control.label}: {quoted(text)} is no list and no table as TOML has them"
            ) from None
    return text
