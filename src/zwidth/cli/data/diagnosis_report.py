"""A diagnosis as a report in the terminal: the cause, what speaks for it, what to do."""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from typing import TYPE_CHECKING

from rich.padding import Padding
from rich.text import Text

from zwidth.cli.options import as_typed, overrides
from zwidth.cli.page import below, grid, headline, items, more_with_all, page, section, small_print
from zwidth.data.logs.table import LEFT_OUT
from zwidth.passivity.scope import TOLD
from zwidth.quantity.glossary import GLOSSARY
from zwidth.quantity.spoken import spoken
from zwidth.quantity.text import shown
from zwidth.showing import typed

if TYPE_CHECKING:
    from zwidth.data.diagnosis import Diagnosis, PairDiagnosis
    from zwidth.data.diagnosis.change import Change
    from zwidth.data.diagnosis.law import Law
    from zwidth.data.diagnosis.pairs.change import PairChange

_OPTIONS = {"stiffness": "--stiffness", "damping": "--virtual-damping", "delay": "--delay"}
"""Changes that one command line can ask `check` about."""


def print_diagnosis(found: Diagnosis | PairDiagnosis, arguments: argparse.Namespace) -> None:
    with page() as out:
        out.print(_headline(found))
        section(out, "what speaks for it", items(found.evidence))
        section(out, "the law as stated", items(getattr(found, "stated", ())))
        if found.change is not None:
            section(out, "what to change", _change(found.change, found, arguments))
        elif found.cause is not None and not found.record:
            section(out, "what to change", items(found.next_steps))
        section(out, "what to record", items(found.record))
        if not arguments.in_full:
            section(out, "the file", items(as_typed(text) for text in found.findings if LEFT_OUT in text))
            more_with_all(out, "every number, the other causes, what is supposed")
            return
        out.print(below(grid(found.rows())))
        section(out, "the file", items(map(as_typed, found.findings)))
        out.print(small_print(*_supposed(found)))


def _headline(found: Diagnosis | PairDiagnosis) -> Padding:
    if found.cause is None:
        badge = "NO VIBRATION" if found.seen is None else "CANNOT TELL"
        return headline(badge, "yellow", found.claim)
    sure = f"{shown(min(found.confidence, 0.99), '%', 2)} sure"
    energy = "" if found.energy_per_cycle is None else f", {_energy(found.energy_per_cycle)}"
    return headline(found.cause, "red", f"{found.claim} ({sure}{energy})")


def _energy(work: float) -> str:
    if work < 0:
        return f"the motor takes {shown(-work, 'J', 2)} a cycle"
    return f"{shown(work, 'J', 2)} a cycle"


def _change(
    change: Change | PairChange, found: Diagnosis | PairDiagnosis, arguments: argparse.Namespace
) -> Iterator[Text]:
    outcome = change.verdict.outcome
    yield Text.assemble(f"· {change.text}: ", (outcome.upper(), TOLD[outcome].terminal))
    typed = command(found, arguments)
    if typed is not None:
        yield Text(f"$ {typed}")


def command(found: Diagnosis | PairDiagnosis, arguments: argparse.Namespace) -> str | None:
    """The line that asks `check` about the loop with the number changed."""
    from zwidth.data.diagnosis.change import Change
    from zwidth.data.diagnosis.result import Diagnosis

    change = found.change
    if change is None:
        return None
    asks = "check" if isinstance(change, Change) else "pair"
    if arguments.save is not None:
        return f"zwidth {asks} {typed(arguments.save)}"
    if not isinstance(change, Change):
        reading = [word for pair in _read_with(arguments) for word in pair]
        again = ["zwidth", "diagnose", arguments.log, *arguments.sources, *reading, "-o", "mended.toml"]
        return f"{typed(*again)} && zwidth pair mended.toml"
    assert isinstance(found, Diagnosis)
    assert found.seen is not None
    other = found.seen.stated is not None and not found.seen.stated.holds
    if change.parameter not in _OPTIONS or arguments.law or other:
        return f"zwidth diagnose {typed(arguments.log)} … -o mended.toml && zwidth check mended.toml"
    assert found.seen.law is not None
    words = ["zwidth", "check", *arguments.sources]
    of_law = {"stiffness": "stiffness", "damping": "virtual_damping"}.get(change.parameter)
    for key, value in overrides(arguments).items():
        if key not in ("delay", of_law):
            words += [f"--{key.replace('_', '-')}", value]
    if found.seen.stated is None:
        words += _law_as_found(found.seen.law, change)
    elif change.parameter in ("stiffness", "damping"):
        number = _with_unit(change.to, change.parameter, change.device.motion)
        words += [_OPTIONS[change.parameter], number]
    if float(change.device.exact("delay")):
        words += ["--delay", shown(change.device.exact("delay"), "s", 6)]
    return typed(*words)


def _law_as_found(law: Law, change: Change) -> list[str]:
    stiffness = change.to if change.parameter == "stiffness" else law.stiffness
    damping = change.to if change.parameter == "damping" else law.damping
    motion = change.device.motion
    words = ["--stiffness", _with_unit(stiffness, "stiffness", motion)]
    if damping:
        words += ["--virtual-damping", _with_unit(damping, "damping", motion)]
        if law.window > 1:
            words += ["--velocity-filter", f"window {law.window}"]
    return words


def _with_unit(value: float, quantity: str, motion: str) -> str:
    factor, unit = spoken(GLOSSARY[quantity].unit_for(motion))
    return f"{factor * value:.6g} {unit}"


def _read_with(arguments: argparse.Namespace) -> Iterator[tuple[str, str]]:
    """The options that say how the log is read, as they were typed."""
    for option, name in (("--column", "columns"), ("--unit", "units"), ("--scale", "scale")):
        yield from ((option, typed) for typed in getattr(arguments, name) or ())
    if arguments.log_rate is not None:
        yield "--log-rate", arguments.log_rate


def _supposed(found: Diagnosis | PairDiagnosis) -> Iterator[str]:
    from zwidth.data.diagnosis.result import Diagnosis

    two = not isinstance(found, Diagnosis)
    yield (
        "one joint of each arm; the hands are passive"
        if two
        else "one degree of freedom; the hand is passive"
    )
    yield "how sure it is, was counted on simulated faults"
