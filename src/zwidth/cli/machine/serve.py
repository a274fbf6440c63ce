"""`zwidth serve`: a law rendered on a device in real time."""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from zwidth.cli.machine.serve_tables import (
    CONNECTION,
    OPERATOR,
    SAFETY,
    connection_parameters,
    merged,
    reached,
    safety_parameters,
    told,
)
from zwidth.cli.options import CONTACT, FORCE, LAW, PARAMETERS, contact, given, overrides
from zwidth.cli.output import print_json, print_message, print_report, quiet_pipe, say_written
from zwidth.cli.simulate.tables import operator_parameters
from zwidth.errors import InputError
from zwidth.model.specification.laws import with_laws
from zwidth.model.specification.read import PAIR_TABLES, WITH_LAWS, read_tables, specified
from zwidth.model.specification.table import Table

if TYPE_CHECKING:
    from zwidth.machine.servo import Connection, Servo
    from zwidth.model.device import Device


FACES = ("terminal", "browser", "foxglove")

USAGE = (
    "[SOURCE ...] [--connection TYPE] [--operator TYPE] [--law NAMES] [--PARAMETER VALUE ...] "
    "[--duration TIME] [--watch FACE ...] [--commands] [--anyway] [--json] [-o FILE] [--force]"
)
OPTIONS = (
    {
        "sources=SOURCE*": "device of the catalogue, or TOML file with tables [device], [environment], "
        "[[law]], [connection], [safety], [operator]",
        **LAW,
        **CONTACT,
    },
    "serving",
    {
        "--duration t": "how long [s] (default: until Ctrl-C)",
        "--anyway": "serve what is not proved passive, too",
        "--watch FACE...": f"draw it while it runs: {', '.join(FACES)}; may be given for each",
        "--watch-port N": "port of browser or foxglove",
        "--watch-origin URL": "whose pages may read foxglove, too",
        "--commands": "read changes from standard input while it runs: 'stiffness = 200 N/m', 'law = NAMES', "
        "'stop'",
    },
    "output",
    {"--json": "print the report as JSON, units in the keys", "-o FILE": "record it: .mcap", **FORCE},
    "how the device is reached",
    connection_parameters,
    "limits of what a hand is given",
    safety_parameters,
    "hand of the simulated device",
    operator_parameters,
    *PARAMETERS,
)


SERVED_TABLES = (*WITH_LAWS, OPERATOR, CONNECTION, SAFETY)
OF_A_PAIR = (*PAIR_TABLES, "follower_connection", "follower_operator")
"""Tables of two arms, see `serve_pair`."""

FAULT = 5
"""Exit status where the force ended by itself."""


def run(arguments: argparse.Namespace) -> int:
    """`zwidth serve`: 0 where it ran to its end, 5 where the force ended by a fault, else as `check`."""
    from zwidth.cli.decision import WORST, decided, exit_status, of_one_value
    from zwidth.cli.machine.serve_commands import listen
    from zwidth.machine.servo.proving import NotProved
    from zwidth.machine.servo.safety import read_safety
    from zwidth.machine.servo.serving import serve
    from zwidth.model.specification.read import Specification

    save = _target(arguments)
    faces = _faces(arguments)
    tables = read_tables(arguments.sources, (*SERVED_TABLES, *OF_A_PAIR))
    if any(name in tables for name in OF_A_PAIR):
        return _serve_pair(arguments, tables)
    loop = specified({k: t for k, t in tables.items() if k in WITH_LAWS}, overrides(arguments))
    motion = loop.device.motion
    connection, placement = reached(told(arguments, tables, CONNECTION, connection_parameters), motion)
    of_it = () if connection is None else ("resolution", "sample_period")  # its law counts with its own
    loop = of_one_value(loop, WORST.keys() - of_it)
    law = with_laws(loop.environment, tables.get("law"), arguments.law, motion)
    commands = [partial(listen, arguments)] if arguments.commands else []
    asked = contact(arguments)
    try:
        report = serve(
            loop.device,
            law,
            connection,
            hand=_hand(arguments, tables, loop.device, connection),
            duration=arguments.duration,
            safety=read_safety(told(arguments, tables, SAFETY, safety_parameters), motion),
            placement=placement,
            decide=lambda device, environment: decided(Specification(device, environment), asked),
            anyway=arguments.anyway,
            record=save,
            force=arguments.force,
            watch=(_say_what_is_served, *faces, *commands),
        )
    except NotProved as refused:
        print_message(refused)
        return exit_status(refused.verdict.outcome)
    return _give_out(report, arguments.json, save)


def _serve_pair(arguments: argparse.Namespace, tables: Mapping[str, Table]) -> int:
    from zwidth.cli.decision import exit_status
    from zwidth.cli.machine.serve_pair import served_pair
    from zwidth.machine.servo.pair import PairNotProved

    try:
        report = served_pair(arguments, tables)
    except PairNotProved as refused:
        print_message(refused)
        return exit_status(refused.verdict.outcome)
    return _give_out(report, arguments.json)


def _give_out(report: Any, as_json: bool, save: Path | None = None) -> int:
    """Print what a servo did, and where it is recorded; 5 where it failed."""
    if as_json:
        print_json(json.dumps(report.to_dict(), indent=2, ensure_ascii=False, allow_nan=False))
    else:
        print_report(report.report())
        say_written(save)
    return FAULT if report.failed else 0


def _say_what_is_served(servo: Servo) -> Callable[[], Any]:
    from zwidth.machine.servo.proving import claimed

    assert servo.measured is not None
    assert servo.verdict is not None
    with quiet_pipe(sys.stderr):
        print(servo.measured, file=sys.stderr)
        print(f"{servo.verdict.outcome}: {claimed(servo.verdict)}", file=sys.stderr)
        print(
            f"{servo.connection.describe()}\nif nothing comes any more: {servo.connection.on_silence}\n"
            f"serving {servo.rows.title}; Ctrl-C ends it",
            file=sys.stderr,
        )
    return lambda: None


def _faces(arguments: argparse.Namespace) -> list[Callable[[Servo], Callable[[], Any]]]:
    wanted = arguments.watch or []
    unknown = [face for face in wanted if face not in FACES]
    if unknown:
        raise InputError(f"--watch is one of {', '.join(FACES)}, got {unknown[0]!r}")
    if len(set(wanted)) < len(wanted):
        raise InputError("--watch names a face twice")
    port, origin = _port(arguments.watch_port, wanted), _origin(arguments.watch_origin, wanted)
    return [partial(begin_watching, face, port, origin if face == "foxglove" else {}) for face in wanted]


def _port(typed: str | None, wanted: list[str]) -> dict[str, Any]:
    if typed is None:
        return {}
    if sum(face != "terminal" for face in wanted) != 1:
        raise InputError("--watch-port goes with one of --watch browser and --watch foxglove")
    if not typed.isdecimal() or not 0 <= int(typed) < 65536:
        raise InputError(f"--watch-port is a port from 1 to 65535, or 0 for any that is free, got {typed!r}")
    return {"port": int(typed)}


def _origin(typed: str | None, wanted: list[str]) -> dict[str, Any]:
    if typed is None:
        return {}
    from zwidth.machine.servo.live.page import checked_origin

    if "foxglove" not in wanted:
        raise InputError("--watch-origin goes with --watch foxglove")
    return {"origin": checked_origin(typed)}


def begin_watching(
    face: str, port: dict[str, Any], origin: dict[str, Any], servo: Servo
) -> Callable[[], Any]:
    """Open a face on what is served; returns what closes it."""
    from zwidth.machine.servo import live

    if face == "terminal":
        return _in_terminal(servo)
    page = (live.open_page if face == "browser" else live.serve_foxglove)(servo.rows, **port, **origin)
    with quiet_pipe(sys.stderr):
        print(f"live at {page.address}", file=sys.stderr)
    return page.close


def _in_terminal(servo: Servo) -> Callable[[], Any]:
    from threading import Event, Thread

    from zwidth.machine.servo.live import watch_in_terminal

    stop = Event()
    drawing = Thread(target=watch_in_terminal, args=(servo.rows, stop), daemon=True)
    drawing.start()

    def end() -> None:
        stop.set()
        drawing.join()

    return end


def _hand(
    arguments: argparse.Namespace, tables: Mapping[str, Table], device: Device, connection: Connection | None
) -> Any:
    from zwidth.cli.simulate.tables import THROWN, build_hand, operator_parameters
    from zwidth.model.operator import HandsOff

    typed = given(arguments, [p.key for p in operator_parameters()])
    if OPERATOR not in tables and not typed:
        return None
    if connection is not None:
        raise InputError(f"[{OPERATOR}] holds the simulated device; a real one is held by a person: drop it")
    hand = build_hand(merged(tables.get(OPERATOR), typed, OPERATOR), device, OPERATOR)
    if isinstance(hand, HandsOff):
        raise InputError(
            "hands-off moves nothing, and a served device begins at rest; one that is let go on its way: "
            f'zwidth simulate … --operator hands-off --initial-velocity "{THROWN[device.motion]}"'
        )
    return hand


def _target(arguments: argparse.Namespace) -> Path | None:
    if arguments.save is None:
        return None
    from zwidth.machine.servo.recording.recorder import check_recording

    path = Path(arguments.save)
    check_recording(path, arguments.force)
    return path
