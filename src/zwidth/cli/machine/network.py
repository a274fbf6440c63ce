"""`zwidth network`: a scene in several processes, with the devices that hold it."""

from __future__ import annotations

import argparse
import json
import signal
import subprocess
import sys
import time
from collections.abc import Iterable, Mapping
from contextlib import nullcontext
from pathlib import Path
from typing import TYPE_CHECKING

from zwidth.cli.output import print_json, print_report
from zwidth.errors import InputError
from zwidth.quantity.exact import Exact
from zwidth.quantity.glossary import GLOSSARY
from zwidth.quantity.parameter import read_number
from zwidth.quantity.text import shown

if TYPE_CHECKING:
    from zwidth.cli.machine.network_plan import Plan
    from zwidth.machine.network.peer import Peer

FORMAT = "zwidth network 1"

_DURATION = "10 s"

_LOOK = 0.1
"""Between two looks at whether a process has ended [s]."""

_OFTEN = 1.0
"""Between two lines of what is seen [s]."""

_MEETING = 20.0
"""How long a process waits for those at the other ends of its lines [s]."""

_LONGEST_WAIT = 5.0
"""How long a process that was told to end may take [s]."""


OPTIONS = (
    {
        "file=FILE": "a TOML file with [environment] and [network]",
        "--run NAME": "run this part or device alone, here",
        "--plan": "say which parts and lines there are, and end",
        "--json": "print what was seen as JSON, units in the keys",
        "--duration t": f"how long (default: {_DURATION})",
    },
)


def run(arguments: argparse.Namespace) -> int:
    """Run all processes, or one of them."""
    from zwidth.cli.machine.network_plan import load_plan

    if arguments.plan and (arguments.run or arguments.duration):
        raise InputError("--plan runs nothing: leave out --run and --duration")
    plan = load_plan(Path(arguments.file))
    typed = arguments.duration or _DURATION
    duration = read_number(typed, GLOSSARY["sample_period"], "--duration", bound="> 0", why="0 has no step")
    if arguments.plan:
        devices = (f"{name}: {held.describe()}" for name, held in plan.devices.items())
        lines = (f"{name}: {line.channel}" for name, line in plan.lines.items())
        print_report([*plan.cut.report(), "", *devices, *lines])
        return 0
    if arguments.run:
        return _one(plan, arguments.run, duration, arguments.json)
    return _all(plan, arguments.file, typed, arguments.json)


def _one(plan: Plan, name: str, duration: Exact, as_json: bool) -> int:
    from zwidth.machine.servo.port_run import PortRun
    from zwidth.machine.servo.priority import RealTime
    from zwidth.machine.servo.safety import ASKED, DONE

    signal.signal(signal.SIGTERM, _interrupted)
    peer = plan.peer(name, duration)
    real = peer.runs if isinstance(peer.runs, PortRun) else None
    try:
        for line in peer.meet(_MEETING):
            print(f"{name}: nobody is at the other end of {line} yet; running all the same", file=sys.stderr)
        if real is not None:  # after the meeting: its own watchdog counts from here on
            real.reach()
            silent = real.connection.on_silence
            print(
                f"{name}: {real.connection.describe()}; if nothing comes any more: {silent}", file=sys.stderr
            )
        ended: list[int] = []
        for told in (signal.SIGTERM, signal.SIGINT):
            signal.signal(told, lambda *_: ended.append(1))
        with nullcontext() if real is None else RealTime() as granted:
            if granted is not None:
                print(f"{name}: {granted}", file=sys.stderr)
            report = peer.run(duration, _Watch(peer, name), stop=lambda: bool(ended or (real and real.ended)))
        if real is not None:
            real.end(ASKED if ended else DONE)
    finally:
        if real is not None:
            real.close()
        peer.close()
    failed = real is not None and real.failed
    if as_json:
        seen = report.to_dict() | ({} if real is None else {"device": real.report().to_dict()})
        print_json(json.dumps({"format": FORMAT, "processes": {name: seen}}, allow_nan=False))
    else:
        first, *rest = report.report()
        print_report([f"{name}: {first}", *rest, *([] if real is None else real.report().report())])
    return int(failed)


def _interrupted(*_: object) -> None:
    """Told to end, as by Ctrl-C: what was opened is closed on the way."""
    raise KeyboardInterrupt


class _Watch:
    """A line a second of what a peer sees."""

    def __init__(self, peer: Peer, name: str) -> None:
        self._peer, self._name = peer, name
        self._next = max(1, round(_OFTEN / peer.period))

    def __call__(self, k: int) -> None:
        """After step k."""
        if (k + 1) % self._next:
            return
        seen = (f"{line}: {link.report().brief}" for line, link in self._peer.links.items())
        at = shown((k + 1) * self._peer.period, "s", 3)
        print(f"{self._name} at {at}, {'; '.join(seen)}", file=sys.stderr)


def _all(plan: Plan, file: str, typed: str, as_json: bool) -> int:
    """Every process as a child of this one; what they print comes out here."""
    for name in plan.names:  # what cannot run is told once, before any is started
        plan.runs(name, Exact(1))
    signal.signal(signal.SIGTERM, _interrupted)
    command = [sys.executable, "-m", "zwidth", "network", file, "--duration", typed]
    more = ["--json"] if as_json else []
    out = subprocess.PIPE if as_json else None
    children = {
        name: subprocess.Popen([*command, *more, "--run", name], stdout=out, text=True) for name in plan.names
    }
    try:
        told = _ended(children)
    except KeyboardInterrupt:
        _end(children.values())
        raise
    if as_json:
        seen = [json.loads(text)["processes"] for text in told.values() if text]
        processes = {name: report for one in seen for name, report in one.items()}
        print_json(json.dumps({"format": FORMAT, "processes": processes}, indent=2, allow_nan=False))
    failed = [name for name, child in children.items() if child.returncode]
    if failed:
        print(f"did not run to the end: {', '.join(failed)}", file=sys.stderr)
    return int(bool(failed))


def _ended(children: Mapping[str, subprocess.Popen[str]]) -> dict[str, str]:
    """What each printed, once all have ended; if one fails the others are told to end."""
    while any(child.poll() is None for child in children.values()):
        if any(child.returncode for child in children.values()):
            _end(children.values())
            break
        time.sleep(_LOOK)
    return {name: child.communicate()[0] for name, child in children.items()}


def _end(children: Iterable[subprocess.Popen[str]]) -> None:
    for child in children:
        child.terminate()
    for child in children:
        try:
            child.wait(_LONGEST_WAIT)
        except subprocess.TimeoutExpired:
            child.kill()
