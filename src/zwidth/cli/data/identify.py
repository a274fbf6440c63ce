"""The command `identify`: a device from a log of its motion."""

from __future__ import annotations

import argparse
from functools import partial
from pathlib import Path
from typing import Any

from zwidth.cli.data.results import Identification
from zwidth.cli.decision import decided, exit_status
from zwidth.cli.options import (
    BEHIND,
    IN_FULL,
    SHEET,
    as_options,
    both_environments,
    environment_parameters,
    given,
    look_for,
    output,
    reading_of,
)
from zwidth.cli.output import print_found, printed, targets
from zwidth.errors import InputError
from zwidth.model.specification.table import quoted
from zwidth.quantity.text import shown

QUANTITIES = ("time", "position", "hand_force", "actuator_force")
"""What a column may hold."""

ZEROS = ("drifts", "constant", "exact")
MODELS = {"coulomb-viscous": "Coulomb and viscous", "viscous": "viscous"}

USAGE = (
    "LOG [LOG ...] [SOURCE] [--column QUANTITY=NAME ...] [--unit QUANTITY=UNIT ...] "
    "[--PARAMETER VALUE ...] [--all] [--json] [--plot FILE] [-o FILE] [--force]"
)
OPTIONS = (
    {
        "log=LOG": "what the device recorded, in a file of any format",
        "sources=SOURCE*": "further logs of the same device; a TOML file with an [environment] table to "
        "check",
    },
    "log",
    {
        "--column QUANTITY=NAME... > columns": f"column of {', '.join(QUANTITIES)}; NAME none leaves it out "
        "(repeatable)",
        "--unit QUANTITY=UNIT... > units": "unit of a column where neither file nor name states it "
        "(repeatable)",
        "--scale QUANTITY=FACTOR...": "what a number in a column stands for: hand_force='2 N/V' (repeatable)",
        "--rate 1/T > sample_rate": "samples per second, where the log has no time [Hz]",
        "--sample-period T": "time between two samples, instead [s]",
        "--resolution Δ": "one encoder count [m; rotary rad]",
        "--counts-per-turn N": "encoder counts in one turn, instead",
        **SHEET,
        "--motion MOTION": "linear or rotary, where the unit of the position does not say it",
    },
    "device",
    {
        "--mass m": "where it is known; needed where the log has no force [kg; rotary kg*m^2]",
        "--delay τ": "from a sample to the actuator force computed from it [s]",
        "--zero KIND": f"of the force: {', '.join(ZEROS)} (default: drifts where a hand's force is logged)",
        "--model MODEL": f"{' or '.join(MODELS)} (default: {next(iter(MODELS))})",
        "--confidence RATIO": "of the intervals that are checked and saved (default: 99%)",
    },
    "output",
    {**output("the numbers", "the plot", "the device as TOML, for zwidth check"), **IN_FULL},
    "environment: what to check the device with, at once",
    both_environments,
)


def run(arguments: argparse.Namespace) -> int:
    """`zwidth identify`: 0; with an environment that of `zwidth check`, "undecided" of a wrong model."""
    look_for((arguments.log, *_further_logs(arguments)), _specifications(arguments))
    plot, save = targets(arguments.plot, arguments.save, arguments.force)
    if save is not None and save.suffix.lower() != ".toml":
        raise InputError(f"--save: a device is saved as TOML, my-device.toml; got {quoted(save.name)}")
    confidence = _confidence(arguments.confidence)
    found = _found(arguments, confidence)
    if save is not None:
        found.identified.save(save, confidence, force=True, **found.others)
    if plot is not None:
        found.identified.plot(plot, force=True)
    report = printed("data.identification_report:print_identified", found, arguments.in_full)
    print_found(arguments.json, partial(_json, found), report, save, plot)
    if found.environment is None:
        return 0
    return exit_status("undecided" if found.verdict is None else found.verdict.outcome)


def _found(arguments: argparse.Namespace, confidence: float) -> Identification:
    from zwidth.data.identification.device.identify import identify, log_from
    from zwidth.data.logs import Log
    from zwidth.progress import progress_bar

    options = _options(arguments)
    environment_of = _environment(arguments)
    with as_options():
        reading = _reading(arguments)
        logs = [log_from(Path(name), **reading) for name in (arguments.log, *_further_logs(arguments))]
        log = logs[0] if len(logs) == 1 else Log.concatenate(logs)
        environment = environment_of(log.motion)
        with progress_bar("samples") as progress:
            identified = identify(log, **options, progress=progress)
    others = {"delay": options["delay"]} if "delay" in options else {}
    if environment is None:
        return Identification(log, identified, confidence, others, None, None, None)
    if identified.shows("wrong model"):
        return Identification(log, identified, confidence, others, environment, None, None)
    from zwidth.model.specification.read import Specification

    verdict = decided(Specification(identified.device(confidence, **others), environment))
    passive_for = identified.confidence(environment, **others)
    return Identification(log, identified, confidence, others, environment, passive_for, verdict)


def _further_logs(arguments: argparse.Namespace) -> list[str]:
    """What stands behind the first log and is no specification."""
    return [name for name in arguments.sources if not name.lower().endswith(".toml")]


def _specifications(arguments: argparse.Namespace) -> list[str]:
    return [name for name in arguments.sources if name.lower().endswith(".toml")]


def _reading(arguments: argparse.Namespace) -> dict[str, Any]:
    reading = reading_of(arguments, QUANTITIES)
    for name in ("sample_rate", "sample_period", "resolution", "counts_per_turn", "sheet", "motion"):
        if getattr(arguments, name) is not None:
            reading[name] = getattr(arguments, name)
    if reading.get("motion", "linear") not in ("linear", "rotary"):
        raise InputError(f"--motion is linear or rotary, got {quoted(reading['motion'])}")
    return reading


def _options(arguments: argparse.Namespace) -> dict[str, Any]:
    options = {name: getattr(arguments, name) for name in ("mass", "delay") if getattr(arguments, name)}
    if arguments.zero is not None:
        if arguments.zero not in ZEROS:
            raise InputError(f"--zero is {', '.join(ZEROS)}; got {quoted(arguments.zero)}")
        options["zero"] = arguments.zero
    if arguments.model is not None:
        if arguments.model not in MODELS:
            raise InputError(f"--model is {' or '.join(MODELS)}; got {quoted(arguments.model)}")
        options["model"] = MODELS[arguments.model]
    return options


def _confidence(typed: str | None) -> float:
    """0.99 from "99%", "99 %" or "0.99"."""
    from zwidth.data.identification.device.estimate import MOST_CONFIDENCE
    from zwidth.quantity.units import parse_number

    if typed is None:
        return 0.99
    bare = typed.strip().removesuffix("%")
    number = float(parse_number(bare, "1", "confidence")) / (100 if bare != typed.strip() else 1)
    if not 0 < number <= MOST_CONFIDENCE:
        raise InputError(
            f"--confidence must be > 0 and ≤ {shown(MOST_CONFIDENCE, '%', 6)}, got {quoted(typed)}: it "
            "is how often the stated intervals hold the truth; 99% is usual"
        )
    return number


def _environment(arguments: argparse.Namespace) -> Any:
    """What makes the environment to check, once the motion is known; None of it where none was given."""
    from zwidth.model.specification.environments import build_environment
    from zwidth.model.specification.read import environment_table, read_tables

    keys = [p.key for p in environment_parameters()]
    words = given(arguments, (*keys, *(BEHIND + key for key in keys)))
    tables = read_tables(_specifications(arguments))
    if "device" in tables:
        raise InputError(
            f"{tables['device'].label} gives a device, and here the device comes from the log; "
            "leave an [environment] alone in the file"
        )
    if not words and not tables:
        return lambda motion: None
    table = environment_table(tables, words)
    return lambda motion: build_environment(table, motion)


def _json(found: Identification) -> str:
    from zwidth.quantity.text import to_json

    document = {
        **found.identified.to_dict(found.confidence),
        "log": {
            "samples": found.log.samples,
            "runs": found.log.runs,
            "duration_s": found.log.duration,
            "channels": list(found.log.channels),
        },
    }
    if found.verdict is not None:
        document["passive_for"] = found.passive_for
        document["check"] = found.verdict.to_dict()
    return to_json(document)
