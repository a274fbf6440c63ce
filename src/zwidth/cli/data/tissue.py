"""The command `tissue`: a tissue from a spreadsheet, and how much of it a device may render."""

from __future__ import annotations

import argparse
from functools import partial
from typing import TYPE_CHECKING, Any

from zwidth.cli.data.results import FittedTissue, OnDevice
from zwidth.cli.decision import decided, device_of_one_value, exit_status, of_one_timing, ranges_of
from zwidth.cli.options import IN_FULL, as_options, device_parameters, given, look_for, output, pairs_of
from zwidth.cli.output import print_found, printed, targets
from zwidth.errors import InputError
from zwidth.missing import suggestion
from zwidth.model.specification.table import quoted

if TYPE_CHECKING:
    from pathlib import Path

    from zwidth.data.tissue import TissueTest
    from zwidth.model.device import Device
    from zwidth.model.device.catalogue import DeviceInRange
    from zwidth.passivity.bracket import Bracket


QUANTITIES = ("time", "indentation", "force")
KINDS = ("relaxation", "creep", "loading")
ZEROS = ("fitted", "exact")
DISCRETIZATIONS = ("backward", "tustin", "forward", "zoh", "impulse", "matched")

LEVEL = 0.95
"""How often the box of intervals that is checked holds the tissue."""


USAGE = (
    "TEST [DEVICE] [--column QUANTITY=NAME ...] [--unit QUANTITY=UNIT ...] [--sheet NAME] "
    "[--kind KIND] [--trial N] [--model MODEL ...] [--zero KIND] [--discretization RULE] [--scaled] "
    "[--PARAMETER VALUE ...] [--all] [--json] [--plot FILE] [-o FILE] [--force]"
)
OPTIONS = (
    {
        "test=TEST": "what a probe in tissue measured, in a file of any format",
        "device=DEVICE?": "device of the catalogue, or TOML file with a [device] table, that shall render "
        "the tissue",
    },
    "test",
    {
        "--column QUANTITY=NAME... > columns": f"column of {', '.join(QUANTITIES)} (repeatable)",
        "--unit QUANTITY=UNIT... > units": "unit of a column where the file does not state it (repeatable)",
        "--kind KIND": f"{', '.join(KINDS)} (default: as the data say)",
        "--sheet NAME": "of a workbook (default: each that holds a test is a trial)",
        "--trial N": "which of several in the file, from 1 (default: 1)",
        "--zero KIND": "of the force, and of the depth in creep: fitted (default) or exact",
    },
    "model",
    {
        "--model MODEL...": "fit this one alone, or several (default: all)",
        "--discretization RULE": f"how the device shall run it: {', '.join(DISCRETIZATIONS)} (default: "
        f"{DISCRETIZATIONS[0]})",
        "--scaled": "save the largest scale of the tissue that is proved passive on DEVICE, not the tissue",
    },
    "output",
    {
        **output("the numbers", "the plot", "the tissue as an environment in TOML, for zwidth check"),
        **IN_FULL,
    },
    "device: override what DEVICE says, or replace it",
    device_parameters,
)


def run(arguments: argparse.Namespace) -> int:
    """`zwidth tissue`: 0; with a device that of `zwidth check` of the tissue on it."""
    look_for([arguments.test], _sources(arguments))
    plot, save = targets(arguments.plot, arguments.save, arguments.force)
    _check(arguments, save)
    found = _found(arguments)
    if save is not None:
        _save(found, save, arguments.scaled)
    if plot is not None:
        found.test.plot(plot)
    report = printed("data.tissue_report:print_tissue", found, arguments.in_full)
    print_found(arguments.json, partial(_json, found), report, save, plot)
    return 0 if found.wall is None else exit_status(found.wall.verdict.outcome)


def _check(arguments: argparse.Namespace, save: Path | None) -> None:
    """Refuse what cannot be, before anything is computed."""
    for option, value, allowed in (
        ("--kind", arguments.kind, KINDS),
        ("--zero", arguments.zero, ZEROS),
        ("--discretization", arguments.discretization, DISCRETIZATIONS),
    ):
        if value is not None and value not in allowed:
            raise InputError(f"{option}: there is no {quoted(value)}; {suggestion(value, allowed)}")
    if save is not None and save.suffix.lower() != ".toml":
        raise InputError(f"--save: a tissue is saved as TOML, my-tissue.toml; got {quoted(save.name)}")
    if arguments.scaled and (not _names_device(arguments) or save is None):
        raise InputError("--scaled is of a file and a device: give DEVICE, and -o FILE")


def _found(arguments: argparse.Namespace) -> FittedTissue:
    from zwidth.data.tissue import read_test

    in_range = _device(arguments) if _names_device(arguments) else None
    options: dict[str, Any] = {
        "columns": pairs_of("--column", arguments.columns, QUANTITIES),
        "units": pairs_of("--unit", arguments.units, QUANTITIES),
    }
    with as_options():
        test = read_test(
            arguments.test,
            **options,
            kind=arguments.kind,
            trial=_number(arguments.trial),
            models=tuple(arguments.model or ()),
            zero=arguments.zero or "fitted",
            sheet=arguments.sheet,
        )
    rule: Any = arguments.discretization or DISCRETIZATIONS[0]
    return FittedTissue(test, rule, None if in_range is None else _wall(test, in_range, rule))


def _names_device(arguments: argparse.Namespace) -> bool:
    return arguments.device is not None or bool(_words(arguments))


def _words(arguments: argparse.Namespace) -> dict[str, str]:
    return given(arguments, [parameter.key for parameter in device_parameters()])


def _sources(arguments: argparse.Namespace) -> list[str]:
    return [] if arguments.device is None else [arguments.device]


def _device(arguments: argparse.Namespace) -> DeviceInRange:
    from zwidth.model.specification.read import read_tables, specified_in_range

    found = specified_in_range(read_tables(_sources(arguments), ("device",)), _words(arguments))
    if found.device.motion != "linear":
        raise InputError(
            f"{found.device.name} turns, and a tissue is pushed along a line: give a device whose motion is "
            "linear"
        )
    return found


def _number(typed: str | None) -> int | None:
    if typed is None:
        return None
    if not typed.strip().isdecimal() or int(typed) < 1:
        raise InputError(f"--trial is a whole number from 1, got {quoted(typed)}")
    return int(typed)


def _wall(test: TissueTest, found: DeviceInRange, rule: Any) -> OnDevice:
    """The tissue on the device, its largest passive scale, and all that the intervals allow.

    The verdicts are of every value of the device's intervals; the scale is looked for at their worst ends.
    """
    from zwidth.model.specification.read import Specification

    loop = of_one_timing(Specification(found.device, test.environment(rule), found.ranges))
    device = loop.device
    verdict = decided(loop)
    asked = OnDevice(device, verdict, ranges_of(loop, verdict))
    worst = device_of_one_value(device)
    try:
        bracket, kept = test.wall(worst, rule), test.wall(worst, rule, "kept")
    except InputError as error:  # a contact that nothing decides on this device
        return asked._replace(reason=str(error))
    if (kept.proved_passive or 0) > 1.01 * (bracket.proved_passive or 0):
        asked = asked._replace(kept=kept)
    asked = asked._replace(bracket=bracket)
    if worst is not device:
        known = [one for one in (bracket, asked.kept) if one is not None and one.proved_passive is not None]
        throughout: dict[str, bool] = {
            one.scope.contact: _is_proved(test, device, rule, one) for one in known
        }
        asked = asked._replace(throughout=throughout)
    try:
        box = test.environment(rule, level=LEVEL)
    except InputError:  # intervals that are not to be trusted: the report says which
        return asked
    return asked._replace(box=decided(Specification(device, box)))


def _is_proved(test: TissueTest, device: Device, rule: Any, bracket: Bracket) -> bool:
    """Whether the scale that is proved at the worst ends of intervals is proved of all between, too."""
    from zwidth.passivity.check import check_by_closed_forms

    law = test.scaled(bracket.proved_passive or 0, rule)
    if not law.has_transfer_function:
        return False
    return check_by_closed_forms(device, law, contact=bracket.scope.contact).outcome == "passive"


def _save(found: FittedTissue, path: Path, scaled: bool) -> None:
    """The environment with its intervals above it, as comments."""
    from zwidth.model.specification.write import written_environment
    from zwidth.quantity.text import in_words
    from zwidth.writing import writing_whole

    law, remark = found.test.environment(found.rule), ""
    if scaled:
        bracket = None if found.wall is None else found.wall.kept or found.wall.bracket
        if found.wall is None or bracket is None or bracket.proved_passive is None:
            raise InputError("--scaled: no scale of this tissue is proved passive on the device")
        law = found.test.scaled(bracket.proved_passive, found.rule)
        device = found.wall.device
        taken = ", ".join(map(in_words, device.assumed))
        on = f"{device.name}{taken and f', {taken} taken as 0'}"
        proved = f"proved passive{found.wall.of_which(bracket)} on {on}"
        remark = f"# Every force times {bracket.proved_passive:.6g}: {proved}.\n"
    numbers = [f"#   {name}: {low_high} {unit}" for name, _, low_high, unit in found.test.parameters()[1:]]
    head = [f"# Tissue of a {found.test.test.kind} test, by zwidth tissue; 95 % intervals:", *numbers]
    with writing_whole(path) as file:
        file.write(("\n".join(head) + "\n" + remark + written_environment(law)).encode())


def _json(found: FittedTissue) -> str:
    from zwidth.quantity.text import to_json

    document = found.test.to_dict()
    wall = found.wall
    if wall is not None:
        document["check"] = wall.verdict.to_dict()
        document["largest_gain"] = {
            "proved_passive": wall.bracket and wall.bracket.proved_passive,
            "proved_passive_while_contact_is_kept": wall.kept and wall.kept.proved_passive,
            "proved_active": wall.bracket and wall.bracket.proved_active,
            "hand": wall.bracket and wall.bracket.hand,
            "for_every_value_of_the_intervals": {k.replace(" ", "_"): v for k, v in wall.throughout.items()},
        }
        if wall.ranges is not None:
            document["ranges"] = wall.ranges.to_dict()
        document["check_of_intervals"] = None if wall.box is None else wall.box.outcome
    return to_json(document)
