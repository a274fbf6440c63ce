"""The command `report`: the verdict as one file to hand on."""

from __future__ import annotations

import argparse
from pathlib import Path, PurePath
from typing import TYPE_CHECKING

from zwidth.cli.decision import asked, decided, exit_status, of_one_timing
from zwidth.cli.options import CONTACT, LAW, LOOP, PARAMETERS, contact, overrides
from zwidth.cli.output import print_text, say_written
from zwidth.errors import InputError
from zwidth.showing import typed
from zwidth.writing import check_target

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from zwidth.model.specification.table import Table
    from zwidth.passivity.result import Answer
    from zwidth.show.report.provenance import Provenance


USAGE = "[SOURCE ...] [--law NAMES] [--PARAMETER VALUE ...] [--contact KIND] -o FILE [--force]"
OPTIONS = (
    {
        "sources=SOURCE*": f"{LOOP}; or one file of two arms, with [leader], [follower] and [coupling]",
        **LAW,
        **CONTACT,
    },
    "output",
    {"-o FILE!": "the report: .html", "--force": "replace a file that exists"},
    *PARAMETERS,
)


def run(arguments: argparse.Namespace) -> int:
    """`zwidth report`: the status says the outcome."""
    from zwidth.show import report

    target = Path(arguments.save)
    report.check_ending(target)
    check_target(target, arguments.force, "--force")
    tables = _of_a_pair(arguments.sources)
    verdict, told = _loop(arguments) if tables is None else _pair(tables, arguments)
    report.save(verdict, target, told, overwrite=arguments.force)
    print_text(f"{verdict.outcome}: {verdict.claim}")
    say_written(target)
    return exit_status(verdict.outcome)


def _loop(arguments: argparse.Namespace) -> tuple[Answer, Provenance]:
    """The verdict on a device and a law, and where their numbers come from."""
    from zwidth.show.report.provenance import Provenance, file_of, of_device, of_environment

    given = asked(arguments)
    loop, typed = of_one_timing(given.loop), arguments.law or ()
    device, environment = loop.device, loop.environment
    verdict = decided(loop, contact(arguments))
    rows = of_environment(given.environment_table, environment, device.motion, given.law_table, typed)
    return verdict, Provenance(
        (*of_device(given.device_table, device), *rows),
        _command(arguments),
        file_of(given.device_table),
        file_of(given.environment_table),
    )


def _of_a_pair(sources: Sequence[str]) -> Mapping[str, Table] | None:
    """The tables of the one source, where it is a file of two arms."""
    from zwidth.model.specification.read import PAIR_TABLES, WITH_LAWS, read_tables

    if len(sources) != 1:
        return None
    tables = read_tables(sources, (*WITH_LAWS, *PAIR_TABLES))
    return tables if any(name in tables for name in PAIR_TABLES) else None


def _pair(tables: Mapping[str, Table], arguments: argparse.Namespace) -> tuple[Answer, Provenance]:
    """The verdict on two arms, and where their numbers come from."""
    from zwidth.model.specification.load import pair_of
    from zwidth.passivity.check import check
    from zwidth.show.report.provenance import Provenance, of_pair

    if overrides(arguments) or arguments.law or arguments.contact:
        raise InputError(
            "the numbers of two arms stand in their file: no parameter, law or contact can be given beside "
            "it here; zwidth pair takes those of the coupling"
        )
    pair = pair_of(tables)
    return check(pair), Provenance(tuple(of_pair(tables, pair)), _command(arguments))


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
    return typed(*words, "-o", "report.html")
