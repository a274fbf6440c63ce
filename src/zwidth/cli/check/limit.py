"""The command `limit`: how far one parameter may go, proved on one side and refuted on the other."""

from __future__ import annotations

import argparse
from dataclasses import fields
from fractions import Fraction
from functools import partial
from typing import TYPE_CHECKING, Any

from zwidth.cli.decision import asked, of_one_value
from zwidth.cli.options import CONTACT, IN_FULL, LAW, LOOP, PARAMETERS, contact, output, overrides
from zwidth.cli.output import give_out, print_message, printed, targets
from zwidth.cli.parsing import dest_of
from zwidth.errors import InputError
from zwidth.missing import suggestion
from zwidth.model.device.catalogue import PROPERTIES
from zwidth.model.specification.environments import option_keys
from zwidth.model.specification.table import quoted
from zwidth.quantity.glossary import GLOSSARY
from zwidth.quantity.text import shown
from zwidth.quantity.units import parse_number

if TYPE_CHECKING:
    from zwidth.model.specification.read import Specification
    from zwidth.passivity.bracket import Bracket

_ON_DEVICE = ("damping", "coulomb_friction", "resolution", "delay", "rate")
"""Parameters of a device on which an outcome depends."""

BOTH, ONE_OR_NONE = 0, 3
"""Exit status by the sides that were found; 2 is bad input."""


USAGE = (
    "[SOURCE ...] [--law NAMES] [--contact KIND] [--parameter NAME] [--penetration LENGTH] [--speed SPEED] "
    "[--PARAMETER VALUE ...] [--all] [--json] [--plot FILE] [-o FILE] [--force]"
)
OPTIONS = (
    {"sources=SOURCE*": f"{LOOP}, and [[law]] tables", **LAW, **CONTACT},
    "search",
    {
        "--parameter NAME": "which parameter, named as its option is (default: stiffness)",
        "--penetration LENGTH": "the hand goes no deeper [m; rotary rad]",
        "--speed SPEED": "the hand is no faster, over a sample [m/s; rotary rad/s]",
        "--tolerance RATIO": "relative width of the bracket that is wanted (default: 0.01)",
        "--effort NUMBER": "how much is tried: 1 is about a second of one core, counted as work, so that "
        "every machine finds the same (default: 60)",
        "--seconds TIME": "time after which the bracket so far is given as well [s] (default: none)",
        "--count-force-limit": "count in the force limit of the device",
        "--count-force-resolution": "count in the steps of its D/A converter",
    },
    "output",
    {**output("the bracket", "the plots", "bracket and evidence, for zwidth verify"), **IN_FULL},
    *PARAMETERS,
)


def run(arguments: argparse.Namespace) -> int:
    """`zwidth limit`: 0 if both sides of the limit were found, or there is none, else 3."""
    plot, save = targets(arguments.plot, arguments.save, arguments.force)
    if _has_no_wall(arguments):
        setattr(arguments, dest_of("stiffness"), "0")  # what is sought: the search begins at 2b/T
    loop = of_one_value(asked(arguments).loop)
    parameter = named(arguments.parameter or "stiffness")
    if parameter == "environment.stiffness":
        _refuse_without_stiffness(loop)
    options = _options(arguments, loop.device.motion)
    from zwidth.show.with_bar import passive_limit

    bracket = passive_limit(loop.device, loop.environment, parameter, told=_announce, **options)
    report = printed("check.limit_report:print_bracket", bracket, loop, arguments.in_full)
    give_out(bracket, save, plot, arguments.json, report, partial(_json, bracket))
    both = bracket.proved_passive is not None and bracket.proved_active is not None
    return BOTH if both or bracket.every_value else ONE_OR_NONE


def _has_no_wall(arguments: argparse.Namespace) -> bool:
    """True where the stiffness of a wall is sought, and neither file nor command line has an environment."""
    from zwidth.model.specification.read import WITH_LAWS, read_tables

    typed = overrides(arguments)
    sought = named(arguments.parameter or "stiffness") == "environment.stiffness"
    is_wall = "stiffness" not in typed and typed.get("type", "wall") == "wall"
    return sought and is_wall and "environment" not in read_tables(arguments.sources, WITH_LAWS)


def _announce(seconds: float) -> None:
    print_message(
        f"this may take up to about {shown(seconds, 's', 2)}: the law's memory, and how fast and deep the "
        'hand goes, make a large grid. "--effort 5" ends it after about 5 s with what was found by then; a '
        "slower hand, --speed, makes the grid smaller"
    )


def _refuse_without_stiffness(loop: Specification) -> None:
    """Ask for the parameter where there is no stiffness to take."""
    met = loop.environment.met
    if hasattr(met, "stiffness"):
        return
    numbers = [
        field.name.replace("_", "-") for field in fields(met) if isinstance(getattr(met, field.name), float)
    ]
    if met.scaled(Fraction(1)) is not None:
        numbers.insert(0, "gain, a factor on its force")
    numbers.append(f"or of the device {', '.join(key.replace('_', '-') for key in _ON_DEVICE)}")
    raise InputError(
        "this environment has no single stiffness, so say with --parameter which limit is wanted: "
        + "; ".join(numbers)
    )


def named(typed: str) -> str:
    """The name in Python of what is an option here: `damping` is always the device's."""
    name = typed.strip().replace("-", "_")
    if name.startswith("transmission."):
        return name
    on_device, in_environment = set(PROPERTIES) & set(GLOSSARY), {*option_keys(), "gain"}
    if name not in on_device | in_environment:
        known = sorted(key.replace("_", "-") for key in on_device | in_environment)
        raise InputError(f"there is no parameter {quoted(typed)}; {suggestion(typed, known)}")
    if name == "virtual_damping":
        return "environment.damping"
    return f"{'device' if name in on_device else 'environment'}.{name}"


def _options(arguments: argparse.Namespace, motion: str) -> dict[str, Any]:
    length, speed = (GLOSSARY[name].unit_for(motion) for name in ("position", "velocity"))
    units = {"penetration": length, "speed": speed, "tolerance": "1", "effort": "1", "seconds": "s"}
    options: dict[str, Any] = {
        "force_limit": arguments.count_force_limit,
        "force_resolution": arguments.count_force_resolution,
        "contact": contact(arguments),
    }
    typed = {name: text for name in units if (text := getattr(arguments, name)) is not None}
    options |= {name: parse_number(text, units[name], name) for name, text in typed.items()}
    for name in ("effort", "seconds"):
        if options.get(name, 1) <= 0:
            raise InputError(f"{name} must be > 0, got {getattr(arguments, name)}: the search takes some")
    return options


def _json(bracket: Bracket) -> str:
    """The bracket without the storage function, which is as large as the grid; --save writes it."""
    from zwidth.quantity.text import to_json

    document = bracket.to_dict()
    if bracket.storage is not None:
        del document["certificate"]
    return to_json(document)
