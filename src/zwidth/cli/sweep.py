"""The command `sweep`: the same question of every loop on a grid of parameters."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from zwidth.cli.hands_alone import NAMES
from zwidth.cli.options import (
    Once,
    add_all,
    add_contact_option,
    add_law_option,
    add_parameters,
    coupling_parameters,
)
from zwidth.cli.output import (
    PICTURES,
    print_json,
    print_message,
    print_report,
    say_written,
    target,
)
from zwidth.errors import InputError
from zwidth.model.specification.table import plain, quoted

if TYPE_CHECKING:
    import xarray as xr

VERBS = ("check", "limit", "simulate", "pair")
"""What may be asked of every loop."""


def configure(parser: argparse.ArgumentParser) -> None:
    """The arguments of `zwidth sweep`."""
    from zwidth.cli.simulation_tables import operator_parameters, simulation_parameters

    parser.usage = (
        "%(prog)s [SOURCE ...] --vary NAME=VALUES [--vary ...] [--of COMMAND] [--hands NAMES] "
        "[--PARAMETER VALUE ...] [--json] [--plot FILE] [-o FILE] [--workers N | --dask ADDRESS]"
    )
    parser.add_argument(
        "sources",
        metavar="SOURCE",
        nargs="*",
        help="as the command of --of takes it: a device of the catalogue, or a TOML file",
    )
    grid = parser.add_argument_group("grid")
    grid.add_argument(
        "--vary",
        metavar="NAME=VALUES",
        action="append",
        help="a parameter, named as its option is, and its values: stiffness=100:3000:50, delay=0:5 ms:20, "
        "rate=100:10000:20 log, resolution=0.1,1,10 um; law.KEY of a law in a chain, law.2.KEY of the second "
        "one, velocity-filter.cutoff; with several every combination",
    )
    grid.add_argument("--of", metavar="COMMAND", action=Once, help=f"{', '.join(VERBS)} (default: check)")
    grid.add_argument(
        "--parameter", metavar="NAME", action=Once, help="of limit: whose limit (default: stiffness)"
    )
    grid.add_argument(
        "--tolerance", metavar="RATIO", action=Once, help="of limit: width of the bracket (default: 0.01)"
    )
    grid.add_argument(
        "--hands",
        metavar="NAMES",
        action=Once,
        help=f"of check: say besides whether hands that are known come to rest: {NAMES}; needs a mass",
    )
    add_law_option(parser)
    add_contact_option(parser)
    output = parser.add_argument_group("output")
    for option, metavar, meaning in (
        ("--workers", "N", "processes (default: one for each processor)"),
        ("--dask", "ADDRESS", "of a Dask scheduler, tcp://…, whose workers compute instead"),
        ("--plot", "FILE", "save the plot: .png, .svg or .pdf"),
    ):
        output.add_argument(option, metavar=metavar, action=Once, help=meaning)
    output.add_argument("--json", action="store_true", help="print the summary as JSON, units in the keys")
    output.add_argument(
        "-o",
        "--save",
        metavar="FILE",
        action=Once,
        help=".parquet or .zarr, written as it goes; one that was begun is gone on with",
    )
    output.add_argument("--force", action="store_true", help="replace the picture if it exists")
    add_parameters(parser)
    taken = {action.dest for action in parser._actions}
    rest = (*coupling_parameters(), *operator_parameters(), *simulation_parameters())
    more = parser.add_argument_group("pair and simulation", "of two arms, and of a hand that touches")
    add_all(more, (own for own in rest if f"parameter {own.key}" not in taken))


def run(arguments: argparse.Namespace) -> int:
    """`zwidth sweep`: 0."""
    from zwidth.cli.sweep_loop import asked
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
            workers=_workers(arguments.workers),
            **loop.options,
        )
    except KeyboardInterrupt:
        if arguments.save is not None:
            print_message(f"{plain(arguments.save, 200)} keeps what is finished; the same command goes on")
        raise
    if plot is not None:
        _draw(found, plot)
    if arguments.json:
        from zwidth.cli.sweep_report import summary
        from zwidth.quantity.text import to_json

        print_json(to_json(summary(found)))
    else:
        from zwidth.cli.sweep_report import report

        print_report(report(found))
        say_written(None if arguments.save is None else Path(arguments.save), plot)
    return 0


def _draw(found: xr.Dataset, plot: Path) -> None:
    from zwidth.show.plots import save_sweep  # matplotlib takes its time

    save_sweep(found, plot, overwrite=True)


def _varied(typed: list[str] | None) -> dict[str, str]:
    """Names and values as they were typed."""
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


def _workers(typed: str | None) -> int | None:
    if typed is None:
        return None
    try:
        return int(typed)
    except ValueError:
        raise InputError(f"--workers takes a whole number, got {quoted(typed)}") from None
