"""What is typed while `zwidth serve --commands` runs: a line on standard input changes the law, or ends it.

stiffness = 200 N/m             a parameter of the environment, under its name as an option
law = passivity-controller      the laws in its chain; nothing behind the sign: none
stop
"""

from __future__ import annotations

import argparse
import sys
import threading
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, TextIO

from zwidth.cli.options import environment_parameters, overrides
from zwidth.cli.output import quiet_pipe
from zwidth.errors import InputError
from zwidth.missing import suggestion
from zwidth.model.specification.laws import with_laws
from zwidth.model.specification.read import WITH_LAWS, read_tables, specified
from zwidth.model.specification.table import plain, quoted

if TYPE_CHECKING:
    from zwidth.machine.servo import Servo
    from zwidth.model.environment.environment import Environment


def listen(arguments: argparse.Namespace, servo: Servo) -> Callable[[], Any]:
    """Read lines from now on, in a thread that ends with the program."""
    threading.Thread(target=_read, args=(arguments, servo, sys.stdin), daemon=True).start()
    return lambda: None


def _read(arguments: argparse.Namespace, servo: Servo, lines: TextIO) -> None:
    typed: dict[str, str] = {}
    for line in lines:
        try:
            _obey(line.strip(), typed, arguments, servo)
        except InputError as error:
            _say(str(error))


def _obey(line: str, typed: dict[str, str], arguments: argparse.Namespace, servo: Servo) -> None:
    if line == "stop":
        servo.stop()
    elif line:
        name, sign, value = (part.strip() for part in line.partition("="))
        key = name.replace("-", "_")
        known = [p.key for p in environment_parameters()]
        if not sign or key not in (*known, "law"):
            hint = suggestion(key, ("stop", "law", *known))
            raise InputError(f"{quoted(line)} is neither stop nor a parameter with = and a value; {hint}")
        wanted = {**typed, key: value}
        verdict = servo.change(_environment(arguments, wanted), anyway=arguments.anyway)
        typed[key] = value
        _say(f"{verdict.outcome}: {verdict.claim} It begins where both forces are near 0")


def _environment(arguments: argparse.Namespace, typed: dict[str, str]) -> Environment:
    """That of the sources and options, with what was typed in their place."""
    tables = read_tables(arguments.sources, (*WITH_LAWS, "operator", "connection", "safety"))
    given = {key: value for key, value in typed.items() if key != "law"}
    loop = specified({k: t for k, t in tables.items() if k in WITH_LAWS}, {**overrides(arguments), **given})
    if "law" not in typed:
        return with_laws(loop.environment, tables.get("law"), arguments.law, loop.device.motion)
    laws = [typed["law"]] if typed["law"] else None
    return with_laws(loop.environment, None, laws, loop.device.motion)


def _say(text: str) -> None:
    with quiet_pipe(sys.stderr):
        print(f"zwidth: {plain(text, 500)}", file=sys.stderr)
