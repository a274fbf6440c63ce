"""The command `report`: the verdict as one file to hand on."""

from __future__ import annotations

import argparse
import shlex
from pathlib import Path, PurePath
from typing import TYPE_CHECKING

from zwidth.cli.decision import Asked, asked, decided, exit_status
from zwidth.cli.options import (
    Once,
    add_contact_option,
    add_law_option,
    add_parameters,
    contact,
    overrides,
)
from zwidth.cli.output import check_new, print_text, say_written

if TYPE_CHECKING:
    from zwidth.report import Provenance


def configure(parser: argparse.ArgumentParser) -> None:
    """The arguments of `zwidth report`."""
    parser.usage = (
        "%(prog)s [SOURCE ...] [--law NAMES] [--PARAMETER VALUE ...] [--contact KIND] -o FILE [--force]"
    )
    parser.add_argument(
        "sources",
        metavar="SOURCE",
        nargs="*",
        help="device of the catalogue, or TOML file with a [device] table, an [environment] table or both",
    )
    add_law_option(parser)
    add_contact_option(parser)
    output = parser.add_argument_group("output")
    output.add_argument(
        "-o", "--save", metavar="FILE", action=Once, required=True, help="the report: .html or .pdf"
    )
    output.add_argument("--force", action="store_true", help="replace a file that exists")
    add_parameters(parser)


def run(arguments: argparse.Namespace) -> int:
    """`zwidth report`: the status says the outcome."""
    from zwidth import report

    target = Path(arguments.save)
    report.check_ending(target)
    check_new(target, arguments.force)
    given = asked(arguments)
    verdict = decided(given.loop, contact(arguments))
    report.save(verdict, target, _provenance(given, arguments), overwrite=arguments.force)
    print_text(f"{verdict.outcome}: {verdict.claim}")
    say_written(target)
    return exit_status(verdict.outcome)


def _provenance(given: Asked, arguments: argparse.Namespace) -> Provenance:
    """Of every number of the loop, and the command."""
    from zwidth.report.provenance import Provenance, of_device, of_environment

    device, environment, typed = given.loop.device, given.loop.environment, arguments.law or ()
    device_rows = of_device(given.device_table, device)
    law_rows = of_environment(given.environment_table, environment, device.motion, given.law_table, typed)
    return Provenance((*device_rows, *law_rows), _command(arguments))


def _command(arguments: argparse.Namespace) -> str:
    """What makes the report again, wherever its files lie: they stand there by their names alone."""
    words = ["zwidth", "report", *(PurePath(source).name for source in arguments.sources)]
    for names in arguments.law or ():
        words += ["--law", names]
    if arguments.contact is not None:
        words += ["--contact", arguments.contact]
    for key, value in overrides(arguments).items():
        words.append(
            f"--{key.replace('_', '-')}={value}" if value.startswith("-") else f"--{key.replace('_', '-')}"
        )
        words += [] if value.startswith("-") else [value]
    return shlex.join([*words, "-o", f"report{Path(arguments.save).suffix.lower()}"])
