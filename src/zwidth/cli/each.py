"""The command `each`: the same question of each of several devices, a row for each."""

from __future__ import annotations

import argparse
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from zwidth.cli.options import Once, add_parameters, overrides
from zwidth.cli.output import print_json, print_report, say_written, targets
from zwidth.errors import InputError
from zwidth.model.specification.table import plain, quoted
from zwidth.quantity.spoken import angles_in
from zwidth.writing import writing_whole

if TYPE_CHECKING:
    from zwidth.cli.each_table import EachDevice
    from zwidth.model.specification.read import Specification
    from zwidth.model.specification.table import Table

_STATUS = ("active", "undecided", "passive in contact", "passive")
"""The outcome of the worst device says the status."""


def configure(parser: argparse.ArgumentParser) -> None:
    """The arguments of `zwidth each`."""
    parser.usage = (
        "%(prog)s SOURCE SOURCE ... [--PARAMETER VALUE ...] [--measured FILE] [--json] [-o FILE] [--force]"
    )
    parser.add_argument(
        "sources",
        metavar="SOURCE",
        nargs="*",
        help="devices of the catalogue, or TOML files with a [device] each; one file may have the "
        "[environment] of all of them",
    )
    output = parser.add_argument_group("output")
    output.add_argument(
        "--measured",
        metavar="FILE",
        action=Once,
        help="CSV with a device and a stiffness in each line: from where on it was seen to shake",
    )
    output.add_argument("--json", action="store_true", help="print the verdicts as JSON, units in the keys")
    output.add_argument(
        "-o",
        "--save",
        metavar="FILE",
        action=Once,
        help="save the table as .csv, or the verdicts with their evidence as .json, for zwidth verify",
    )
    output.add_argument("--force", action="store_true", help="replace a file that exists")
    add_parameters(parser)


def run(arguments: argparse.Namespace) -> int:
    """`zwidth each`: the status says the outcome of the worst device."""
    from zwidth.cli.decision import exit_status
    from zwidth.cli.each_table import EachDevice, read_measured
    from zwidth.passivity.check import check

    _, save = targets(None, arguments.save, arguments.force)
    if save is not None and save.suffix.lower() not in (".csv", ".json"):
        raise InputError(f"--save: the file must end in .csv or .json, got {quoted(save.name)}")
    loops = _named(_loops(arguments.sources, overrides(arguments)))
    motions = {loop.device.motion for loop in loops.values()}
    if len(motions) > 1:
        raise InputError("some of these devices turn and some slide: their stiffnesses do not compare")
    measured = {} if arguments.measured is None else read_measured(Path(arguments.measured), *motions)
    if unknown := measured.keys() - loops.keys():
        raise InputError(
            f"--measured: {quoted(min(unknown))} is none of these devices, which are {', '.join(loops)}"
        )
    verdicts = {name: check(loop.device, loop.environment, iterate=False) for name, loop in loops.items()}
    found = EachDevice(verdicts, measured)
    _save(found, save)
    if arguments.json:
        print_json(found.to_json())
    else:
        print_report(found.report())
        say_written(save)
    outcomes = {verdict.outcome for verdict in verdicts.values()}
    return exit_status(next(word for word in _STATUS if word in outcomes))


def _save(found: EachDevice, save: Path | None) -> None:
    if save is None:
        return
    if save.suffix.lower() == ".json":
        found.save(save)
    else:
        with writing_whole(save) as file:
            file.write(found.csv().encode())


def _loops(sources: list[str], typed: Mapping[str, str]) -> Iterator[Specification]:
    """A loop for each source with a device; an environment alone is that of all."""
    from zwidth.model.specification.read import built, keep_axis, merged, read_tables

    found = [read_tables([source]) for source in sources]
    shared = [tables["environment"] for tables in found if "device" not in tables]
    if len(shared) > 1:
        raise InputError(
            f"{shared[0].label} and {shared[1].label} both give an environment for all; drop one"
        )
    devices = [tables for tables in found if "device" in tables]
    if len(devices) < 2:
        raise InputError(
            f"name two devices or more, got {len(devices)}; of one device zwidth check says more"
        )
    for tables in devices:
        if shared and "environment" in tables:
            raise InputError(
                f"{tables['device'].label} has an environment, and so has {shared[0].label}: drop one"
            )
        own: dict[str, Table] = {**tables, **({"environment": _copy(shared[0])} if shared else {})}
        if angles_in(list(typed.values())):
            keep_axis(own["device"], list(typed.values()))
        yield built(*merged(own, typed), in_range=True)


def _copy(table: Table) -> Table:
    from zwidth.model.specification.table import Table

    return Table(table.label, table.values)


def _named(loops: Iterator[Specification]) -> dict[str, Specification]:
    """By the name of the device."""
    named: dict[str, Specification] = {}
    for loop in loops:
        name = plain(loop.device.name)
        if name in named:
            raise InputError(f"two devices are called {quoted(name)}: give one of them another name")
        named[name] = loop
    return named
