"""Numbers of columns in SI: by a unit, a factor, "2 N/V", or a step, "22.4 um"; without any none is read."""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass
from typing import NoReturn

import numpy as np

from zwidth.data.logs.columns import COUNTS, check_quantity, dimension_of, is_unit, measured_in, name_and_unit
from zwidth.data.logs.table import Motion, Table
from zwidth.errors import InputError
from zwidth.quantity.exact import Exact
from zwidth.quantity.spoken import note
from zwidth.quantity.units import PI, Dimension, Unit, parse_number, plain, spelled, unit_of

_LENGTH, _ANGLE, _TIME, _FORCE, _TORQUE = (unit_of(unit).dimension for unit in ("m", "rad", "s", "N", "N*m"))


@dataclass(frozen=True, kw_only=True)
class Meaning:
    """What the columns of a table are."""

    columns: Mapping[str, str]
    factors: Mapping[str, float]
    """SI per number in the column, of each."""
    motion: Motion
    resolution: float | None
    """[m; rad] stated step of the encoder; None if nobody stated it."""


def meaning_of(
    table: Table,
    columns: Mapping[str, str],
    *,
    units: Mapping[str, str] | None = None,
    scale: Mapping[str, object] | None = None,
    resolution: object = None,
    counts_per_turn: object = None,
    motion: str | None = None,
) -> Meaning:
    """Factors to SI of every column, and whether the device turns."""
    for what, given in (("units", units), ("scale", scale)):
        for key in given or ():
            check_quantity(what, key)
            if key not in columns:
                raise InputError(f"{what}: the log has no {key}; leave it out, or name its column in columns")
    scale = _numbers_or_texts(scale or {})
    _refuse_other_units(table, columns, units or {})
    stated = {q: _stated((units or {}).get(q), q) or _own_unit(table, c, q) for q, c in columns.items()}
    if motion is None and table.attributes.get("motion") in ("linear", "rotary"):
        motion = table.attributes["motion"]
    if resolution is None and counts_per_turn is None:
        values = (table.attributes.get(key) for key in ("resolution_m", "resolution_rad"))
        resolution = next((float(v) for v in values if v is not None), None)  # of a trace of ours
    if "time" in columns and stated["time"] is None and not isinstance(scale.get("time"), str):
        _ask_for_unit_of_time(table, columns["time"])
    turning = _turning(motion, stated, scale, resolution, counts_per_turn)
    step = _step(resolution, counts_per_turn, turning)
    factors = {}
    for quantity, column in columns.items():
        times = scale.get(quantity)
        if quantity == "position" and stated[quantity] in COUNTS and not isinstance(times, str):
            if step is None:
                raise InputError(
                    f'{table.source}: "{column}" is in counts; say what a count is with resolution="22.4 um" '
                    "or counts_per_turn=4096"
                )
            factors[quantity] = step if times is None else step * float(parse_number(times, "1", "scale"))
            continue
        where = f'{table.source}: {quantity} in column "{column}"'
        likely = table.likely.get(column) if quantity == "position" and not isinstance(times, str) else None
        if likely and stated[quantity] is None:
            raise InputError(f'{where} has no unit: {likely}; state it with units={{"position": "deg"}}')
        factors[quantity] = _factor(where, quantity, stated[quantity], times, turning)
    return Meaning(
        columns=columns, factors=factors, motion="rotary" if turning else "linear", resolution=step
    )


def _refuse_other_units(table: Table, columns: Mapping[str, str], units: Mapping[str, str]) -> None:
    """A unit that is given for a column whose file or name states another: which of the two is meant?"""
    for quantity, given in units.items():
        column = columns[quantity]
        stated = _own_unit(table, column, quantity)
        if stated is None or stated in COUNTS or not is_unit(stated) or stated == _stated(given, quantity):
            continue
        raise InputError(
            f'{table.source}: column "{column}" says of itself that it is in {stated}, and {given} is given; '
            "leave the unit out, or say what a number in it stands for with "
            f'scale={{"{quantity}": "1 {given}"}}'
        )


def _numbers_or_texts(scale: Mapping[str, object]) -> dict[str, object]:
    """Each as it was given, but a bare factor that was typed, such as "-1", as the number that it is."""
    scales = dict(scale)
    for quantity, given in scale.items():
        what = f"scale of the {quantity}"
        with suppress(InputError):
            scales[quantity] = given = Exact(given) if isinstance(given, str) else given
        factor = _scale(given, what)[0] if isinstance(given, str) else float(parse_number(given, "1", what))
        if factor == 0:
            raise InputError(f"{what} must not be 0: nothing would be left of the column")
    return scales


def _own_unit(table: Table, column: str, quantity: str) -> str | None:
    """The unit that the file, or else the name of the column, states."""
    return _stated(table.units[column] or name_and_unit(column, quantity)[1], quantity)


def _stated(text: str | None, quantity: str) -> str | None:
    """A unit in the spelling of `unit_of`."""
    if text is None:
        return None
    return spelled(text.split(" since ")[0] if quantity == "time" else text)


def _turning(
    motion: str | None,
    stated: Mapping[str, str | None],
    scale: Mapping[str, object],
    resolution: object,
    counts_per_turn: object,
) -> bool:
    """True for a rotary device: as stated, or as the unit of its position says, or else that of a force."""
    if motion not in (None, "linear", "rotary"):
        raise InputError(f'motion is "linear" or "rotary", got {motion!r}')
    kinds = [_dimension("position", stated, scale)]
    if isinstance(resolution, str):
        kinds.append(unit_of(plain(resolution).lstrip("+-0123456789.eE/ ")).dimension)
    if counts_per_turn is not None:
        kinds.append(_ANGLE)
    turns = {_ANGLE: True, _LENGTH: False}
    seen = {turns[kind] for kind in kinds if kind in turns}
    if motion is not None:
        seen.add(motion == "rotary")
    if len(seen) > 1:
        raise InputError(
            "the position is a length in one place and an angle in another: check motion, the unit of the "
            "position, resolution and counts_per_turn"
        )
    return seen.pop() if seen else _TORQUE in {_dimension(quantity, stated, scale) for quantity in stated}


def _dimension(
    quantity: str, stated: Mapping[str, str | None], scale: Mapping[str, object]
) -> Dimension | None:
    """Of the numbers of a column as they are meant; None where nobody says."""
    given, unit = scale.get(quantity), stated.get(quantity)
    if isinstance(given, str):
        return _scale(given, f"scale of the {quantity}")[1].dimension
    return dimension_of(unit)  # what is none is refused where it is used


def _step(resolution: object, counts_per_turn: object, turning: bool) -> float | None:
    if counts_per_turn is not None:
        if resolution is not None:
            raise InputError("resolution and counts_per_turn say the same; give one of them")
        count = parse_number(counts_per_turn, "1", "counts_per_turn")
        if count <= 0:
            raise InputError(f"counts_per_turn must be > 0, got {float(count):g}")
        return float(2 * PI / count.fraction)
    if resolution is None:
        return None
    step = parse_number(resolution, "rad" if turning else "m", "resolution")
    if step < 0:
        raise InputError(f"resolution must be ≥ 0, got {float(step):g}")
    return float(step) or None


def _factor(where: str, quantity: str, unit: str | None, scale: object, turning: bool) -> float:
    if isinstance(scale, str):
        return _by_scale(where, unit, scale, *_wanted(quantity, turning))
    factor = _by_unit(where, quantity, unit, *_wanted(quantity, turning))
    return factor if scale is None else factor * float(parse_number(scale, "1", f"{where}: scale"))


def _ask_for_unit_of_time(table: Table, column: str) -> NoReturn:
    """With the one in which the stamps are 60 us to 60 ms apart, as recordings are."""
    stamps = next(iter(table.read((column,))), (np.empty(0),))[0]
    steps = np.abs(np.diff(np.asarray(stamps, dtype=np.float64)))
    step = float(np.median(steps[steps > 0])) if (steps > 0).any() else 1.0
    likely = next(
        unit for unit, most in (("s", 0.06), ("ms", 60), ("us", 6e4), ("ns", np.inf)) if step < most
    )
    raise InputError(
        f'{table.source}: time in column "{column}" has no unit; steps of {step:g} are most likely {likely}: '
        f'state it with units={{"time": "{likely}"}}'
    )


def _wanted(quantity: str, turning: bool) -> tuple[Dimension, str]:
    """The dimension of a quantity, and what it is in words."""
    if quantity == "time":
        return _TIME, "a time, such as ms"
    if quantity == "position":
        return (_ANGLE, "an angle, such as deg") if turning else (_LENGTH, "a length, such as mm")
    return (_TORQUE, "a torque, such as N*m") if turning else (_FORCE, "a force, such as N")


def _by_scale(where: str, unit: str | None, scale: str, wanted: Dimension, kind: str) -> float:
    factor, result, per = _scale(scale, f"{where}: scale")
    if result.dimension != wanted:
        raise InputError(f'{where}: scale "{scale}" does not lead to {kind}')
    if unit is None or unit in COUNTS or per is None:
        return factor * _si(result)
    raw = _known(unit, where)
    if raw.dimension != per.dimension:
        raise InputError(f'{where} is in {unit}; scale "{scale}" is for another unit')
    return factor * _si(result) * _si(raw) / _si(per)


def _by_unit(where: str, quantity: str, unit: str | None, wanted: Dimension, kind: str) -> float:
    if unit is None:
        turns = "joint" in where or wanted in (_ANGLE, _TORQUE)
        example = ("rad" if turns else "mm") if quantity == "position" else "N*m" if turns else "N"
        raise InputError(f'{where} has no unit; state it with units={{"{quantity}": "{example}"}}')
    force = "N*m" if wanted == _TORQUE else "N"
    if unit in COUNTS:
        raise InputError(
            f'{where} is in counts; say what a count is with scale={{"{quantity}": "0.01 {force}/count"}}'
        )
    known = _known(unit, where)
    if known.dimension[4]:
        note(unit)  # the answers are in the angle of the log
    if known.dimension != wanted:
        electric = known.dimension in (unit_of("V").dimension, unit_of("A").dimension)
        hint = f'; say what it stands for with scale={{"{quantity}": "2 {force}/{unit}"}}' if electric else ""
        raise InputError(f"{where} is in {unit}, which is not {kind}{hint}")
    return _si(known)


def _known(text: str, where: str) -> Unit:
    try:
        return measured_in(text)
    except InputError as error:
        raise InputError(f"{where}: {error}") from None


def _si(unit: Unit) -> float:
    return float(Exact(unit.scale) if unit.turns == 0 else unit.scale * PI**unit.turns)


def _scale(text: str, what: str) -> tuple[float, Unit, Unit | None]:
    """The number, the unit it leads to, and the unit it is for (None: counts): "2 N/V"."""
    top, slash, bottom = text.rpartition("/")
    if not slash:
        top, bottom = text, "count"
    number, _, unit = plain(top).strip().partition(" ")
    bottom = plain(bottom).strip()
    try:
        factor = float(Exact(number))
        per = None if bottom in COUNTS else unit_of(bottom)
        return factor, unit_of(spelled(unit)), per
    except InputError as error:
        raise InputError(
            f'{what}: "{text}" is no factor such as "2 N/V" or "0.01 N/count": {error}'
        ) from None
