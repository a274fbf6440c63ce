"""The loop of a sweep, as its command line and its files say: of the command that is asked about it."""

from __future__ import annotations

import argparse
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any, NamedTuple

from zwidth.cli.options import (
    BEHIND,
    Parameter,
    contact,
    coupling_parameters,
    device_parameters,
    environment_parameters,
    given,
    overrides,
)
from zwidth.errors import InputError
from zwidth.model.specification.environments import option_keys
from zwidth.model.specification.table import COMMAND_LINE, quoted, suggestion
from zwidth.quantity.units import parse_number

if TYPE_CHECKING:
    from zwidth.model.device import Device
    from zwidth.model.environment import Environment
    from zwidth.model.specification.table import Table


class Asked(NamedTuple):
    """What `zwidth.sweep` is given."""

    subject: Any
    environment: Any = None
    operator: Any = None
    options: Mapping[str, Any] = {}


def asked(arguments: argparse.Namespace, of: str, vary: Mapping[str, str]) -> Asked:
    """The loop, and the further arguments of the question.

    What is varied need not be given: it begins with its last value.
    """
    begun, unknown = _begin(arguments, vary)
    _refuse_others(arguments, of)
    try:
        if of == "pair":
            return _pair(arguments)
        return _touch(arguments, begun) if of == "simulate" else _wall(arguments, of, begun)
    except InputError:
        if unknown:
            raise _no_number(arguments, unknown) from None
        raise


def _begin(arguments: argparse.Namespace, vary: Mapping[str, str]) -> tuple[dict[str, str], str]:
    """Give each parameter that is varied its last value, which has its unit.

    The values of those that have no option, and the first name that no loop has; "" where each may be one.
    """
    begun, unknown = {}, ""
    for key, values in vary.items():
        dest = f"parameter {key}"
        parts = values.split(":") if ":" in values else [*values.split(","), ""]
        last = parts[-2].strip()
        if not hasattr(arguments, dest):
            unknown = unknown or ("" if "." in key else key)  # one within another: what the loop has, it says
            begun[key] = last
            continue
        if getattr(arguments, dest) is not None:
            raise InputError(f"--{key.replace('_', '-')} is given and varied; which one is meant?")
        if key.rpartition(".")[2] in _NO_NUMBERS:
            unknown = unknown or key
            continue
        setattr(arguments, dest, last)
    return begun, unknown


_NO_NUMBERS = frozenset(key for key, own in option_keys().items() if not own.is_number) | {
    "type",
    "name",
    "motion",
    "catalogue",
}
"""Options that hold a word, or a list."""


def _no_number(arguments: argparse.Namespace, key: str) -> InputError:
    """What is said of a name that no loop has, where this one cannot be made without it."""
    options = (n.removeprefix("parameter ") for n in vars(arguments) if n.startswith("parameter "))
    known = sorted(name for name in options if name.rpartition(".")[2] not in _NO_NUMBERS)
    return InputError(f"--vary: there is no number {quoted(key)}; {suggestion(key, known)}")


_OWN = {
    "contact": ("check",),
    "hands": ("check",),
    "parameter": ("limit",),
    "tolerance": ("limit",),
    "law": ("check", "limit", "simulate"),
}
"""Options that are not of every question."""


def _refuse_others(arguments: argparse.Namespace, of: str) -> None:
    for option, questions in _OWN.items():
        if getattr(arguments, option) is not None and of not in questions:
            raise InputError(f"--{option} is of {', '.join(questions)}, and this sweep is of {of}")
    known = {own.key for own in _parameters(of)}
    for name, value in vars(arguments).items():
        key = name.removeprefix("parameter ")
        if key != name and value is not None and key not in known:
            raise InputError(
                f"{COMMAND_LINE}: --{key.replace('_', '-')} is no option of {of}, which this sweep is of"
            )


def _parameters(of: str) -> Iterable[Parameter]:
    """The parameters that a question has."""
    from zwidth.cli.simulation_tables import operator_parameters, simulation_parameters

    if of == "pair":
        return coupling_parameters()
    loop = [*device_parameters(), *environment_parameters()]
    loop += [own._replace(key=BEHIND + own.key) for own in environment_parameters()]
    if of != "simulate":
        return loop
    return [*loop, *operator_parameters(), *simulation_parameters()]


def _wall(arguments: argparse.Namespace, of: str, begun: Mapping[str, str]) -> Asked:
    from zwidth.model.specification.read import WITH_LAWS, read_tables

    device, law = _loop(arguments, read_tables(arguments.sources, WITH_LAWS), begun)
    options: dict[str, Any] = {}
    if of == "check" and arguments.contact is not None and contact(arguments) == "kept":
        options["contact"] = "kept"
    if arguments.hands is not None:
        from zwidth.cli.hands_alone import named_hands

        hands = named_hands(arguments.hands, device.motion)
        options["hands"] = {name.replace("-", "_"): hand for name, hand in hands.items()}
    if of == "limit":
        from zwidth.cli.limit import named

        options["parameter"] = named(arguments.parameter or "stiffness")
        if arguments.tolerance is not None:
            options["tolerance"] = float(parse_number(arguments.tolerance, "1", "tolerance"))
    return Asked(device, law, options=options)


def _loop(
    arguments: argparse.Namespace, tables: Mapping[str, Table], begun: Mapping[str, str]
) -> tuple[Device, Environment]:
    """Device and environment behind its laws; a number of a law that is varied need not be given either."""
    from zwidth.model.specification.laws import behind_laws, law_tables
    from zwidth.model.specification.read import specified

    loop = specified(tables, overrides(arguments))
    laws = law_tables(tables.get("law"), arguments.law)
    for number, law in enumerate(laws, start=1):
        before = "law." if len(laws) == 1 else f"law.{number}."
        for name, value in begun.items():
            key = name.removeprefix(before)
            if name.startswith(before) and "." not in key:
                law.values.setdefault(key, value)
    return loop.device, behind_laws(loop.environment, laws, loop.device.motion)


def _pair(arguments: argparse.Namespace) -> Asked:
    from zwidth.model.specification.load import load_pair

    return Asked(load_pair(arguments.sources, given(arguments, [p.key for p in coupling_parameters()])))


def _touch(arguments: argparse.Namespace, begun: Mapping[str, str]) -> Asked:
    from zwidth.cli.simulation_tables import build_touch, operator_parameters, simulation_parameters
    from zwidth.model.specification.read import TABLES, read_tables

    tables = read_tables(arguments.sources, TABLES)
    words = given(arguments, [p.key for p in (*operator_parameters(), *simulation_parameters())])
    device, law = _loop(arguments, tables, begun)
    touch = build_touch(tables.get("operator"), tables.get("simulation"), words, device.motion)
    return Asked(device, law, touch.operator, _run(touch))


def _run(touch: Any) -> dict[str, Any]:
    if touch.duration is None:
        raise InputError("no duration is given: set --duration, for example --duration '2 s'")
    return {**touch.options, "duration": touch.duration}
