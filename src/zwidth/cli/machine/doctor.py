"""The command `doctor`: is this machine fit to run the loop?"""

from __future__ import annotations

import argparse
from collections.abc import Mapping
from typing import TYPE_CHECKING

from zwidth.cli.options import IN_FULL, LAW, LOOP, PARAMETERS, output, overrides
from zwidth.cli.output import give_out, targets
from zwidth.errors import InputError
from zwidth.model.specification.table import quoted
from zwidth.quantity.exact import Exact
from zwidth.quantity.glossary import GLOSSARY
from zwidth.quantity.parameter import read_number

if TYPE_CHECKING:
    from zwidth.model.device import Device
    from zwidth.model.environment.environment import Environment

_DURATION = "60 s"
_TIMING = ("rate", "sample_period")
"""What may be given without a device."""


USAGE = (
    "[SOURCE ...] [--law NAMES] [--duration TIME] [--core N] [--PARAMETER VALUE ...] [--all] "
    "[--json] [--plot FILE] [-o FILE] [--force]"
)
OPTIONS = (
    {"sources=SOURCE*": f"of which to say what it costs: {LOOP} (default: none, at 1 kHz)", **LAW},
    "loop",
    {
        "--duration TIME": f"how long the loop runs [s] (default: {_DURATION})",
        "--core N": "number of the core that the loop keeps to (default: any)",
    },
    "output",
    {**output("what was found", "a histogram of the lateness", "the same as --json prints"), **IN_FULL},
    *PARAMETERS,
)


def run(arguments: argparse.Namespace) -> int:
    """`zwidth doctor`: 0."""
    from zwidth.machine.servo.checkup import doctor
    from zwidth.quantity.units import parse_number

    plot, save = targets(arguments.plot, arguments.save, arguments.force)
    core = _core(arguments.core)
    duration = parse_number(arguments.duration or _DURATION, "s", "duration")
    device, environment, period = _loop(arguments)
    found = doctor(device, environment, duration=duration, sample_period=period, core=core)
    few = [*found.in_short(), "", "--all shows the rest: what was looked at, finding by finding"]
    give_out(found, save, plot, arguments.json, None if arguments.in_full else lambda: few)
    return 0


def _core(typed: str | None) -> int | None:
    if typed is None:
        return None
    if not (typed.isascii() and typed.isdigit()):
        raise InputError(f"--core is the number of a core, such as 1, got {quoted(typed)}")
    return int(typed)


def _loop(arguments: argparse.Namespace) -> tuple[Device | None, Environment | None, Exact | None]:
    """Device, environment and period; None for what was not given, and for a period that the device has."""
    from zwidth.cli.decision import device_of_one_value, of_one_value
    from zwidth.model.specification.laws import with_laws
    from zwidth.model.specification.read import (
        DEVICE_KEYS,
        WITH_LAWS,
        read_tables,
        specified,
        specified_in_range,
    )

    tables, typed = read_tables(arguments.sources, WITH_LAWS), overrides(arguments)
    laws = tables.get("law") or arguments.law
    if not tables and not laws and set(typed) <= set(_TIMING):
        return None, None, _period(typed)
    if "environment" not in tables and not laws and set(typed) <= set(DEVICE_KEYS):
        return device_of_one_value(specified_in_range(tables, typed).device), None, None
    given = of_one_value(specified(tables, typed))
    rendered = with_laws(given.environment, tables.get("law"), arguments.law, given.device.motion)
    return given.device, rendered, None


def _period(typed: Mapping[str, str]) -> Exact | None:
    if not typed:
        return None
    if len(typed) == 2:
        raise InputError("give either --rate or --sample-period: each says how often the loop runs")
    ((name, text),) = typed.items()
    why = "the loop has to run to be late"
    number = read_number(text, GLOSSARY[name], name, bound="> 0", why=why)
    return Exact(1 / number.fraction) if name == "rate" else number
