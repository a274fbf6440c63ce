"""Which column of a spreadsheet is the time, the indentation and the force, and in what unit.

A unit stands in the row below the names, in brackets, after a slash, or as the last word of a name.  A
name is known by its words, in the languages in which testing machines speak; where no name is known, the
one column in a unit of force is the force.  Two candidates are never chosen between, and a column whose
unit nobody states is refused.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from os import PathLike
from pathlib import Path
from typing import NamedTuple

import numpy as np

from zwidth.data.logs.columns import dimension_of, measured_in
from zwidth.data.logs.read import table_of_file
from zwidth.data.logs.rows import seconds, side_by_side
from zwidth.data.logs.table import Finding, Table, listed, readable, understood_sheets
from zwidth.errors import InputError
from zwidth.native.compiled import Array
from zwidth.quantity.exact import Exact
from zwidth.quantity.text import shown
from zwidth.quantity.units import POUND, WEIGHT, Dimension, spelled, unit_of

QUANTITIES = ("time", "indentation", "force")

_DIMENSIONS: Mapping[str, Dimension] = {
    "time": unit_of("s").dimension,
    "indentation": unit_of("m").dimension,
    "force": unit_of("N").dimension,
}

_WORDS: Mapping[str, tuple[str, ...]] = {
    "time": (
        "time zeit uhrzeit prüfzeit messzeit zeitstempel temps heure tiempo hora tempo ora elapsed timestamp "
        "seconds sec t",
    ),
    "indentation": (
        "indentation depth penetration eindringtiefe eindringung tiefe enfoncement indentación profundidad",
        "displacement disp deflection compression extension elongation stroke travel weg standardweg "
        "prüfweg traversenweg verschiebung auslenkung déplacement deplacement desplazamiento spostamento",
        "position pos crosshead traverse distance height z x",
    ),
    "force": ("force load kraft standardkraft last effort fuerza forza fz fn f",),
}

_OTHER_WORDS = """
setpoint target commanded command desired rate speed velocity stress strain error std deviation temperature
soll geschwindigkeit spannung dehnung vitesse contrainte
"""
_OTHER = frozenset(_OTHER_WORDS.split())
"""Words of what is measured besides, or was only wanted."""

_TRIAL_WORDS = "trial trials sample specimen run test cycle repeat repetition replicate versuch essai"
_TRIALS = frozenset(_TRIAL_WORDS.split())
"""Words of a column that numbers the trials."""

_MASSES: Mapping[str, float] = {
    "g": float(WEIGHT / 1000),
    "kg": float(WEIGHT),
    **dict.fromkeys(("lb", "lbs"), float(POUND)),
}
"""A force in g is the weight of so much [N]."""

_BRACKETS = re.compile(r"^(?P<name>.*?)\s*[\[(](?P<unit>[^\[\]()]*)[\])]\s*$")
_SLASH = re.compile(r"^(?P<name>.+?)\s*/\s*(?P<unit>[^/]+)$")
_LAST = re.compile(r"^(?P<name>.+?)[\s_,]+(?P<unit>[^\s_,]+)$")
_AGAIN = re.compile(r" \(\d+\)$")
"""Behind a name that stands in the header more than once."""

_WORD = re.compile(r"[^\W\d_]+")


class Columns(NamedTuple):
    """The column of each quantity and SI per number in it, the column that numbers the trials, what was
    guessed, and of how many tests that stand side by side these are one."""

    names: dict[str, str]
    factors: dict[str, float]
    trial: str | None
    findings: tuple[Finding, ...]
    beside: int


def recognised(
    table: Table,
    chosen: Mapping[str, str] | None = None,
    units: Mapping[str, str] | None = None,
    number: int = 1,
) -> Columns:
    """The columns of a test: first what was chosen, then by name, then by unit; of several side by side that
    of a number from 1."""
    chosen, units = dict(chosen or {}), dict(units or {})
    for what, given in (("column", chosen), ("unit", units)):
        for key in given:
            if key not in QUANTITIES:
                raise InputError(f"{what}: there is no quantity {key!r}; there are {', '.join(QUANTITIES)}")
    found: dict[str, str] = {}
    beside = {} if chosen else _side_by_side(table)
    tests = max(map(len, beside.values()), default=1)
    chosen |= {quantity: names[min(number, len(names)) - 1] for quantity, names in beside.items() if names}
    for quantity in QUANTITIES:
        found[quantity] = _column(table, quantity, chosen, [*found.values(), *chosen.values()])
    _refuse_without_unit(table, found, units)
    factors = {q: _factor(table, q, name, units.get(q)) for q, name in found.items()}
    numbered = [name for name in table.units if name not in found.values() and _TRIALS & set(_words(name))]
    trial = numbered[0] if len(numbered) == 1 else None
    return Columns(found, factors, trial, tuple(_guessed(table, found, chosen, units)), tests)


def _side_by_side(table: Table) -> dict[str, list[str]]:
    """The columns of several tests beside each other, named alike but for a number; {} where there are not.
    They may have one column of time together, and one of indentation."""
    found: dict[str, list[str]] = {}
    for quantity in QUANTITIES:
        taken = [name for names in found.values() for name in names]
        found[quantity] = _candidates(table, quantity, [name for name in table.units if name not in taken])
    tests = max(map(len, found.values()))
    stems = [{re.sub(r"\s*\d+", "", _AGAIN.sub("", n)).lower() for n in names} for names in found.values()]
    alike = all(len(each) == 1 for each in stems if each)
    shared = all(len(names) in (1, tests) for names in found.values() if names)
    return found if tests > 1 and alike and shared and len(found["force"]) == tests else {}


def _column(table: Table, quantity: str, chosen: Mapping[str, str], taken: list[str]) -> str:
    if quantity in chosen:
        if chosen[quantity] not in table.units:
            raise InputError(
                f'{table.source} has no column "{chosen[quantity]}"; there are {listed(dict(table.units))}'
            )
        return chosen[quantity]
    candidates = _candidates(table, quantity, [name for name in table.units if name not in taken])
    if len(candidates) > 1:
        raise InputError(
            f"{table.source}: {listed(candidates)} may each be the {quantity}; say which with "
            f'columns={{"{quantity}": "{candidates[0]}"}}'
        )
    others = [
        [chosen[other]] if other in chosen else _candidates(table, other, list(table.units))
        for other in QUANTITIES[1:]
    ]
    pressures = [name for name in table.units if spelled(_unit(table, name) or "") in _PRESSURES]
    if not all(others) and not chosen and pressures:
        raise InputError(
            f"{table.source}: {listed(pressures)} is a pressure, and a device renders a force: give that "
            "in a column such as force_N, the pressure times the area of the probe; 1 kPa on 1 cm^2 is 0.1 N"
        )
    if not candidates and quantity == "time" and all(others):
        depth, load = (names[0] for names in others)
        raise InputError(
            f"{table.source}: a table of load against depth, {listed([depth, load])}, "
            "without time: how a tissue relaxes is not in it. Export the time of each row, or write it in a "
            "column time_s where rows came at a steady rate; or render the curve as a spring by some of its "
            f"points: zwidth check DEVICE --type nonlinear-spring {_as_spring(table, depth, load)}"
        )
    if not candidates:
        raise InputError(
            f"{table.source}: no column is known to be the {quantity}; say which with "
            f'columns={{"{quantity}": …}}; there are {listed(dict(table.units)) or "no columns of numbers"}'
        )
    return candidates[0]


_PRESSURES = ("Pa", "hPa", "kPa", "MPa", "GPa", "N/m^2", "N/mm^2", "N/cm^2", "bar", "mbar", "psi", "mmHg")

_MOST_POINTS = 12
"""Of a curve in a message."""


def _as_spring(table: Table, depth: str, load: str) -> str:
    """Points of a curve on its way in as they are typed; others where a unit is not stated."""
    try:
        to_m, to_n = (
            _factor(table, quantity, name, _unit(table, name) or "")
            for quantity, name in (("indentation", depth), ("force", load))
        )
    except InputError:
        return '--positions "0, 1 mm, 2 mm" --forces "0, 0.1 N, 0.4 N"'
    x, f = np.hstack([np.vstack(piece) for piece in table.read((depth, load))]) * [[to_m], [to_n]]
    x, f = x[known := np.isfinite(x + f)], f[known]
    x, f = x[deeper := np.diff(np.maximum.accumulate(x), prepend=-np.inf) > 0], f[deeper]
    every = slice(None, None, -(-x.size // _MOST_POINTS) or 1)
    positions, forces = (
        ", ".join(shown(v, unit, 4) for v in of[every].tolist()) for of, unit in ((x, "m"), (f, "N"))
    )
    return f'--positions "{positions}" --forces "{forces}"'


def _candidates(table: Table, quantity: str, names: list[str]) -> list[str]:
    """Those of the first kind of evidence that any has: the whole name, a word of it, the unit."""
    fitting = [
        name
        for name in names
        if _kind(_unit(table, name), quantity) in (None, quantity) and not _OTHER & set(_words(name))
    ]
    for tier in _WORDS[quantity]:
        known = set(tier.split())
        whole = [name for name in fitting if len(_words(name)) == 1 and _words(name)[0] in known]
        some = [name for name in fitting if known & {word for word in _words(name) if len(word) > 1}]
        if whole or some:
            return whole or some
    return [name for name in fitting if _kind(_unit(table, name), quantity) == quantity]


def _words(column: str) -> list[str]:
    name = _split(column)[0]
    return [word.lower() for word in _WORD.findall(re.sub(r"([a-z])([A-Z])", r"\1 \2", name))]


def _split(column: str) -> tuple[str, str | None]:
    """Name and unit; None where no unit stands there."""
    bare = _AGAIN.sub("", column.strip().strip('"'))
    for pattern in (_BRACKETS, _SLASH, _LAST):
        found = pattern.match(bare)
        if found and (_kind(found["unit"], "") is not None or pattern is _BRACKETS):
            return found["name"], found["unit"].strip() or None
    return bare, None


def _unit(table: Table, column: str) -> str | None:
    return table.units[column] or _split(column)[1]


def _kind(unit: str | None, quantity: str) -> str | None:
    """The quantity of which it is a unit, "" of another one; None where it is none or nobody states it."""
    if unit is None:
        return None
    bare = spelled(unit)
    if quantity == "force" and bare in _MASSES:
        return "force"
    dimension = dimension_of(bare or None)
    own = (name for name, known in _DIMENSIONS.items() if known == dimension)
    return None if dimension is None else next(own, "")


def _refuse_without_unit(table: Table, found: Mapping[str, str], units: Mapping[str, str]) -> None:
    lacking = [q for q, name in found.items() if q not in units and not spelled(_unit(table, name) or "")]
    if lacking:
        names = listed([found[q] for q in lacking])
        asked = " ".join(f'units={{"{q}": "{_EXAMPLES[q]}"}}' for q in lacking)
        days = ' (units={"time": "days"} if they are such as 45987.43)' if "time" in lacking else ""
        raise InputError(f"{table.source}: nobody says in which unit {names} is; state it with {asked}{days}")


_EXAMPLES = {"time": "s", "indentation": "mm", "force": "N"}


def _factor(table: Table, quantity: str, column: str, given: str | None) -> float:
    unit = given if given is not None else _unit(table, column)
    assert unit is not None
    kind = _kind(unit, quantity)
    if kind != quantity:
        what = "no unit that is known here" if kind is None else f"no unit of {_KINDS[quantity]}"
        raise InputError(
            f'{table.source}: the {quantity} in column "{column}" is in {unit}, {what}; state it '
            f'with units={{"{quantity}": "{_EXAMPLES[quantity]}"}}'
        )
    bare = spelled(unit)
    if quantity == "force" and bare in _MASSES:
        return _MASSES[bare]
    return float(Exact(measured_in(bare).scale))


_KINDS = {"time": "time", "indentation": "length", "force": "force"}


def _guessed(
    table: Table, found: Mapping[str, str], chosen: Mapping[str, str], units: Mapping[str, str]
) -> Iterator[Finding]:
    """What a reader should see of how the columns were understood."""
    for quantity, name in found.items():
        unit = units.get(quantity) or _unit(table, name) or ""
        known = {word for tier in _WORDS[quantity] for word in tier.split()}
        if quantity not in chosen and not known & set(_words(name)):
            text = f'"{name}" is taken for the {quantity}: no other column is in a unit of it'
            yield Finding(kind="column", text=text)
        if quantity == "force" and spelled(unit) in _MASSES:
            yield Finding(kind="unit", text=f"a force in {unit} is taken as the weight of so much")


MOST_ROWS = 10**6
"""Of a test; more are a log of something else."""


class Raw(NamedTuple):
    """Columns in SI units as they stand in the file, the number of the trial in each row, and how many other
    trials stand beside it."""

    source: str
    time: Array
    indentation: Array
    force: Array
    trial: Array | None
    findings: tuple[Finding, ...]
    beside: int = 1


def read_tests(
    path: str | PathLike[str],
    columns: Mapping[str, str] | None = None,
    units: Mapping[str, str] | None = None,
    sheet: str | None = None,
) -> list[Raw]:
    """Every test in a file that stands beside the others, or on another sheet of a workbook; one after the
    other they are still together."""
    with readable(str(path)):
        table = table_of_file(Path(path), sheet)
        found = []
        for each in understood_sheets(table, lambda each: recognised(each, columns, units)):
            first = _read(each, columns, units, 1)
            found += [first, *(_read(each, columns, units, k) for k in range(2, first.beside + 1))]
    return found


def _read(
    table: Table, columns: Mapping[str, str] | None, units: Mapping[str, str] | None, number: int
) -> Raw:
    known = recognised(table, columns, units, number)
    wanted = known.names | ({"trial": known.trial} if known.trial else {})
    pieces = list(table.read(tuple(wanted.values())))
    rows = sum(piece[0].size for piece in pieces)
    if not pieces or rows > MOST_ROWS:
        raise InputError(f"{table.source} has {rows} rows; a test has 1 to {MOST_ROWS}")
    whole = map(np.concatenate, zip(*pieces, strict=True))
    tests = side_by_side(table, wanted, dict(zip(wanted, whole, strict=True)))
    stamps = tests["time"]
    indentation, force = (tests[q].astype(float) * known.factors[q] for q in QUANTITIES[1:])
    return Raw(
        table.source,
        seconds(stamps, stamps[0] if stamps.dtype.kind in "iuM" else 0.0, known.factors["time"]),
        indentation,
        force,
        tests["trial"].astype(float) if known.trial else None,
        (*known.findings, *table.notes.values()),
        known.beside,
    )
