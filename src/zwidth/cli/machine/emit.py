"""`zwidth emit`: a law that was proved, as text for the machine that will run it."""

from __future__ import annotations

import argparse
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from zwidth.cli.decision import asked, decided, exit_status
from zwidth.cli.options import CONTACT, FORCE, LAW, LOOP, PARAMETERS, contact
from zwidth.cli.output import print_json, print_message, say_written
from zwidth.errors import InputError

if TYPE_CHECKING:
    from zwidth.machine.firmware.emit import Emitted
    from zwidth.model.device import Device
    from zwidth.model.environment.environment import Environment
    from zwidth.passivity.verdict import Verdict


USAGE = (
    "[SOURCE ...] [--law NAMES] [--PARAMETER VALUE ...] [--target NAME] [--number TYPE] "
    '[--travel "LOW .. HIGH"] [--contact KIND] [--anyway] [--json] -o DIRECTORY [--force]'
)


def _target() -> dict[str, str]:
    from zwidth.machine.firmware.targets import TARGETS

    return {"--target NAME": f"{', '.join(TARGETS)} (default: c99)"}


OPTIONS = (
    {"sources=SOURCE*": LOOP, **LAW, **CONTACT},
    "target",
    _target,
    {
        "--number TYPE": "double, float or fixed (default: fixed for arduino, float for cortex-m and "
        "simplefoc, else double)",
        '--travel "LOW .. HIGH"': "lowest and highest position, such as '-50 .. 50 mm' (default: 32767 "
        "counts to each side, in double whatever 32 bits count)",
        "--force-unit U": "unit of the force in fixed point, where the device has no force resolution [N; "
        "rotary N*m]",
        "--prefix NAME": "what every name begins with (default: law)",
        "--anyway": "write what is not proved passive, too",
    },
    "output",
    {
        "--json": "print the report as JSON, units in the keys",
        "-o DIRECTORY": "where the files are written",
        **FORCE,
    },
    *PARAMETERS,
)


def run(arguments: argparse.Namespace) -> int:
    """`zwidth emit`: 0 where the files are written, else as `check`."""
    from zwidth.machine.firmware.emit import NotEmitted, emit

    if arguments.save is None:
        raise InputError("say where the files go: -o DIRECTORY")
    loop = asked(arguments).loop
    try:
        found = emit(
            loop.device,
            loop.environment,
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
    _give_out(found, found.write(arguments.save, force=arguments.force, how="--force"), arguments.json)
    return 0


def _decided(contact: str, device: Device, environment: Environment) -> Verdict:
    from zwidth.model.specification.read import Specification

    return decided(Specification(device, environment), contact)


def _give_out(found: Emitted, written: list[Path], as_json: bool) -> None:
    if as_json:
        print_json(found.to_json())
        return
    from zwidth.cli.page import below, claimed, grid, items, page, section

    law = ("law", found.environment.describe(found.device.motion))
    with page() as out:
        out.print(claimed(found.judged.outcome, found.claim))
        out.print(below(grid([law, *found.numbers])))
        section(out, "assumes", items(found.beside, "dim"))
    say_written(*written)
