"""An identified device as a report in the terminal: the log, the numbers, the wall, what to do next."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from rich.padding import Padding
from rich.table import Table
from rich.text import Text

from zwidth.cli.data.results import Identification
from zwidth.cli.loop_lines import environment_line
from zwidth.cli.page import below, grid, headline, items, more_with_all, page, section
from zwidth.data.identification.device.estimate import MOST_CONFIDENCE
from zwidth.data.identification.device.table import (
    OF_WALLS,
    advice,
    assumed,
    percent,
    perhaps_zero,
    rows,
    source_name,
)
from zwidth.model.environment import Wall
from zwidth.passivity.check import check_by_closed_forms
from zwidth.passivity.scope import TOLD
from zwidth.passivity.transmission import seen_at_motor
from zwidth.passivity.verdict import Verdict
from zwidth.quantity.text import shown, shown_at_most

_SHOWN = 0.95
"""Confidence of the intervals in the table."""

_WARNINGS = (
    "wrong model",
    "two masses",
    "not one mass",
    "bent friction",
    "no damping",
    "no coulomb friction",
)
"""Kinds of findings that are coloured."""


_FEW = 2
"""Ways to know it better in a short report."""


def print_identified(found: Identification, in_full: bool = False) -> None:
    own = found.identified.findings[len(found.log.findings) :]
    better = [line for line in advice(found.identified, found.confidence) if "may be 0" not in line]
    with page() as out:
        wrong = found.identified.shows("wrong model")
        badge = ("WRONG MODEL", "yellow") if wrong else ("IDENTIFIED", "green")
        out.print(headline(*badge, _claim(found)))
        if not in_full:
            section(out, "the device", list(_numbers(found))[:2])
            section(out, "what the data show", _findings([f for f in own if f.kind in _WARNINGS]))
            if found.verdict is not None:
                section(out, "the environment", _checked(found, found.verdict))
            section(out, "to know it better", items(list(better)[:_FEW]))
            more_with_all(out, "the log, what the numbers rest on, what the data show")
            return
        out.print(_log(found))
        section(out, "the device", _numbers(found))
        section(out, "what the data show", _findings(own))
        if found.verdict is not None:
            section(out, "the environment", _checked(found, found.verdict))
        section(out, "to know it better", items(better))
        section(out, "the log", items(str(finding) for finding in found.log.findings))


def _claim(found: Identification) -> str:
    if found.identified.shows("wrong model"):
        return "Coulomb friction is seen and was not fitted: these numbers allow no wall."
    if found.identified.shows("not one mass"):
        return "Neither one mass nor two explain the readings: these numbers allow no wall."
    as_one = ", if motor and handle move as one" if found.identified.as_one else ""
    device = found.identified.device(found.confidence, **found.others)
    device = seen_at_motor(device)
    stiffest = check_by_closed_forms(device, Wall(stiffness=1)).max_stiffness
    confidence = f"at {percent(found.confidence)} confidence"
    if not stiffest:
        names = " and ".join(perhaps_zero(found.identified, found.confidence)) or "a line below friction"
        return f"The data allow no spring wall {confidence}: {names} may be 0."
    turn = found.identified.motion == "rotary"
    seen, unit = shown(found.identified.speed, "rad/s" if turn else "m/s", 3), "N*m/rad" if turn else "N/m"
    return (
        f"Spring walls up to {shown_at_most(stiffest, unit)} are passive on this device, "
        f"{confidence}{as_one}, as far as its friction was seen: up to {seen}."
    )


def _log(found: Identification) -> Padding:
    one, log = found.identified, found.log
    means = f"{one.pulses} means over {shown(one.pulse_length, 's', 3)}"
    length = "rad" if log.motion == "rotary" else "m"
    runs = "" if log.runs == 1 else f" in {log.runs} runs"
    forces = ", ".join(name.replace("_", " ") for name in log.channels) or "no force, mass given"
    step = shown(log.resolution, length) if log.resolution else "no step seen"
    rows = [
        ("log", f"{source_name(found.identified)}: {shown(log.duration, 's')}{runs}, {log.samples} samples"),
        ("samples", f"T = {shown(log.sample_period, 's', 6)}, Δ = {step}, {forces}"),
        ("numbers rest on", f"{one.strokes} strokes, {means}"),
    ]
    return below(grid(rows))


def _numbers(found: Identification) -> Iterator[Table | Text]:
    table = Table(box=None, padding=(0, 2, 0, 0), header_style="dim", pad_edge=False)
    for heading in ("", "", "best guess", f"{percent(_SHOWN)} interval", ""):
        table.add_column(heading)
    for row in rows(found.identified, _SHOWN):
        style = "bold" if row.symbol.startswith("2") else ""
        table.add_row(
            Text(row.symbol, style=style),
            Text(row.name, style="dim"),
            Text(row.value, style=style),
            row.interval,
            row.unit,
        )
    yield table
    one = found.identified
    why = perhaps_zero(one, found.confidence) | perhaps_zero(one, _SHOWN)
    zero = "".join(f"{name} may be 0 for a wall: {text}\n" for name, text in why.items())
    yield Text.assemble((zero, "yellow"), (f"{assumed(one)}\n{OF_WALLS}", "dim"))
    force = "N*m" if one.motion == "rotary" else "N"
    yield Text(
        f"r² = {one.explained:.4f}, noise {shown(one.force_noise, force, 3)} per sample, "
        f"offset {shown(one.offset, force, 3)}",
        style="dim",
    )


def _findings(findings: Sequence[object]) -> Iterator[Text]:
    for finding in findings:
        kind = getattr(finding, "kind", "")
        yield Text(f"· {finding}", style="yellow" if kind in _WARNINGS else "")


def _checked(found: Identification, verdict: Verdict) -> Iterator[Text]:
    assert found.environment is not None
    yield Text(environment_line(found.environment, found.identified.motion))
    yield Text(_for_how_much(found.passive_for), style="bold")
    yield Text(
        f"{verdict.outcome} at {percent(found.confidence)}: {verdict.claim}",
        style=TOLD[verdict.outcome].terminal,
    )


def _for_how_much(confidence: float | None) -> str:
    if not confidence:
        return "not proved passive, even for the best guess"
    if confidence >= MOST_CONFIDENCE:
        return f"passive for {percent(confidence)} or more of what the data allow"
    tenths = int(confidence * 1000) / 1000  # of a per cent, downwards
    return f"passive for {percent(tenths)} of what the data allow"
