"""The command `diagnose`: why did it shake?"""

from __future__ import annotations

import argparse
import json
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from zwidth.cli.options import (
    IN_FULL,
    LAW,
    PARAMETERS,
    SHEET,
    as_typed,
    device_parameters,
    given,
    look_for,
    output,
    overrides,
    reading_of,
)
from zwidth.cli.output import print_found, targets
from zwidth.errors import InputError
from zwidth.model.specification.table import quoted

if TYPE_CHECKING:
    from zwidth.data.diagnosis import Diagnosis, PairDiagnosis
    from zwidth.model.device import Device
    from zwidth.model.environment import Environment
    from zwidth.model.pairs import Pair

_DEVICE = [p.key for p in device_parameters()]
_OF_AN_ARM = ("position", "commanded_force", "actuator_force")
_QUANTITIES = (
    "time",
    *_OF_AN_ARM,
    "target_position",
    *(f"{arm}_{name}" for arm in ("leader", "follower") for name in _OF_AN_ARM),
)


USAGE = (
    "LOG [SOURCE ...] [--column QUANTITY=NAME ...] [--unit QUANTITY=UNIT ...] [--sheet NAME] "
    "[--law NAMES] [--PARAMETER VALUE ...] [--all] [--json] [--plot FILE] [-o FILE] [--force]"
)
OPTIONS = (
    {
        "log=LOG": "a recording of it shaking, in a file of any format",
        "sources=SOURCE*": "device of the catalogue, or TOML file with a [device] table, and an "
        "[environment] if the law is known; of two arms as for zwidth pair",
        **LAW,
    },
    "log",
    {
        "--column QUANTITY=NAME... > columns": "column of time, position, commanded_force, actuator_force, "
        "target_position (repeatable)",
        "--unit QUANTITY=UNIT... > units": "unit of a column where neither file nor name states it "
        "(repeatable)",
        "--scale QUANTITY=FACTOR...": "what a number in a column stands for: actuator_force='2 N/A' "
        "(repeatable)",
        "--log-rate 1/T": "rows per second, where the log has no time [Hz]",
        **SHEET,
    },
    "output",
    {
        **output(
            "the numbers",
            "the plot",
            "the loop with the number changed as TOML, for zwidth check (zwidth pair)",
        ),
        **IN_FULL,
    },
    *PARAMETERS,
)


def run(arguments: argparse.Namespace) -> int:
    """`zwidth diagnose`: 0 where the cause is named, 3 where the data do not say."""
    look_for([arguments.log], arguments.sources)
    plot, save = targets(arguments.plot, arguments.save, arguments.force)
    if save is not None and save.suffix.lower() != ".toml":
        raise InputError(f"--save: the loop is saved as TOML, mended.toml; got {quoted(save.name)}")
    found = _diagnosed(arguments)
    if save is not None:
        found.save(save, force=True)
    if plot is not None:
        found.plot(plot, force=True)
    from zwidth.cli.data.diagnosis_report import command, print_diagnosis

    def document() -> str:
        whole = {**found.to_dict(), "command": command(found, arguments)}
        return json.dumps(whole, indent=2, ensure_ascii=False)

    print_found(arguments.json, document, partial(print_diagnosis, found, arguments), save, plot)
    return 0 if found.cause is not None else 3


def _diagnosed(arguments: argparse.Namespace) -> Diagnosis | PairDiagnosis:
    from zwidth.data.diagnosis import diagnose, diagnose_pair
    from zwidth.data.diagnosis.pairs.recording import holds_two_arms

    reading = reading_of(arguments, _QUANTITIES)
    if arguments.log_rate is not None:
        reading["sample_rate"] = arguments.log_rate
    if arguments.sheet is not None:
        reading["sheet"] = arguments.sheet
    try:
        if holds_two_arms(Path(arguments.log), reading.get("columns"), arguments.sheet):
            return diagnose_pair(Path(arguments.log), _pair_of_arms(arguments), **reading)
        device, law = _loop(arguments)
        if device is not None and device.resolution != 0:
            reading["resolution"] = device.resolution
        return diagnose(Path(arguments.log), device, law=law, **reading)
    except InputError as error:
        raise InputError(as_typed(str(error).replace("sample_rate or sample_period", "--log-rate"))) from None


def _pair_of_arms(arguments: argparse.Namespace) -> Pair | None:
    """Both arms; whatever spring joins them is not taken from there."""
    if words := overrides(arguments):
        raise InputError(
            f"--{next(iter(words)).replace('_', '-')}: {Path(arguments.log).name} holds two arms; give their "
            "numbers as SOURCE, one file for both or leader and follower"
        )
    if not arguments.sources:
        return None
    from zwidth.model.specification.load import load_pair

    return load_pair(arguments.sources, {"stiffness": "1"})


def _loop(arguments: argparse.Namespace) -> tuple[Device | None, Environment | None]:
    """The device, and the law that was programmed, as far as they are known."""
    words = overrides(arguments)
    if not words and not arguments.sources:
        return None, None
    from zwidth.cli.decision import asked, device_of_one_value, of_one_value
    from zwidth.model.specification.read import WITH_LAWS, read_tables, specified_in_range

    tables = read_tables(arguments.sources, WITH_LAWS)
    if "environment" in tables or arguments.law or len(given(arguments, _DEVICE)) < len(words):
        loop = of_one_value(asked(arguments).loop)
        return loop.device, loop.environment
    return device_of_one_value(specified_in_range(tables, words).device), None
