"""The command `compare`: rendering laws on one bench."""

from __future__ import annotations

import argparse
import json
from typing import TYPE_CHECKING, Any

from zwidth.cli.options import Once, add_parameters, overrides
from zwidth.cli.output import print_json, targets, writing
from zwidth.cli.table import quoted, suggestion
from zwidth.errors import InputError

if TYPE_CHECKING:
    from zwidth.bench import LawComparison


def configure_compare(parser: argparse.ArgumentParser) -> None:
    """The arguments of `zwidth compare`."""
    parser.usage = (
        "%(prog)s [SOURCE ...] [--laws NAMES] [--PARAMETER VALUE ...] [--json] [--plot FILE] [-o FILE] "
        "[--force]"
    )
    parser.add_argument(
        "sources",
        metavar="SOURCE",
        nargs="*",
        help="device of the catalogue, or TOML file with a [device] table, an [environment] table or both",
    )
    parser.add_argument(
        "--laws",
        metavar="NAMES",
        action=Once,
        help="names of laws, with commas between them, or all (default: all)",
    )
    output = parser.add_argument_group("output")
    output.add_argument("--json", action="store_true", help="print the scores as JSON, units in the keys")
    output.add_argument("--plot", metavar="FILE", action=Once, help="save the plot: .png, .svg or .pdf")
    output.add_argument("-o", "--save", metavar="FILE", action=Once, help="save the scores as JSON")
    output.add_argument("--force", action="store_true", help="replace files that exist")
    add_parameters(parser)


def run_compare(arguments: argparse.Namespace) -> int:
    """`zwidth compare`: 0."""
    from zwidth.cli.specification import load

    plot, save = targets(arguments.plot, arguments.save, arguments.force)
    loop = load(arguments.sources, overrides(arguments))
    from zwidth.bench.laws import standard_laws
    from zwidth.cli.patience import warn_of_compiling
    from zwidth.traces import compare

    warn_of_compiling()
    laws = _chosen(arguments.laws, standard_laws(loop.device, loop.environment))
    found = compare(loop.device, loop.environment, laws)
    if save is not None:
        with writing(save):
            save.write_text(_json(found) + "\n", encoding="utf-8")
    if plot is not None:
        with writing(plot):
            found.plot(plot)
    print_json(_json(found)) if arguments.json else print(found)
    return 0


def _chosen(typed: str | None, laws: dict[str, Any]) -> dict[str, Any] | None:
    """The laws that were named, in the order in which they were."""
    if typed is None or typed.strip() == "all":
        return None
    chosen = {}
    for name in (part.strip() for part in typed.split(",")):
        if name not in laws:
            raise InputError(f"there is no law {quoted(name)}; {suggestion(name, list(laws))}")
        chosen[name] = laws[name]
    return chosen


def _json(found: LawComparison) -> str:
    from zwidth.passivity.document import unit_suffix

    rows = {}
    for name in found.scores["law"].values:
        one = found.scores.sel(law=name)
        row: dict[str, Any] = {"status": str(one["status"].item()), "evidence": found.evidence[str(name)]}
        for key, value in one.data_vars.items():
            if key != "status":
                unit = value.attrs["units"]
                number = float(value)
                finite = number if abs(number) < float("inf") else None
                row[str(key) if unit == "1" else f"{key}_{unit_suffix(unit)}"] = finite
        rows[str(name)] = row
    document = {"format": "zwidth laws 1", "advice": found.advice, "laws": rows}
    return json.dumps(document, indent=2, ensure_ascii=False)
