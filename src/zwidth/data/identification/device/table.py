"""An identified device as a table: in a terminal, and in a notebook."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from zwidth.data.identification.device.limits import limits, percent
from zwidth.quantity.glossary import GLOSSARY
from zwidth.quantity.spoken import spoken
from zwidth.quantity.text import in_a_table, quantity_unit, told_quantity, unit_text
from zwidth.showing import Lines, Part, Table, one_line

if TYPE_CHECKING:
    from zwidth.data.identification.device.numbers import IdentifiedNumbers

SYMBOLS = {
    "mass": "m",
    "damping": "b",
    "coulomb_friction": "f_c",
    "slow": "f_s",
    "spring": "k",
    "force_lag": "τ_f",
}
"""Of what may have been identified, in this order."""

NAMES = {
    "mass": "mass",
    "damping": "damping",
    "coulomb_friction": "Coulomb friction",
    "slow": "more friction at rest",
    "spring": "a spring, or gravity on an arc",
    "force_lag": "force recorded late by",
    "2b/T": "wall by damping",
    "2f_c/Δ": "wall by Coulomb friction",
}

BOTH_SIDES = (
    "m, b and f_c are the sum of both sides of a cable, belt or gear between motor and hand; where the motor "
    "swings on it only its own side pays"
)
"""What is taken for granted of every device: motor, encoder and hand move as one."""


class Row(NamedTuple):
    """A number as people read it."""

    symbol: str
    name: str
    value: str
    interval: str
    unit: str


def named(key: str, motion: str) -> str:
    """A parameter as people call it: of what turns the mass is an inertia."""
    return "inertia" if key == "mass" and motion == "rotary" else NAMES[key]


def rows(identified: IdentifiedNumbers, confidence: float = 0.95) -> list[Row]:
    """The parameters, and what they allow."""
    table = []
    if identified.mass is not None:
        unit = quantity_unit("mass", identified.motion)
        table.append(Row("m", named("mass", identified.motion), f"{identified.mass:.4g}", "as given", unit))
    for key, symbol in SYMBOLS.items():
        if key in identified.estimates:
            estimate = identified.estimates[key]
            low, high = estimate.interval(confidence)
            table.append(
                _row(symbol, named(key, identified.motion), estimate.value, low, high, estimate.unit)
            )
        if key == "damping" and identified.shows("damping by direction"):
            for name in ("inward", "outward"):
                estimate = getattr(identified.directions, name)
                low, high = estimate.interval(confidence)
                table.append(_row("b", f"  {name}", estimate.value, low, high, estimate.unit))
    stiffness = GLOSSARY["stiffness"].unit_for(identified.motion)
    for limit in limits(identified):
        low, high = limit.interval(confidence)
        table.append(_row(limit.symbol, NAMES[limit.symbol], limit.value, low, high, stiffness))
    return table


def facts(identified: IdentifiedNumbers) -> str:
    """What the numbers rest on, in a line."""
    force = quantity_unit("force", identified.motion)
    inward = told_quantity(identified.fastest[0], "friction_speed", identified.motion, 3)
    outward = told_quantity(identified.fastest[1], "friction_speed", identified.motion, 3)
    return (
        f"r² = {identified.explained:.4f}, noise {identified.force_noise:.3g} {force} per sample, offset "
        f"{identified.offset:.3g} {force}; {identified.strokes} strokes, {identified.pulses} means over "
        f"{1e3 * identified.pulse_length:.3g} ms; T = {identified.sample_period:.6g} s, "
        f"Δ = {told_quantity(identified.resolution, 'position', identified.motion)}\n"
        f"friction seen up to {inward} into the wall, {outward} out of it"
    )


def title(identified: IdentifiedNumbers) -> str:
    """Where the numbers come from."""
    return f"device identified from {source_name(identified)}"


def source_name(identified: IdentifiedNumbers) -> str:
    """The log's name without its folders, on one line."""
    return one_line(Path(identified.source).name or identified.source)


def report(identified: IdentifiedNumbers, confidence: float = 0.95) -> Iterable[Part]:
    """The table, what it rests on, and what was found besides."""
    heads = [("", "", "best guess", percent(confidence), "")]
    yield Table(caption=title(identified), heads=heads, rows=rows(identified, confidence))
    yield ""
    yield facts(identified)
    yield BOTH_SIDES
    if identified.findings:
        yield Lines(identified.findings)


def _row(symbol: str, name: str, value: float, low: float, high: float, unit: str) -> Row:
    factor, told = spoken(unit.replace(" ", "*"))
    interval = f"{in_a_table(factor * low)} … {in_a_table(factor * high)}"
    return Row(symbol, name, in_a_table(factor * value), interval, unit_text(told))
