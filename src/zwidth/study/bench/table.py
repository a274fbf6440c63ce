"""The comparison as a table: in a terminal, and in a notebook."""

from __future__ import annotations

from collections.abc import Sequence
from math import isfinite, isinf
from typing import TYPE_CHECKING, NamedTuple

from zwidth.loop.traces.perceived import SOURCE, WEBER
from zwidth.quantity.spoken import spoken
from zwidth.quantity.text import in_a_table, unit_text
from zwidth.showing import Table

if TYPE_CHECKING:
    import xarray as xr


class Column(NamedTuple):
    """A heading, what is below it, and in which unit it is shown on a device that is linear."""

    heading: str
    variable: str
    factor: float
    unit: str


COLUMNS = (
    Column("felt", "static_stiffness", 1.0, "N/m"),
    Column("JNDs", "stiffness_jnds", 1.0, ""),
    Column("hardness", "rate_hardness", 1.0, "N/m"),
    Column("depth", "penetration", 1e3, "mm"),
    Column("chatter", "tap_chatter", 1e3, "mN"),
    Column("bounces", "bounces", 1.0, ""),
    Column("settles", "settling_time", 1e3, "ms"),
    Column("peak", "peak_force", 1.0, "N"),
    Column("given out", "generated_energy", 1e3, "mJ"),
    Column("to a dowel", "dowel_energy", 1e3, "mJ"),
    Column("free air", "free_damping", 1.0, "N·s/m"),
    Column("adversary", "gain", 1e3, "mJ/round"),
    Column("step", "step_time", 1e9, "ns"),
)


ON_PAPER = "on paper"
"""What the table calls a proof on paper, no certificate."""


def table(scores: xr.Dataset) -> Table:
    """Headings, units, and a row for each law."""
    return Table(
        heads=_heads(columns_of(scores)),
        rows=[_row(scores.sel(law=name)) for name in scores["law"].values],
        lefts=2,
    )


def columns_of(scores: xr.Dataset) -> list[Column]:
    """The columns in the units of these scores, an angle in the unit that was typed."""
    return [_in_its_unit(c, scores[c.variable].attrs["units"]) for c in COLUMNS]


def _in_its_unit(column: Column, unit: str) -> Column:
    if "rad" not in unit and unit != "N*m":
        return column
    factor, told = spoken(unit)
    prefix = "m" if column.factor == 1e3 and "deg" not in told else ""
    return column._replace(factor=factor * (1e3 if prefix else 1.0), unit=prefix + unit_text(told))


def _row(one: xr.Dataset, columns: Sequence[Column] = ()) -> list[str]:
    columns = columns or columns_of(one)
    status = str(one["status"].item())
    cells = (_number(float(one[c.variable]) * c.factor) for c in columns)
    return [str(one["law"].item()), ON_PAPER if status == "theorem" else status, *cells]


_KEYS = ("static_stiffness", "generated_energy", "gain")
"""What is felt, what is given out, and what the worst motion takes: the columns of a short table."""

_RANK = ("passive", "theorem", "undecided", "active")


def short_table(scores: xr.Dataset, first: Sequence[str], most: int) -> Table:
    """At most so many laws with three numbers each: the first, those proved, those that give out least."""
    columns = [c for c in columns_of(scores) if c.variable in _KEYS]

    def rank(name: str) -> tuple[bool, int, float]:
        one = scores.sel(law=name)
        return name not in first, _RANK.index(str(one["status"].item())), float(one["generated_energy"])

    chosen = sorted(map(str, scores["law"].values), key=rank)[:most]
    rows = [_row(scores.sel(law=name), columns) for name in chosen]
    return Table(heads=_heads(columns), rows=rows, lefts=2)


def _heads(columns: Sequence[Column]) -> list[list[str]]:
    return [["law", "status", *(c.heading for c in columns)], ["", "", *(c.unit for c in columns)]]


def legend(scores: xr.Dataset) -> str:
    """What the words of the table mean that are not clear by themselves."""
    steps = f"just-noticeable differences of {WEBER:.0%} ({SOURCE})"
    jnds = f"JNDs: felt against the stiffness that is wanted, in {steps}; below 0 it is softer"
    return "; ".join([*on_paper(scores), jnds])


def on_paper(scores: xr.Dataset) -> list[str]:
    """What is meant by the proofs without a certificate, where there are some."""
    if not (scores["status"] == "theorem").any():
        return []
    return [f"{ON_PAPER}: a theorem, by a proof on paper, no certificate"]


def _number(value: float) -> str:
    if isinf(value):
        return "never"
    if not isfinite(value):
        return "–"
    if abs(value) < 5e-4:
        return "0"
    return in_a_table(value, 3)
