"""The loop of a sweep, as its command line and its files say: of the command that is asked about it."""

from __future__ import annotations

import argparse
from collections.abc import Iterable, Mapping
from typing import Any, NamedTuple

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
from zwidth.quantity.units import parse_number
from zwidth.specification.table import COMMAND_LINE, quoted, suggestion


class Asked(NamedTuple):
    """What `zwidth.sweep` is given."""

    subject: Any
    environment: Any = None
    operator: Any = None
    options: Mapping[str, Any] = {}


def asked(arguments: argparse.Namespace, of: str, vary: Mapping[str, str]) -> Asked:
    """The loop, and the further arguments of the question.

    What is varied need not be given: it begins with its last value.

    Raises
    ------
    InputError
        If anything cannot be used, or an option is none of this command.
    """
    _begin(arguments, vary)
    _refuse_others(arguments, of)
    if of == "pair":
        return _pair(arguments)
    return _touch(arguments) if of == "simulate" else _wall(arguments, of)


def _begin(arguments: argparse.Namespace, vary: Mapping[str, str]) -> None:
    """Give each parameter that is varied its last value, which has its unit."""
    for key, values in vary.items():
        dest = f"parameter {key}"
        if key.startswith(("leader.", "follower.")):
            continue  # of one arm: it has no option
        if not hasattr(arguments, dest):
            known = sorted(
                n.removeprefix("parameter ") for n in vars(arguments) if n.startswith("parameter ")
            )
            raise InputError(f"--vary: there is no number {quoted(key)}; {suggestion(key, known)}")
        if getattr(arguments, dest) is not None:
            raise InputError(f"--{key.replace('_', '-')} is given and varied; which one is meant?")
        parts = values.split(":") if ":" in values else [*values.split(","), ""]
        setattr(arguments, dest, parts[-2].strip())


_OWN = {
    "contact": ("check",),
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


def _wall(arguments: argparse.Namespace, of: str) -> Asked:
    from zwidth.cli.decision import asked as loop_of

    loop = loop_of(arguments).loop
    options: dict[str, Any] = {}
    if of == "check" and arguments.contact is not None and contact(arguments) == "kept":
        options["contact"] = "kept"
    if of == "limit":
        from zwidth.cli.limit import named

        options["parameter"] = named(arguments.parameter or "stiffness")
        if arguments.tolerance is not None:
            options["tolerance"] = float(parse_number(arguments.tolerance, "1", "tolerance"))
    return Asked(loop.device, loop.environment, options=options)


def _pair(arguments: argparse.Namespace) -> Asked:
    from zwidth.specification.pairs import load_pair

    return Asked(load_pair(arguments.sources, given(arguments, [p.key for p in coupling_parameters()])))


def _touch(arguments: argparse.Namespace) -> Asked:
    from zwidth.cli.simulation_tables import build_touch, operator_parameters, simulation_parameters
    from zwidth.specification.laws import with_laws
    from zwidth.specification.read import TABLES, read_tables, specified

    tables = read_tables(arguments.sources, TABLES)
    words = given(arguments, [p.key for p in (*operator_parameters(), *simulation_parameters())])
    loop = specified(tables, overrides(arguments))
    law = with_laws(loop.environment, tables.get("law"), arguments.law, loop.device.motion)
    touch = build_touch(tables.get("operator"), tables.get("simulation"), words, loop.device.motion)
    return Asked(loop.device, law, touch.operator, _run(touch))


def _run(touch: Any) -> dict[str, Any]:
    if touch.duration is None:
        raise InputError("no duration is given: set --duration, for example --duration '2 s'")
    return {**touch.options, "duration": touch.duration}
