"""The command line's options for parameters, made from the glossary and the registry of environments.

Every key of a specification is an option under its own name, `coulomb_friction`
as `--coulomb-friction`; nothing about a parameter is written twice.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterable, Iterator
from typing import Any, NamedTuple

from zwidth.cli.typed import Once as Once
from zwidth.cli.typed import heed_angles as heed_angles
from zwidth.errors import InputError
from zwidth.model.device.rotary import ROTARY
from zwidth.model.rendering import LAWS
from zwidth.model.specification import load as pairs
from zwidth.model.specification.environments import TYPES, option_keys
from zwidth.model.specification.read import DEVICE_KEYS
from zwidth.model.specification.table import quoted
from zwidth.quantity.glossary import GLOSSARY, Quantity

BEHIND = "environment."
"""What stands before a key of the environment behind a coupling."""

_MEANINGS = {
    "motion": "linear or rotary",
    "name": "name of the device in the report",
    "catalogue": "device of the catalogue that fills in what is not given",
}
"""Keys of a device that are no quantities."""


class Parameter(NamedTuple):
    """One parameter as an option: its key, what stands for its value, its help."""

    key: str
    metavar: str
    help: str

    @property
    def option(self) -> str:
        """The option's name, `--coulomb-friction`."""
        return "--" + self.key.replace("_", "-")


def device_parameters() -> Iterator[Parameter]:
    """The options of a device."""
    for key in DEVICE_KEYS:
        if key in GLOSSARY:
            yield _quantity(key)
        else:
            own = ROTARY.get(key)
            text = own.meaning + _bracket(own.unit) if own else _MEANINGS[key]
            yield Parameter(key, _word(key), text)


def environment_parameters() -> Iterator[Parameter]:
    """The options of an environment."""
    yield Parameter("type", "TYPE", f"{', '.join(TYPES)} (default: wall)")
    for key, kind in option_keys().items():
        symbol = kind.quantity.symbol if kind.is_number else _word(key)
        yield Parameter(key, symbol, kind.meaning + _bracket(_units(kind.quantity)))


def coupling_parameters() -> Iterator[Parameter]:
    """The options of what joins two arms."""
    for key, own in pairs.option_keys().items():
        yield Parameter(key, own.quantity.symbol or _word(key), own.meaning + _bracket(_units(own.quantity)))


def add_output(
    parser: argparse.ArgumentParser, printed: str, drawn: str, saved: str
) -> argparse._ArgumentGroup:
    """The options of what comes out: as JSON, as a picture, in a file."""
    output = parser.add_argument_group("output")
    output.add_argument("--json", action="store_true", help=f"print {printed} as JSON, units in the keys")
    output.add_argument("--plot", metavar="FILE", action=Once, help=f"save {drawn}: .png, .svg or .pdf")
    output.add_argument("-o", "--save", metavar="FILE", action=Once, help=f"save {saved}")
    output.add_argument("--force", action="store_true", help="replace files that exist")
    return output


def add_in_full(parser: argparse.ArgumentParser | argparse._ArgumentGroup) -> None:
    """The option --all of a command whose report is short without it."""
    parser.add_argument(
        "--all", action="store_true", dest="in_full", help="print the report in full, not the short one"
    )


def add_angles(parser: argparse.ArgumentParser | argparse._ArgumentGroup) -> None:
    """The option --angles of a command to which nobody types an angle."""
    parser.add_argument(
        "--angles",
        metavar="UNIT",
        action=Once,
        help="tell angles in deg, turn or rad, speeds with rpm too (default: as the files have them)",
    )


def add_parameters(parser: argparse.ArgumentParser) -> None:
    """Give a command every parameter of a device and of an environment."""
    device = parser.add_argument_group("device", "override what SOURCE says, or replace it")
    environment = parser.add_argument_group(
        "environment", f"a key of the environment behind a coupling is written --{BEHIND}stiffness, …"
    )
    add_all(device, device_parameters())
    for parameter in environment_parameters():
        inner = parameter._replace(key=BEHIND + parameter.key, help=argparse.SUPPRESS)
        add_all(environment, (parameter, inner))


def add_contact_option(parser: argparse.ArgumentParser) -> None:
    """The option that says which contact is asked about."""
    parser.add_argument(
        "--contact",
        metavar="KIND",
        action=Once,
        help="made-and-broken, as a hand does (default), or kept: the hand never leaves the wall",
    )


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


def add_law_option(parser: argparse.ArgumentParser) -> None:
    """Give a command the option `--law`."""
    parser.add_argument(
        "--law",
        metavar="NAMES",
        action="append",
        help=f"laws in a chain behind the environment, with their defaults: {', '.join(LAWS)}",
    )


def overrides(arguments: argparse.Namespace) -> dict[str, str]:
    """The parameters that were given, by key, as typed."""
    keys = [p.key for p in (*device_parameters(), *environment_parameters())]
    return given(arguments, (*keys, *(BEHIND + key for key in keys)))


def given(arguments: argparse.Namespace, keys: Iterable[str]) -> dict[str, str]:
    """Those of the keys that were given, with their values as typed."""
    values = vars(arguments)
    return {key: values[_dest(key)] for key in keys if values.get(_dest(key)) is not None}


def add_all(group: Any, parameters: Iterable[Parameter]) -> None:
    """Give a group of options these parameters."""
    for parameter in parameters:
        group.add_argument(
            parameter.option,
            dest=_dest(parameter.key),
            metavar=parameter.metavar,
            action=Once,
            help=parameter.help.replace("%", "%%"),
        )


def _dest(key: str) -> str:
    return f"parameter {key}"  # a blank keeps it apart from every other argument


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
