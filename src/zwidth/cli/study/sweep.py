"""The command `sweep`: the same question of every loop on a grid of parameters."""

from __future__ import annotations

import argparse
from collections.abc import Iterable, Iterator, Mapping
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from zwidth.cli.decision import NAMES
from zwidth.cli.options import (
    BEHIND,
    CONTACT,
    LAW,
    PARAMETERS,
    PLOT,
    contact,
    coupling_parameters,
    device_parameters,
    environment_parameters,
    given,
    overrides,
    whole,
)
from zwidth.cli.output import PICTURES, print_found, print_message, target
from zwidth.cli.parsing import Parameter
from zwidth.cli.simulate.tables import operator_parameters, simulation_parameters
from zwidth.errors import InputError
from zwidth.missing import suggestion
from zwidth.model.specification.environments import option_keys
from zwidth.model.specification.table import COMMAND_LINE, plain, quoted
from zwidth.quantity.units import parse_number

if TYPE_CHECKING:
    from zwidth.model.device import Device
    from zwidth.model.environment import Environment
    from zwidth.model.specification.table import Table


VERBS = ("check", "limit", "simulate", "pair")
"""What may be asked of every loop."""


USAGE = (
    "[SOURCE ...] --vary NAME=VALUES [--vary ...] [--of COMMAND] [--hands NAMES] "
    "[--PARAMETER VALUE ...] [--json] [--plot FILE] [-o FILE] [--workers N | --dask ADDRESS]"
)


def _of_pair_and_touch() -> Iterator[Parameter]:
    """What a pair and a simulation take beside the parameters of a loop."""
    taken = {own.key for own in (*device_parameters(), *environment_parameters())}
    for own in (*coupling_parameters(), *operator_parameters(), *simulation_parameters()):
        if own.key not in taken:
            yield own


OPTIONS = (
    {
        "sources=SOURCE*": "as the command of --of takes it: a device of the catalogue, or a TOML file",
        **LAW,
        **CONTACT,
    },
    "grid",
    {
        "--vary NAME=VALUES...": "a parameter, named as its option is, and its values: "
        "stiffness=100:3000:50, delay=0:5 ms:20, rate=100:10000:20 log, resolution=0.1,1,10 um; law.KEY of a "
        "law in a chain, law.2.KEY of the second one, velocity-filter.cutoff; with several every combination",
        "--of COMMAND": f"{', '.join(VERBS)} (default: check)",
        "--parameter NAME": "of limit: whose limit (default: stiffness)",
        "--tolerance RATIO": "of limit: width of the bracket (default: 0.01)",
        "--hands NAMES": f"of check: say besides whether hands that are known come to rest: {NAMES}; needs a "
        "mass",
    },
    "output",
    {
        "--workers N": "processes (default: one for each processor)",
        "--dask ADDRESS": "of a Dask scheduler, tcp://…, whose workers compute instead",
        **PLOT,
        "--json": "print the summary as JSON, units in the keys",
        "-o FILE": ".parquet or .zarr, written as it goes; one that was begun is gone on with",
        "--force": "replace the picture if it exists",
    },
    *PARAMETERS,
    "pair and simulation: of two arms, and of a hand that touches",
    _of_pair_and_touch,
)


def run(arguments: argparse.Namespace) -> int:
    """`zwidth sweep`: 0."""
    from zwidth.study.sweeps.run import sweep

    plot = target("--plot", arguments.plot, PICTURES, arguments.force)
    of = arguments.of or "check"
    if of not in VERBS:
        raise InputError(f"--of is one of {', '.join(VERBS)}, got {quoted(of)}")
    vary = _varied(arguments.vary)
    loop = asked(arguments, of, vary)
    try:
        found = sweep(
            loop.subject,
            loop.environment,
            vary=vary,
            of=of,
            operator=loop.operator,
            path=arguments.save,
            address=arguments.dask,
            workers=None if arguments.workers is None else whole(arguments.workers, "--workers"),
            **loop.options,
        )
    except KeyboardInterrupt:
        if arguments.save is not None:
            print_message(f"{plain(arguments.save, 200)} keeps what is finished; the same command goes on")
        raise
    if plot is not None:
        from zwidth.show.plots import save_sweep  # matplotlib takes its time

        save_sweep(found, plot, overwrite=True)
    from zwidth.cli.study.sweep_report import report, summary
    from zwidth.quantity.text import to_json

    kept = None if arguments.save is None else Path(arguments.save)
    print_found(arguments.json, lambda: to_json(summary(found)), partial(report, found), kept, plot)
    return 0


def _varied(typed: list[str] | None) -> dict[str, str]:
    if not typed:
        raise InputError("nothing is varied: say what and over which values, --vary stiffness=100:3000:50")
    found: dict[str, str] = {}
    for one in typed:
        name, equals, values = one.partition("=")
        key = name.strip().replace("-", "_")
        if not (equals and key and values.strip()):
            raise InputError(f"--vary is NAME=VALUES, such as stiffness=100:3000:50, got {quoted(one)}")
        if key in found:
            raise InputError(f"--vary {name.strip()} is given twice; which one is meant?")
        found[key] = values.strip()
    return found


class Asked(NamedTuple):
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
    "contact": ("check", "limit"),
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
    from zwidth.cli.simulate.tables import operator_parameters, simulation_parameters

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
    if arguments.contact is not None and contact(arguments) == "kept":
        options["contact"] = "kept"
    if arguments.hands is not None:
        from zwidth.cli.decision import named_hands

        hands = named_hands(arguments.hands, device.motion)
        options["hands"] = {name.replace("-", "_"): hand for name, hand in hands.items()}
    if of == "limit":
        from zwidth.cli.check.limit import named

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
    from zwidth.cli.simulate.tables import build_touch, operator_parameters, simulation_parameters
    from zwidth.model.specification.read import TABLES, read_tables

    tables = read_tables(arguments.sources, TABLES)
    words = given(arguments, [p.key for p in (*operator_parameters(), *simulation_parameters())])
    device, law = _loop(arguments, tables, begun)
    touch = build_touch(tables.get("operator"), tables.get("simulation"), words, device)
    return Asked(device, law, touch.operator, _run(touch))


def _run(touch: Any) -> dict[str, Any]:
    if touch.duration is None:
        raise InputError('no duration is given: set --duration, for example --duration "2 s"')
    return {**touch.options, "duration": touch.duration}
