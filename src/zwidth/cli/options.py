"""The command line's options for parameters, made from the glossary and the registry of environments.

Every key of a specification is an option under its own name, `coulomb_friction`
as `--coulomb-friction`; nothing about a parameter is written twice.
"""

from __future__ import annotations

import argparse
import re
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from os.path import exists
from pathlib import Path
from typing import Any

from zwidth.cli.parsing import Parameter, dest_of
from zwidth.errors import InputError
from zwidth.missing import did_you_mean, suggestion
from zwidth.model.device import Transmission
from zwidth.model.device.rotary import ROTARY
from zwidth.model.rendering import LAWS
from zwidth.model.specification import load as pairs
from zwidth.model.specification.environments import TYPES, option_keys
from zwidth.model.specification.read import DEVICE_KEYS, refuse_missing
from zwidth.model.specification.table import quoted
from zwidth.model.specification.values import BETWEEN
from zwidth.quantity.glossary import GLOSSARY, Quantity
from zwidth.quantity.parameter import parameters_of

BEHIND = "environment."
"""What stands before a key of the environment behind a coupling."""

_MEANINGS = {
    "motion": "linear or rotary",
    "name": "name of the device in the report",
    "catalogue": "device of the catalogue that fills in what is not given",
}
"""Keys of a device that are no quantities."""


def device_parameters() -> Iterator[Parameter]:
    for key in DEVICE_KEYS:
        if key in GLOSSARY:
            yield _quantity(key)
        elif key.startswith(BETWEEN):
            kind = parameters_of(Transmission)[key.removeprefix(BETWEEN)]
            symbol = kind.quantity.symbol or "WHERE"
            yield Parameter(key, symbol, kind.meaning + _bracket(_units(kind.quantity)))
        else:
            own = ROTARY.get(key)
            text = own.meaning + _bracket(own.unit) if own else _MEANINGS[key]
            yield Parameter(key, _word(key), text)


def environment_parameters() -> Iterator[Parameter]:
    yield Parameter("type", "TYPE", f"{', '.join(TYPES)} (default: wall)")
    for key, kind in option_keys().items():
        symbol = kind.quantity.symbol if kind.is_number else _word(key)
        yield Parameter(key, symbol, kind.meaning + _bracket(_units(kind.quantity)))


def coupling_parameters() -> Iterator[Parameter]:
    for key, own in pairs.option_keys().items():
        yield Parameter(key, own.quantity.symbol or _word(key), own.meaning + _bracket(_units(own.quantity)))


def both_environments() -> Iterator[Parameter]:
    """Each key of an environment, and unseen in the help that of one behind a coupling."""
    for parameter in environment_parameters():
        yield parameter
        yield parameter._replace(key=BEHIND + parameter.key, help=argparse.SUPPRESS)


def _part(
    parameters: Callable[[], Iterable[Parameter]], wanted: Callable[[str], bool]
) -> Callable[[], list[Parameter]]:
    return lambda: [one for one in parameters() if wanted(one.key)]


def _of_a_wall(key: str) -> bool:
    return key.removeprefix(BEHIND) in ("type", "stiffness", "virtual_damping", "velocity_filter", "clamped")


DEVICE = (
    "device: override what SOURCE says, or replace it",
    _part(device_parameters, lambda key: not key.startswith(BETWEEN)),
    "cable, belt or gear between motor and hand",
    _part(device_parameters, lambda key: key.startswith(BETWEEN)),
)
PARAMETERS = (
    *DEVICE,
    f"environment: a key of the environment behind a coupling is written --{BEHIND}stiffness, …",
    _part(both_environments, _of_a_wall),
    "environment of another type than wall",
    _part(both_environments, lambda key: not _of_a_wall(key)),
)
"""Every parameter of a device, and of an environment."""

LOOP = "device of the catalogue, or TOML file with a [device] table, an [environment] table or both"
"""The sources of most commands, to which some add."""

LAW = {"--law NAMES...": f"laws in a chain behind the environment, with their defaults: {', '.join(LAWS)}"}
CONTACT = {
    "--contact KIND": "made-and-broken, as a hand does (default), or kept: the hand never leaves the wall"
}
ANGLES_TOLD = {
    "--angles UNIT": "tell angles in deg, turn or rad, speeds with rpm too (default: as the files have them)"
}
IN_FULL = {"--all > in_full": "print the report in full, not the short one"}
FORCE = {"--force": "replace files that exist"}
PLOT = {"--plot FILE": "save the plot: .png, .svg or .pdf"}


def output(printed: str, drawn: str, saved: str) -> dict[str, str]:
    """What comes out: as JSON, as a picture, in a file."""
    return {
        "--json": f"print {printed} as JSON, units in the keys",
        "--plot FILE": f"save {drawn}: .png, .svg or .pdf",
        "-o FILE": f"save {saved}",
        **FORCE,
    }


def contact(arguments: argparse.Namespace) -> str:
    """The contact that is asked about, as `zwidth.check` takes it."""
    typed = arguments.contact
    if typed is None or typed == "kept":
        return typed or "made and broken"
    if typed.replace("-", " ") == "made and broken":
        return "made and broken"
    raise InputError(
        f"--contact is made-and-broken, for a hand that touches and leaves, or kept, got {quoted(typed)}"
    )


def overrides(arguments: argparse.Namespace) -> dict[str, str]:
    """The parameters that were given, by key, as typed."""
    keys = [p.key for p in (*device_parameters(), *environment_parameters())]
    return given(arguments, (*keys, *(BEHIND + key for key in keys)))


def given(arguments: argparse.Namespace, keys: Iterable[str]) -> dict[str, str]:
    """Those of the keys that were given, with their values as typed."""
    values = vars(arguments)
    return {key: values[dest_of(key)] for key in keys if values.get(dest_of(key)) is not None}


def whole(typed: str, option: str) -> int:
    try:
        return int(typed)
    except ValueError:
        raise InputError(f"{option} takes a whole number, got {quoted(typed)}") from None


def _quantity(key: str) -> Parameter:
    entry = GLOSSARY[key]
    return Parameter(key, entry.symbol, entry.meaning + _bracket(_units(entry)))


def _units(quantity: Quantity) -> str:
    if quantity.unit == quantity.rotary_unit:
        return quantity.unit
    return f"{quantity.unit}; rotary {quantity.rotary_unit}"


def _word(key: str) -> str:
    return key.rpartition("_")[2].upper()


def _bracket(unit: str) -> str:
    return f" [{unit}]" if unit not in ("", "1") else ""


def look_for(files: Iterable[str], sources: Iterable[str] = ()) -> None:
    """Say of an input that it is not there before anything else; a source may be of the catalogue."""
    for name in files:
        if not exists(name):
            raise InputError(f"there is no file {quoted(name)}{did_you_mean(Path(name))}")
    refuse_missing(sources)


SHEET = {"--sheet NAME": "of a workbook, where several hold a recording; of a LeRobot dataset an episode"}


def pairs_of(option: str, typed: Sequence[str] | None, quantities: Sequence[str]) -> dict[str, str]:
    """What an option that may come several times says of each quantity."""
    pairs: dict[str, str] = {}
    for text in typed or ():
        key, sign, value = text.partition("=")
        name = key.strip().replace("-", "_")
        if not sign or not value:
            raise InputError(f"{option} is written {option} {quantities[1]}=VALUE, got {quoted(text)}")
        if name not in quantities:
            raise InputError(f"{option}: there is no quantity {quoted(key)}; {suggestion(name, quantities)}")
        if name in pairs:
            raise InputError(f"{option} names a quantity twice; which one is meant?")
        pairs[name] = value
    return pairs


_PYTHON = re.compile(r"(columns|units|scale)=\{[\"'](\w+)[\"']: (?:\"([^\"]*)\"|(None|…))\}")
_OPTION_NAMES = {"columns": "--column", "units": "--unit", "scale": "--scale"}


def reading_of(arguments: argparse.Namespace, quantities: Sequence[str]) -> dict[str, Any]:
    """What is typed of the columns, as `read_log` takes it."""
    reading = {}
    for name, option in _OPTION_NAMES.items():
        if pairs := pairs_of(option, getattr(arguments, name), quantities):
            reading[name] = {k: None if name == "columns" and v == "none" else v for k, v in pairs.items()}
    return reading


@contextmanager
def as_options() -> Iterator[None]:
    """What to try, in messages, as it is typed here."""
    try:
        yield
    except InputError as error:
        text = as_typed(str(error)).replace("sample_rate or sample_period", "--rate or --sample-period")
        text = re.sub(r'\bresolution=("[^"]*")', r"--resolution \1", text)
        raise InputError(re.sub(r"\bcounts_per_turn=(\d+)", r"--counts-per-turn \1", text)) from None


def as_typed(text: str) -> str:
    """Columns and sheets, in a message, as they are typed here."""
    return _PYTHON.sub(_as_option, re.sub(r'\bsheet=("[^"]*")', r"--sheet \1", text))


def _as_option(found: re.Match[str]) -> str:
    name, quantity, value, other = found.groups()
    value = value if value is not None else {"None": "none"}.get(other, "…")
    written = f"'{quantity}={value}'" if " " in value else f"{quantity}={value}"
    return f"{_OPTION_NAMES[name]} {written}"
