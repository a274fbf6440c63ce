"""`zwidth emit`: a law that was proved, as text for the machine that will run it."""

from __future__ import annotations

import argparse
from functools import partial
from typing import TYPE_CHECKING

from zwidth.cli.decision import decided, exit_status
from zwidth.cli.options import (
    Once,
    add_contact_option,
    add_law_option,
    add_parameters,
    contact,
    overrides,
)
from zwidth.cli.output import print_json, print_message
from zwidth.errors import InputError

if TYPE_CHECKING:
    from pathlib import Path

    from zwidth.machine.firmware.emit import Emitted
    from zwidth.model.device import Device
    from zwidth.model.environment.environment import Environment
    from zwidth.passivity.verdict import Verdict


def configure(parser: argparse.ArgumentParser) -> None:
    """The arguments of `zwidth emit`."""
    from zwidth.machine.firmware.targets import TARGETS

    parser.usage = (
        "%(prog)s [SOURCE ...] [--law NAMES] [--PARAMETER VALUE ...] [--target NAME] [--number TYPE] "
        "[--travel 'LOW .. HIGH'] [--contact KIND] [--anyway] [--json] -o DIRECTORY [--force]"
    )
    parser.add_argument(
        "sources",
        metavar="SOURCE",
        nargs="*",
        help="device of the catalogue, or TOML file with a [device] table, an [environment] table or both",
    )
    add_law_option(parser)
    add_contact_option(parser)
    target = parser.add_argument_group("target")
    names = ", ".join(TARGETS)
    target.add_argument("--target", metavar="NAME", action=Once, help=f"{names} (default: c99)")
    target.add_argument(
        "--number",
        metavar="TYPE",
        action=Once,
        help="double, float or fixed (default: fixed for arduino, float for cortex-m and simplefoc, "
        "else double)",
    )
    target.add_argument(
        "--travel",
        metavar="'LOW .. HIGH'",
        action=Once,
        help="lowest and highest position, such as '-50 .. 50 mm' (default: 32767 counts to each side, in "
        "double whatever 32 bits count)",
    )
    target.add_argument(
        "--force-unit",
        metavar="U",
        action=Once,
        help="unit of the force in fixed point, where the device has no force resolution [N; rotary N*m]",
    )
    target.add_argument(
        "--prefix", metavar="NAME", action=Once, help="what every name begins with (default: law)"
    )
    target.add_argument("--anyway", action="store_true", help="write what is not proved passive, too")
    output = parser.add_argument_group("output")
    output.add_argument("--json", action="store_true", help="print the report as JSON, units in the keys")
    output.add_argument("-o", "--save", metavar="DIRECTORY", action=Once, help="where the files are written")
    output.add_argument("--force", action="store_true", help="replace files that exist")
    add_parameters(parser)


def run(arguments: argparse.Namespace) -> int:
    """`zwidth emit`: 0 where the files are written, else as `check`."""
    from zwidth.machine.firmware.emit import NotEmitted, emit
    from zwidth.model.specification.laws import with_laws
    from zwidth.model.specification.read import WITH_LAWS, read_tables, specified

    if arguments.save is None:
        raise InputError("say where the files go: -o DIRECTORY")
    tables = read_tables(arguments.sources, WITH_LAWS)
    loop = specified(tables, overrides(arguments))
    law = with_laws(loop.environment, tables.get("law"), arguments.law, loop.device.motion)
    try:
        found = emit(
            loop.device,
            law,
            target=arguments.target or "c99",
            number=arguments.number,
            travel=arguments.travel,
            force_unit=arguments.force_unit,
            prefix=arguments.prefix or "law",
            anyway=arguments.anyway,
            decide=partial(_decided, contact(arguments)),
        )
    except NotEmitted as refused:
        print_message(refused)
        return exit_status(refused.judged.outcome)
    _give_out(found, found.write(arguments.save, force=arguments.force), arguments.json)
    return 0


def _decided(asked: str, device: Device, environment: Environment) -> Verdict:
    from zwidth.model.specification.read import Specification

    return decided(Specification(device, environment), asked)


def _give_out(found: Emitted, written: list[Path], as_json: bool) -> None:
    if as_json:
        print_json(found.to_json())
        return
    from zwidth.cli.emit_report import print_emitted

    print_emitted(found, written)
