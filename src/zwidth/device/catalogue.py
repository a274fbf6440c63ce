"""The catalogue: real devices, each number with its source.

A value that no source gives is unknown, and stays unknown: a device whose
damping nobody has published can be used once the caller gives one.
`recommended_stiffness` is what a vendor's or driver's authors allow as the
largest stiffness; it is a recommendation, not a dynamic property, and no
verdict rests on it.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from decimal import Decimal
from difflib import get_close_matches
from functools import cache
from types import MappingProxyType
from typing import Any, NamedTuple

from zwidth.device.device import Device
from zwidth.errors import InputError
from zwidth.quantity.exact import Exact
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


@dataclass(frozen=True)
class Entry:
    """A device of the catalogue: what is published about it, and by whom."""

    name: str
    title: str
    note: str
    values: Mapping[str, Datum]

    def known(self) -> dict[str, Exact]:
        """The published values that are arguments of `Device`."""
        return {k: d.value for k, d in self.values.items() if k in PROPERTIES and d.value is not None}


def names() -> tuple[str, ...]:
    """The names of all devices in the catalogue."""
    return tuple(_entries())


def entry(name: str) -> Entry:
    """What is published about one device.

    Raises
    ------
    InputError
        If the catalogue has no such name.
    """
    found = _entries().get(name)
    if found is None:
        near = get_close_matches(str(name), names(), n=1)
        hint = f'did you mean "{near[0]}"?' if near else f"it has: {', '.join(names())}"
        raise InputError(f"the catalogue has no device {str(name)[:40]!r}; {hint}")
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
    given = {key: _override(key, value) for key, value in overrides.items()}
    arguments: dict[str, Any] = {"name": found.name, **found.known()}
    if "rate" in given or "sample_period" in given:
        arguments.pop("rate", None)
        arguments.pop("sample_period", None)
    arguments.update(given)
    _require(found, arguments)
    return Device(**arguments)


def _override(key: str, value: Any) -> Any:
    if key in ("name", "motion"):
        return value
    if key not in PROPERTIES:
        near = get_close_matches(key, PROPERTIES, n=1)
        hint = f'did you mean "{near[0]}"?' if near else f"it has: {', '.join(PROPERTIES)}"
        raise InputError(f"a device has no {key!r}; {hint}")
    return None if value is None else parse(value, GLOSSARY[key].unit, key)


def _require(found: Entry, arguments: Mapping[str, Any]) -> None:
    missing = [] if arguments.get("damping") is not None else ["damping"]
    if arguments.get("rate") is None and arguments.get("sample_period") is None:
        missing.append("rate")
    if missing:
        examples = {"damping": "--damping 0.1", "rate": "--rate 1000"}
        raise InputError(
            f"no source gives the {' and the '.join(missing)} of {found.title}, and no verdict exists "
            f"without {'it' if len(missing) == 1 else 'them'}; measure and give "
            f"{', '.join(f'{k} [{GLOSSARY[k].unit}]' for k in missing)}, "
            f"for example {' '.join(examples[k] for k in missing)}; zwidth identify finds the damping in a "
            "log of the handle moved by hand, and zwidth new device asks for one number after another"
        )


@cache
def _entries() -> Mapping[str, Entry]:
    import tomllib  # both on first use, to keep `import zwidth` fast
    from pathlib import Path

    text = Path(__file__).with_name("catalogue.toml").read_text(encoding="utf-8")
    tables = tomllib.loads(text, parse_float=Decimal)
    return MappingProxyType({name: _entry(name, table) for name, table in tables.items()})


def _entry(name: str, table: dict[str, Any]) -> Entry:
    given = {key: _datum(key, row) for key, row in table["values"].items()}
    values = {
        key: given.get(key, Datum(None, GLOSSARY[key].unit, UNKNOWN))
        for key in PROPERTIES
        if not _other_form_given(key, table["values"])
    }
    values.update(given)
    return Entry(name, table["title"], table.get("note", ""), MappingProxyType(values))


def _other_form_given(key: str, rows: Mapping[str, Any]) -> bool:
    """Of rate and sample period one row is enough; where both are unknown, the rate."""
    return (key == "sample_period" and key not in rows) or (key == "rate" and "sample_period" in rows)


def _datum(key: str, row: dict[str, Any]) -> Datum:
    source = row["source"]
    if key == "recommended_stiffness":
        source = f"{source} ({RECOMMENDATION})"
    return Datum(Exact(row["value"]), row.get("unit") or GLOSSARY[key].unit, source)
