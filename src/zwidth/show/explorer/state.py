"""The loop on the page as plain tables, which a URL can hold: every move is a new one.

    ?device.damping=0.15 N*s/m&device.rate=1 kHz&environment.type=wall&environment.stiffness=300 N/m

The page answers in the angle of the question, which stands in the address too: answers.angle=deg.

The keys are those of a specification with the name of their table before them, the values its texts with
their units; a list or a table is written as TOML.  All of it is read by the specification's own reader.
"""

from __future__ import annotations

import tomllib
from collections.abc import Container, Iterable, Iterator, Mapping, Sequence
from copy import deepcopy
from dataclasses import dataclass, field, replace
from decimal import Decimal
from math import isfinite, log
from types import MappingProxyType
from typing import Any, NamedTuple
from urllib.parse import quote_plus, urlencode

from zwidth.errors import InputError
from zwidth.model.device import Device, catalogue
from zwidth.model.device.rotary import ROTARY
from zwidth.model.environment import Environment
from zwidth.model.specification.environments import build_environment
from zwidth.model.specification.laws import ROW, with_laws
from zwidth.model.specification.read import WITH_LAWS, Specification, build_device, keep_axis, tables_of
from zwidth.model.specification.table import Table, plain, quoted
from zwidth.model.specification.write import tables, toml
from zwidth.quantity.glossary import GLOSSARY
from zwidth.quantity.spoken import angles_in, answers_in

LONGEST_QUERY = 12_000
"""Characters of a URL's query: a page of parameters is a tenth of it."""

LARGEST_FILE = 64 * 1024
"""Bytes of a file that is given to the page."""

BEGUN = "begun"
"""Names the table of those numbers of the device that nobody gave: the page begins with them, and says so."""

ANSWERS = "answers"
"""Names the table with the `angle` in which the page answers."""

EXTRAS = ("coupling", "operator", BEGUN, ANSWERS)
"""Tables beside those of the loop: what joins two of its arms, the hand, `BEGUN` and `ANSWERS`."""

Values = Mapping[str, object]


@dataclass(frozen=True)
class State:
    """A loop in tables, each quantity a text with its unit.

    `device`, `environment`, `laws`: as of a specification; the laws in a chain from the environment to the
        actuator.
    `extras`: what the page is asked beside the loop, by the name of its table: one of `EXTRAS`.
    """

    device: Values
    environment: Values
    laws: tuple[Values, ...] = ()
    extras: Mapping[str, Values] = field(default_factory=dict)

    @staticmethod
    def of(device: Device, environment: Environment) -> State:
        """The tables of a loop."""
        return State(*tables(device, environment))

    def loop(self) -> Specification:
        """Device, and environment behind its laws."""
        device = build_device(Table("device", deepcopy(dict(self.device))))
        environment = build_environment(Table("environment", deepcopy(dict(self.environment))), device.motion)
        row = Table("law", {ROW: deepcopy([*map(dict, self.laws)])}) if self.laws else None
        return Specification(device, with_laws(environment, row, None, device.motion))

    def settled(self) -> State:
        """The same loop with every parameter that it has, in the words of `tables`."""
        loop = self.loop()
        return replace(State.of(loop.device, loop.environment), extras=self.extras)

    @property
    def motion(self) -> str:
        """ "linear" or "rotary"."""
        return str(self.device.get("motion", "linear"))

    def with_extra(self, name: str, values: Values) -> State:
        """With another table beside those of the loop."""
        return replace(self, extras={**self.extras, name: values})

    @property
    def begun(self) -> Mapping[str, str]:
        """Damping or rate of the device where nobody gave it, as the page began with it."""
        found = self.extras.get(BEGUN, {})
        return {key: str(found[key]) for key in ("damping", "rate") if key in found}

    def with_begun(self, begun: Mapping[str, str]) -> State:
        """With these numbers of the device marked as nobody's measurement, and no others."""
        extras = {name: values for name, values in self.extras.items() if name != BEGUN}
        return replace(self, extras={**extras, BEGUN: dict(begun)} if begun else extras)

    @property
    def angles(self) -> tuple[str, ...]:
        """In which angles the page answers: deg, turn, rpm; none are radians."""
        return tuple(str(self.extras.get(ANSWERS, {}).get("angle", "")).split())

    def with_angles(self, typed: Iterable[str]) -> State:
        """Answering in these angles, if there are any; in radians if they are all that was typed."""
        kept = sorted(set(typed) - {"rad"})
        if not kept and not set(typed):
            return self
        extras = {name: values for name, values in self.extras.items() if name != ANSWERS}
        return replace(self, extras={**extras, ANSWERS: {"angle": " ".join(kept)}} if kept else extras)

    def changed(self, path: str, value: object) -> State:
        """With one value in the place of another; None takes it out.

        `path`: "device.damping", "environment.environment.stiffness", "law.1.samples", "coupling.link_delay".
        `value`: as a specification has it: a text with its unit, a flag, a list or a table.
        """
        kind, *keys = path.split(".")
        if kind == "device":
            device = _put(self.device, keys, value)
            if keys == ["rate"]:
                device.pop("sample_period", None)
            begun = {key: text for key, text in self.begun.items() if key != keys[0]}
            return replace(self, device=device).with_begun(begun)
        if kind == "environment":
            return replace(self, environment=_put(self.environment, keys, value))
        if kind == "law":
            laws = list(self.laws)
            at = _place(keys, len(laws))
            laws[at] = _put(laws[at], keys[1:], value)
            return replace(self, laws=tuple(laws))
        if kind in EXTRAS:
            extra = _put(self.extras.get(kind, {}), keys, value)
            return replace(self, extras={**self.extras, kind: extra})
        raise InputError(f"there is no parameter {quoted(path)} on this page")

    def query(self) -> str:
        """The state as the query of a URL, without the question mark."""
        return urlencode([*self._pairs()], quote_via=lambda text, *_: quote_plus(text, safe='*/[]{},"= ·'))

    def _pairs(self) -> Iterator[tuple[str, str]]:
        numbered = [(f"law.{n}", law) for n, law in enumerate(self.laws, 1)]
        for table, values in (
            ("device", self.device), ("environment", self.environment), *numbered, *self.extras.items()
        ):  # fmt: skip
            for key, value in values.items():
                yield f"{table}.{key}", value if isinstance(value, str) else toml(value)


def _put(values: Values, keys: Sequence[str], value: object) -> dict[str, Any]:
    if not keys:
        raise InputError("a parameter has a name behind the name of its table")
    changed = dict(values)
    key, *inner = keys
    if inner:
        within = changed.get(key, {})
        if not isinstance(within, Mapping):
            raise InputError(f"{plain(key)} is no table with a {plain(inner[0])} in it")
        changed[key] = _put(within, inner, value)
    elif value is None:
        changed.pop(key, None)
    else:
        changed[key] = value
    return changed


def _place(keys: Sequence[str], count: int) -> int:
    number = keys[0] if keys else ""
    if not number.isdecimal() or len(number) > 2 or not 1 <= int(number) <= count:
        raise InputError(f"there is no law {quoted(number)} in this chain of {count}")
    return int(number) - 1


def from_query(query: Sequence[tuple[str, str]]) -> State:
    """The state that a URL holds.

    `query`: its keys and values, decoded, in order.
    """
    if sum(len(key) + len(value) for key, value in query) > LONGEST_QUERY:
        raise InputError(f"the address is longer than {LONGEST_QUERY} characters; give the loop as a file")
    found: dict[str, dict[str, object]] = {}
    for key, text in query:
        head, dot, name = key.rpartition(".")
        if not dot or not name or not _is_table(head):
            raise InputError(
                f"the address has {quoted(key)}, which is no parameter; parameters are written as in "
                "device.damping, environment.stiffness, law.1.type, coupling.link_delay or operator.type"
            )
        if name in found.setdefault(head, {}):
            raise InputError(f"the address has {quoted(key)} twice; which one is meant?")
        found[head][name] = _value(key, text)
    laws = _numbered({head: values for head, values in found.items() if head.startswith("law.")})
    extras = {name: found[name] for name in EXTRAS if name in found}
    for name in ("device", "environment"):
        if name not in found:
            raise InputError(f"the address has no {name}: give a {name}.… as well")
    state = State(found["device"], found["environment"], laws, extras)
    if ANSWERS not in extras:
        state = state.with_angles(angles_in([state.device, state.environment, *laws]))
    with answers_in(*state.angles):  # what is no angle is refused
        return state.settled()


def _is_table(head: str) -> bool:
    kind, _, number = head.partition(".")
    if kind == "law":
        return number.isdecimal() and len(number) <= 2
    return head in ("device", "environment", *EXTRAS)


def _numbered(found: Mapping[str, Values]) -> tuple[Values, ...]:
    numbers = sorted(int(head.removeprefix("law.")) for head in found)
    if numbers != list(range(1, len(numbers) + 1)):
        raise InputError("the laws in the address are numbered law.1, law.2, … without a gap")
    return tuple(found[f"law.{n}"] for n in numbers)


def _value(key: str, text: str) -> object:
    """A text as it stands; what begins like a list, a table or a flag is TOML."""
    if text in ("true", "false"):
        return text == "true"
    if not text.startswith(("[", "{")):
        return text
    try:
        return tomllib.loads(f"value = {text}", parse_float=Decimal)["value"]
    except (ValueError, ArithmeticError, RecursionError):
        raise InputError(f"{plain(key)}: {quoted(text)} is no list and no table as TOML has them") from None


class Given(NamedTuple):
    """What is in a file.

    `state`: the loop; None where there is no environment.
    `begun`: numbers of the device that the file does not give, as they begin.
    """

    state: State | None
    device: Device
    begun: Mapping[str, str]


def from_file(text: str, name: str, shown: State) -> Given:
    """The loop of a specification, or its device or its environment alone.

    What the device lacks begins with a usual number; an environment alone is put on the device that is shown.

    `text`: what is in the file.
    `name`: of the file, for messages.
    """
    if len(text.encode("utf-8", "replace")) > LARGEST_FILE:
        raise InputError(
            f"{quoted(name)} is larger than {LARGEST_FILE // 1024} kB; a specification is a page of text"
        )
    found = tables_of(text, plain(name), WITH_LAWS)
    if not found.keys() & {"device", "environment"}:
        raise InputError(f"{quoted(name)} has neither a [device] nor an [environment] table")
    if "device" not in found:
        return _rendered(found, shown)
    if not {"name", "catalogue"} & set(found["device"].values):
        found["device"].values["name"] = plain(name).removesuffix(".toml")
    if "environment" in found:
        keep_axis(found["device"], found["environment"].values)
    begun = completed(found["device"])
    device = build_device(found["device"])
    if "environment" not in found:
        return Given(None, device, begun)
    row = found.get("law")
    environment = build_environment(found["environment"], device.motion)
    state = State.of(device, with_laws(environment, row, None, device.motion))
    typed = angles_in([table.values for table in found.values()])
    return Given(state.with_begun(begun).with_angles(typed), device, begun)


def _rendered(found: Mapping[str, Table], shown: State) -> Given:
    device = shown.loop().device
    environment = build_environment(found["environment"], device.motion)
    made = State.of(device, with_laws(environment, found.get("law"), None, device.motion))
    state = replace(shown, environment=made.environment, laws=made.laws)
    return Given(state, device, shown.begun)


def catalogued(name: str) -> Device:
    """A device of the catalogue; where no source gives damping or rate, with one to begin with."""
    return catalogue.device(name, **lacking_of(name))


def lacking_of(name: str) -> dict[str, str]:
    """What no source gives of a device of the catalogue and a loop cannot do without, to begin with."""
    found = catalogue.entry(name)
    return _lacking(found.known(), found.motion)


def completed(device: Table, typed: Container[str] = ()) -> dict[str, str]:
    """Put into a table of a device what it lacks and no parameter of `typed` gives; what that is."""
    name = device.values.get("catalogue")
    known = set(device.values)
    turns = device.values.get("motion") == "rotary" or any(key in known for key in ROTARY)
    if isinstance(name, str):
        known |= set(catalogue.entry(name).known())
        turns |= catalogue.entry(name).motion == "rotary"
    known |= {key for key in ("damping", "rate", "sample_period") if key in typed}
    lacking = _lacking(known, "rotary" if turns else "linear")
    device.values.update(lacking)
    return lacking


def _lacking(known: Container[str], motion: str) -> dict[str, str]:
    unit = GLOSSARY["damping"].unit_for(motion)
    lacking = {} if "damping" in known else {"damping": f"{usual(unit):g} {unit}"}
    if "rate" not in known and "sample_period" not in known:
        lacking["rate"] = UNKNOWN_RATE
    return lacking


UNKNOWN_RATE = "1 kHz"
"""Where a slider begins whose number no source gives; the page says that it is nobody's measurement."""


# Where a slider stands for a number: decades along its length, with 0 at the very left.


AROUND = 30.0
"""A number that is given stands in the middle, with so many times less and more beside it."""

_LINEAR = {
    "1": (0.01, 1.0, 100.0), "N*s/m": (1e-3, 0.1, 100.0), "N": (1e-3, 0.1, 100.0), "m": (1e-7, 1e-5, 0.01),
    "N/m": (1.0, 200.0, 1e5), "kg": (1e-3, 0.1, 10.0), "s/m": (0.01, 1.0, 100.0), "m/s": (1e-3, 0.2, 10.0),
    "s": (1e-5, 1e-3, 0.1), "Hz": (50.0, 1000.0, 20e3), "J": (1e-5, 1e-3, 1.0), "N/s": (1.0, 1e3, 1e6),
    "H": (1e-5, 1e-3, 0.1), "V": (1.0, 24.0, 100.0), "A": (0.1, 3.0, 50.0), "s/m^2": (0.01, 1.0, 1e3),
}  # fmt: skip
_ROTARY = {
    "N*m*s/rad": (1e-6, 1e-3, 1.0), "N*m": (1e-4, 5e-3, 10.0), "rad": (1e-6, 1e-3, 0.1),
    "N*m/rad": (1e-3, 0.5, 1e3), "kg*m^2": (1e-7, 1e-4, 0.1), "s/rad": (1e-3, 0.1, 10.0),
    "rad/s": (0.01, 2.0, 100.0), "N*m/s": (0.01, 10.0, 1e4),
}  # fmt: skip

SPANS: Mapping[str, tuple[float, float, float]] = MappingProxyType({**_LINEAR, **_ROTARY})
"""By unit: the least, a usual one, and the most that a slider reaches where no number is given."""

_ELSE = (1e-3, 1.0, 1e3)


class Scale(NamedTuple):
    """What a slider's length stands for.

    `low`, `high`: > 0, of the share 0 and 1 of its length.
    `has_zero`: True where the very left is nothing.
    `whole`: True for a count.
    """

    low: float
    high: float
    has_zero: bool
    whole: bool = False

    def share(self, value: float) -> float:
        """Where a number stands, 0 to 1; one that is not on it stands at the nearer end."""
        if value <= 0 or not isfinite(value):
            return 0.0
        return min(max(log(value / self.low) / log(self.high / self.low), 0.0), 1.0)

    def value(self, share: float) -> float:
        """What stands at a share of the length, to three digits."""
        if not isfinite(share) or (share <= 0 and self.has_zero):
            return 0.0 if self.has_zero else self.low
        found = self.low * (self.high / self.low) ** min(share, 1.0)
        return float(max(1, round(found))) if self.whole else float(f"{found:.3g}")


def scale_of(value: float | None, unit: str, has_zero: bool, whole: bool = False) -> Scale:
    """The scale around a number; by its unit where there is none, or it is not above 0."""
    if value is None or value <= 0:
        low, _, high = SPANS.get(unit, _ELSE)
    else:
        low, high = value / AROUND, value * AROUND
    return Scale(max(low, 1.0) if whole else low, max(high, 10.0) if whole else high, has_zero, whole)


def usual(unit: str) -> float:
    """A number of this unit to begin with."""
    return SPANS.get(unit, _ELSE)[1]
