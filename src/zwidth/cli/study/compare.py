"""The command `compare`: rendering laws on one bench."""

from __future__ import annotations

import argparse
from collections.abc import Iterator, Mapping
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from zwidth.cli.decision import of_one_value
from zwidth.cli.options import IN_FULL, LAW, PARAMETERS, output, overrides
from zwidth.cli.output import give_out, targets
from zwidth.errors import InputError
from zwidth.missing import suggestion
from zwidth.model.specification.laws import with_laws
from zwidth.model.specification.table import Table, quoted
from zwidth.quantity.units import parse_number
from zwidth.showing import Part

if TYPE_CHECKING:
    from zwidth.model.environment import Environment
    from zwidth.model.specification.read import Specification
    from zwidth.quantity.exact import Exact
    from zwidth.study.bench.comparison import LawComparison

YOURS = "yours"
"""What the row of laws of a specification is called on the bench."""

_MOST = 6
"""Laws in a short report."""


USAGE = (
    "[SOURCE ...] [--laws NAMES] [--law NAMES] [--fastest SPEED] [--PARAMETER VALUE ...] "
    "[--all] [--json] [--plot FILE] [-o FILE] [--force]"
)
OPTIONS = (
    {
        "sources=SOURCE*": "device of the catalogue, or TOML file with tables [device], [environment], "
        "[[law]]; or one with [leader], [follower], [coupling]: ways to join two arms",
        "--laws NAMES": "laws of the bench, with commas between them, or all (default: all)",
        **LAW,
        "--fastest SPEED": "of the fastest hand that tries to take energy out, of a wheel at its rim [m/s] "
        "(default: 10)",
    },
    "output",
    {**output("the scores", "the plot", "the scores as JSON"), **IN_FULL},
    *PARAMETERS,
)


def run(arguments: argparse.Namespace) -> int:
    """`zwidth compare`: 0."""
    from zwidth.model.specification.read import PAIR_TABLES, WITH_LAWS, read_tables

    plot, save = targets(arguments.plot, arguments.save, arguments.force)
    tables = read_tables(arguments.sources, (*WITH_LAWS, *PAIR_TABLES))
    if any(name in tables for name in PAIR_TABLES):
        return _pairs(arguments, tables, save)
    loop, radius = _touched(tables, overrides(arguments))
    own = with_laws(loop.environment, tables.get("law"), arguments.law, loop.device.motion)
    from zwidth.show.with_bar import compare
    from zwidth.study.bench.adversary import FASTEST
    from zwidth.study.bench.bench import standard_laws

    yours = {} if own is loop.environment else {YOURS: own}
    typed = arguments.fastest
    fastest = FASTEST if typed is None else float(parse_number(typed, "m/s", "fastest"))
    if radius is None:
        laws = _chosen(arguments.laws, standard_laws(loop.device, loop.environment), yours)
        found = compare(loop.device, loop.environment, laws, fastest=fastest)
    else:
        found = _of_a_rim(loop, radius, arguments.laws, yours, fastest)
    give_out(found, save, plot, arguments.json, None if arguments.in_full else partial(_few, found))
    return 0


def _touched(tables: Mapping[str, Table], typed: Mapping[str, str]) -> tuple[Specification, Exact | None]:
    """The loop, and of a device that turns the radius at which it is touched."""
    from zwidth.model.specification.read import specified
    from zwidth.study.bench.bench import radius_of

    table = tables.get("device")
    beside = {key: value for key, value in typed.items() if key != "handle_radius"}
    radius: Any = typed.get("handle_radius")
    if radius is None and table is not None and "handle_radius" in table.values:
        radius = table.values.pop("handle_radius")
    turning = table is not None and table.values.get("motion") == "rotary"
    loop = specified(
        tables, {**beside, **({"motion": "rotary"} if radius is not None and not turning else {})}
    )
    loop = of_one_value(loop)
    return loop, radius_of(loop.device, radius) if loop.device.motion == "rotary" else None


def _of_a_rim(
    loop: Specification, radius: Exact, typed: str | None, yours: Mapping[str, Environment], fastest: float
) -> LawComparison:
    from zwidth.show.with_bar import compare
    from zwidth.study.bench.bench import at_rim, standard_laws, wall_to_render

    if yours:
        raise InputError(
            "laws of your own have numbers about the axis, and the bench touches the rim: compare those of "
            "--laws, or give device, wall and laws at the handle"
        )
    wall = wall_to_render(loop.environment)
    there = at_rim(loop.device, wall, radius)
    found = compare(*there, _chosen(typed, standard_laws(*there), {}), fastest=fastest)
    return found.about_axis(loop.device, wall, radius)


def _few(found: LawComparison) -> Iterator[Part]:
    """What to do, some laws with three numbers each, and where the rest is."""
    yield from found.in_short(_MOST)
    laws = found.scores.sizes["law"]
    all_laws = f"all {laws} laws, " if laws > _MOST else ""
    yield f"--all shows the rest: {all_laws}every score, which promises do not hold"


def _pairs(arguments: argparse.Namespace, tables: Mapping[str, Table], save: Path | None) -> int:
    """Two arms joined in each of the ways that there are, the stiffness in all the same."""
    from zwidth.cli.simulate.simulate import pair_with_options
    from zwidth.show.with_bar import compare
    from zwidth.study.bench.pairs import schemes

    given = {"--laws": arguments.laws, "--fastest": arguments.fastest, "--plot": arguments.plot}
    foreign = [name for name, value in given.items() if value]
    if foreign:
        raise InputError(f"{foreign[0]} is of rendering laws: ways to join two arms are compared without it")
    pair = pair_with_options(arguments, tables)
    found = compare(schemes(pair))
    give_out(found, save, None, arguments.json)
    return 0


def _chosen(
    typed: str | None, laws: Mapping[str, Environment], yours: Mapping[str, Environment]
) -> dict[str, Environment]:
    """The laws that were named, in the order in which they were; those of the specification last."""
    if typed is None or typed.strip() == "all":
        return {**laws, **yours}
    chosen: dict[str, Environment] = {}
    for name in (part.strip() for part in typed.split(",")):
        if name not in laws:
            raise InputError(
                f"there is no law {quoted(name)} for this device; {suggestion(name, list(laws))}"
            )
        chosen[name] = laws[name]
    return {**chosen, **yours}
