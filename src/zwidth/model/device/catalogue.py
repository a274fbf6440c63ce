"""The catalogue: real devices, each number with its source.

A value that no source gives is unknown, and stays unknown: a device whose damping nobody has published can be
used once the caller gives one.  Of some the catalogue states a range in its place, and why that range:
`in_range` makes of it a device with intervals, of which a verdict holds for every value, or says which number
to measure first.  `recommended_stiffness` is what a vendor's or driver's authors allow as the largest
stiffness; it is a recommendation, not a dynamic property, and no verdict rests on it.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from decimal import Decimal
from functools import cache
from types import MappingProxyType
from typing import Any, NamedTuple

from zwidth.errors import InputError
from zwidth.missing import suggestion
from zwidth.model.device.device import Device, Motion
from zwidth.model.device.rotary import ROTARY, rotary
from zwidth.quantity.exact import Exact, Interval
from zwidth.quantity.glossary import GLOSSARY
from zwidth.quantity.parameter import parameters_of
from zwidth.quantity.units import parse

PROPERTIES = tuple(
    name for key in parameters_of(Device) for name in ((key, "rate") if key == "sample_period" else (key,))
)
"""The quantities of a `Device`, in the order of a report."""

UNKNOWN = "unknown: no source found"
RECOMMENDATION = "a recommendation of its software, not a measured dynamic property"


class Datum(NamedTuple):
    """One number of the catalogue; `value` is None where no source gives it."""

    value: Exact | None
    unit: str
    source: str


class Range(NamedTuple):
    """Within which a number that nobody published is taken to lie: stated, not measured.

    Parameters
    ----------
    low, high
        The ends, in the unit.
    unit
        SI.
    why
        That range; how to see whether a device lies in it.
    """

    low: Exact
    high: Exact
    unit: str
    why: str

    @property
    def interval(self) -> Interval:
        """The ends as a parameter."""
        return Interval(self.low, self.high)


@dataclass(frozen=True)
class Entry:
    """A device of the catalogue: what is published about it, and by whom; within what the rest may lie."""

    name: str
    title: str
    note: str
    values: Mapping[str, Datum]
    ranges: Mapping[str, Range]
    motion: Motion

    def known(self) -> dict[str, Exact]:
        """The published values that are arguments of `Device`, or of `rotary`."""
        return {k: d.value for k, d in self.values.items() if k in self.properties and d.value is not None}

    @property
    def properties(self) -> tuple[str, ...]:
        """What may be said of it: the quantities of a device, of a rotary one also counts and radius."""
        return PROPERTIES if self.motion == "linear" else (*PROPERTIES, *ROTARY)

    def unit(self, key: str) -> str:
        """The SI unit of one of its quantities."""
        return (ROTARY.get(key) or GLOSSARY[key]).unit_for(self.motion)

    def key(self, key: str) -> str:
        """What a quantity is called here: the mass of a rotary device is an inertia."""
        return "inertia" if key == "mass" and self.motion == "rotary" else key


@dataclass(frozen=True)
class DeviceInRange:
    """A device of the catalogue some of whose numbers, as intervals, are known within a stated range only.

    `ranges` says within which, by parameter of the device.
    """

    device: Device
    ranges: Mapping[str, Range]


def names() -> tuple[str, ...]:
    """The names of all devices in the catalogue."""
    return tuple(_entries())


def entry(name: str) -> Entry:
    """What is published about one device."""
    found = _entries().get(name)
    if found is None:
        raise InputError(f"the catalogue has no device {str(name)[:40]!r}; {suggestion(str(name), names())}")
    return found


def device(name: str, /, **overrides: Any) -> Device:
    """A catalogue device, with some numbers given or replaced.

    Parameters
    ----------
    name
        One of `names()`.
    overrides
        Arguments of `Device`; a text may carry a unit, such as "0.1 N*s/m".

    Raises
    ------
    InputError
        If the name or an argument is not known, or if a number that a verdict
        needs is neither published nor given: it lists them all.
    """
    found = entry(name)
    arguments = _arguments(found, overrides)
    _require(found, arguments)
    return _built(found, arguments)


def in_range(name: str, /, **overrides: Any) -> DeviceInRange:
    """A catalogue device, the stated range in the place of every number that is neither published nor given.

    Parameters
    ----------
    name
        One of `names()`.
    overrides
        As of `device`; what is given needs no range.
    """
    found = entry(name)
    arguments = _arguments(found, overrides)
    said = {_DEVICE_KEY.get(key, key) for key, value in arguments.items() if value is not None}
    ranges = {key: own for key, own in found.ranges.items() if _DEVICE_KEY.get(key, key) not in said}
    arguments.update({key: own.interval for key, own in ranges.items()})
    _require(found, arguments)
    return DeviceInRange(
        _built(found, arguments), MappingProxyType({_DEVICE_KEY.get(k, k): own for k, own in ranges.items()})
    )


_DEVICE_KEY = {"rate": "sample_period", "counts_per_turn": "resolution", "inertia": "mass"}
"""Other names under which a parameter of `Device` is given."""


def _arguments(found: Entry, overrides: Mapping[str, Any]) -> dict[str, Any]:
    given = {key: _override(found, key, value) for key, value in overrides.items()}
    said = {_DEVICE_KEY.get(key, key) for key in given}
    known = {key: value for key, value in found.known().items() if _DEVICE_KEY.get(key, key) not in said}
    return {"name": found.name, **known, **given}


def _override(found: Entry, key: str, value: Any) -> Any:
    if key in ("name", "motion", "transmission"):
        return value
    if key not in found.properties:
        raise InputError(f"a device has no {key!r}; {suggestion(key, found.properties)}")
    return None if value is None else parse(value, found.unit(key), key)


def _built(found: Entry, arguments: Mapping[str, Any]) -> Device:
    if found.motion == "linear":
        return Device(**arguments)
    given = {found.key(key): value for key, value in arguments.items()}
    if given.pop("motion", "rotary") != "rotary":
        raise InputError(f"{found.title} is rotary: its numbers are torques and angles; leave motion out")
    return rotary(**given)


def _require(found: Entry, arguments: Mapping[str, Any]) -> None:
    missing = [] if arguments.get("damping") is not None else ["damping"]
    if arguments.get("rate") is None and arguments.get("sample_period") is None:
        missing.append("rate")
    if missing:
        examples = {"damping": f'--damping "0.1 {found.unit("damping")}"', "rate": '--rate "1 kHz"'}
        answers = f"; zwidth check {found.name} answers for a stated range of what is unknown"
        ranged = answers if all(key in found.ranges for key in missing) else ""
        raise InputError(
            f"no source gives the {' and the '.join(missing)} of {found.title}, and no verdict exists "
            f"without {'it' if len(missing) == 1 else 'them'}; measure and give "
            f"{', '.join(f'{k} [{found.unit(k)}]' for k in missing)}, "
            f"for example {' '.join(examples[k] for k in missing)}; of a command without these options, as "
            f'zwidth pair and zwidth links, in a file whose [device] has catalogue = "{found.name}"; '
            f"zwidth identify finds the damping in a log of the handle moved by hand{ranged}"
        )


@cache
def _entries() -> Mapping[str, Entry]:
    import tomllib  # both on first use, to keep `import zwidth` fast
    from pathlib import Path

    text = Path(__file__).with_name("catalogue.toml").read_text(encoding="utf-8")
    tables = tomllib.loads(text, parse_float=Decimal)
    return MappingProxyType({name: _entry(name, table) for name, table in tables.items()})


def _entry(name: str, table: dict[str, Any]) -> Entry:
    motion = table.get("motion", "linear")
    unit_of = Entry(name, "", "", {}, {}, motion).unit
    given = {key: _datum(key, row, unit_of) for key, row in table["values"].items()}
    values = {
        key: given.get(key, Datum(None, unit_of(key), UNKNOWN))
        for key in PROPERTIES
        if not _other_form_given(key, given)
    }
    values.update(given)
    ranges = {
        key: Range(Exact(row["low"]), Exact(row["high"]), unit_of(key), row["why"])
        for key, row in table.get("ranges", {}).items()
    }
    about = (table["title"], table.get("note", ""))
    return Entry(name, *about, MappingProxyType(values), MappingProxyType(ranges), motion)


def _other_form_given(key: str, rows: Mapping[str, Any]) -> bool:
    """Of two forms of the same one row is enough; of an unknown rate and period that of the rate."""
    if key == "resolution" and "counts_per_turn" in rows:
        return True
    return (key == "sample_period" and key not in rows) or (key == "rate" and "sample_period" in rows)


def _datum(key: str, row: dict[str, Any], unit_of: Callable[[str], str]) -> Datum:
    source = row["source"]
    if key == "recommended_stiffness":
        source = f"{source} ({RECOMMENDATION})"
    return Datum(Exact(row["value"]), row.get("unit") or unit_of(key), source)
