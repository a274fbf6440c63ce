"""An identified device as a table: in a terminal, and in a notebook."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from zwidth.identification.device.limits import limits, percent
from zwidth.showing import Html, bullets, element, printable, row

if TYPE_CHECKING:
    from zwidth.identification.device.numbers import IdentifiedNumbers

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


class Row(NamedTuple):
    """A number as people read it."""

    symbol: str
    name: str
    value: str
    interval: str
    unit: str


def rows(identified: IdentifiedNumbers, confidence: float = 0.95) -> list[Row]:
    """The parameters, and what they allow."""
    table = []
    if identified.mass is not None:
        unit = "kg m²" if identified.motion == "rotary" else "kg"
        table.append(Row("m", NAMES["mass"], f"{identified.mass:.4g}", "as given", _pretty(unit)))
    for key, symbol in SYMBOLS.items():
        if key in identified.estimates:
            estimate = identified.estimates[key]
            low, high = estimate.interval(confidence)
            table.append(_row(symbol, NAMES[key], estimate.value, low, high, estimate.unit))
        if key == "damping" and identified.shows("damping by direction"):
            for name in ("inward", "outward"):
                estimate = getattr(identified.directions, name)
                low, high = estimate.interval(confidence)
                table.append(_row("b", f"  {name}", estimate.value, low, high, estimate.unit))
    stiffness = "N·m/rad" if identified.motion == "rotary" else "N/m"
    for limit in limits(identified):
        low, high = limit.interval(confidence)
        table.append(_row(limit.symbol, NAMES[limit.symbol], limit.value, low, high, stiffness))
    return table


def facts(identified: IdentifiedNumbers) -> str:
    """What the numbers rest on, in a line."""
    turn = identified.motion == "rotary"
    force, length = ("N·m", "rad") if turn else ("N", "m")
    return (
        f"r² = {identified.explained:.4f}, noise {identified.force_noise:.3g} {force} per sample, offset "
        f"{identified.offset:.3g} {force}; {identified.strokes} strokes, {identified.pulses} means over "
        f"{1e3 * identified.pulse_length:.3g} ms; T = {identified.sample_period:.6g} s, "
        f"Δ = {identified.resolution:.6g} {length}\n"
        f"friction seen up to {identified.fastest[0]:.3g} {length}/s into the wall, "
        f"{identified.fastest[1]:.3g} out of it"
    )


def title(identified: IdentifiedNumbers) -> str:
    """Where the numbers come from."""
    return f"device identified from {source_name(identified)}"


def source_name(identified: IdentifiedNumbers) -> str:
    """The log's name without its folders, on one line."""
    name = Path(identified.source).name or identified.source
    return "".join(c if c.isprintable() else "?" for c in name)


def as_text(identified: IdentifiedNumbers, confidence: float = 0.95) -> str:
    """The table in columns."""
    table = [("", "", "best guess", percent(confidence), ""), *rows(identified, confidence)]
    widths = [max(len(row[i]) for row in table) for i in range(5)]
    lines = ["  ".join(cell.ljust(w) for cell, w in zip(row, widths, strict=True)).rstrip() for row in table]
    findings = [f"· {finding}" for finding in identified.findings]
    return printable("\n".join([title(identified), "", *lines, "", facts(identified), *findings]))


def as_html(identified: IdentifiedNumbers, confidence: float = 0.95) -> Html:
    """The same for a notebook."""
    head = row(("", "", "best guess", percent(confidence), ""), "th")
    numbers = (row(cells) for cells in rows(identified, confidence))
    table = element("table", element("caption", title(identified)), head, *numbers)
    return element("div", table, element("p", facts(identified)), bullets(identified.findings))


def _row(symbol: str, name: str, value: float, low: float, high: float, unit: str) -> Row:
    return Row(symbol, name, _number(value), f"{_number(low)} … {_number(high)}", _pretty(unit))


def _number(value: float) -> str:
    """Four digits; whole numbers where there are more before the point."""
    return f"{value:.0f}" if 1000 <= abs(value) < 1e6 else f"{value:.4g}"


def _pretty(unit: str) -> str:
    return unit.replace(" ", "·")
