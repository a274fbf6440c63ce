"""From the numbers in a column to SI: by its unit, a factor such as "2 N/V", or a step such as "22.4 um".

No unit, no number: a column whose unit nobody states is refused.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from zwidth.data.logs.block import Motion
from zwidth.data.logs.names import check_quantity, name_and_unit
from zwidth.data.logs.outside import measured_in
from zwidth.data.logs.table import Table
from zwidth.errors import InputError
from zwidth.quantity.exact import Exact
from zwidth.quantity.spoken import note
from zwidth.quantity.units import PI, Dimension, Unit, parse_number, plain, spelled, unit_of

_LENGTH, _ANGLE, _TIME = unit_of("m").dimension, unit_of("rad").dimension, unit_of("s").dimension
_FORCE, _TORQUE = unit_of("N").dimension, unit_of("N*m").dimension
_COUNTS = ("count", "counts", "cnt", "cts", "ticks", "tick", "lsb", "LSB", "digit", "digits")


@dataclass(frozen=True, kw_only=True)
class Meaning:
    """What the columns of a table are.

    Parameters
    ----------
    columns
        The column of each quantity that there is.
    factors
        SI per number in the column, of each.
    motion
        "linear" or "rotary".
    resolution
        [m; rad] stated step of the encoder; None if nobody stated it.
    """

    columns: Mapping[str, str]
    factors: Mapping[str, float]
    motion: Motion
    resolution: float | None


def meaning_of(
    table: Table,
    columns: Mapping[str, str],
    *,
    units: Mapping[str, str] | None,
    scale: Mapping[str, object] | None,
    resolution: object,
    counts_per_turn: object,
    motion: str | None,
) -> Meaning:
    """Factors to SI of every column, and whether the device turns."""
    _check_keys("units", units, columns)
    _check_keys("scale", scale, columns)
    scale = {quantity: _number_or_text(given) for quantity, given in (scale or {}).items()}
    _check_scales(scale)
    _refuse_other_units(table, columns, units or {})
    stated = {q: _stated((units or {}).get(q), q) or _own_unit(table, c, q) for q, c in columns.items()}
    if motion is None and table.attributes.get("motion") in ("linear", "rotary"):
        motion = table.attributes["motion"]
    if resolution is None and counts_per_turn is None:
        resolution = _resolution(table)
    turning = _turning(motion, stated["position"], scale.get("position"), resolution, counts_per_turn)
    step = _step(resolution, counts_per_turn, turning)
    factors = {}
    for quantity, column in columns.items():
        times = scale.get(quantity)
        if quantity == "position" and _is_counts(stated[quantity]) and not isinstance(times, str):
            if step is None:
                raise InputError(
                    f'{table.source}: "{column}" is in counts; say what a count is with '
                    'resolution="22.4 um" '
                    "or counts_per_turn=4096"
                )
            factors[quantity] = step if times is None else step * float(parse_number(times, "1", "scale"))
            continue
        where = f'{table.source}: {quantity} in column "{column}"'
        factors[quantity] = _factor(where, quantity, stated[quantity], times, turning)
    return Meaning(
        columns=columns, factors=factors, motion="rotary" if turning else "linear", resolution=step
    )


def is_unit(text: str) -> bool:
    """True where a text spells a unit, a count, or nothing."""
    unit = spelled(text)
    try:
        measured_in(unit)
    except InputError:
        return _is_counts(unit)
    return True


def _resolution(table: Table) -> float | None:
    """The resolution that a trace of ours says it has."""
    values = (table.attributes.get(key) for key in ("resolution_m", "resolution_rad"))
    return next((float(v) for v in values if v is not None), None)


def _check_keys(what: str, given: Mapping[str, object] | None, columns: Mapping[str, str]) -> None:
    for key in given or {}:
        check_quantity(what, key)
        if key not in columns:
            raise InputError(f"{what}: the log has no {key}; leave it out, or name its column in columns")


def _number_or_text(scale: object) -> object:
    """A bare factor that was typed, such as "-1", as the number that it is."""
    try:
        return Exact(scale) if isinstance(scale, str) else scale
    except InputError:
        return scale


def _refuse_other_units(table: Table, columns: Mapping[str, str], units: Mapping[str, str]) -> None:
    """A unit that is given for a column whose file or name states another: which of the two is meant?"""
    for quantity, given in units.items():
        column = columns[quantity]
        stated = _own_unit(table, column, quantity)
        if stated is None or _is_counts(stated) or not is_unit(stated) or stated == _stated(given, quantity):
            continue
        raise InputError(
            f'{table.source}: column "{column}" says of itself that it is in {stated}, and {given} is given; '
            "leave the unit out, or say what a number in it stands for with "
            f'scale={{"{quantity}": "1 {given}"}}'
        )


def _check_scales(scale: Mapping[str, object]) -> None:
    for quantity, given in scale.items():
        what = f"scale of the {quantity}"
        factor = _scale(given, what)[0] if isinstance(given, str) else float(parse_number(given, "1", what))
        if factor == 0:
            raise InputError(f"{what} must not be 0: nothing would be left of the column")


def _own_unit(table: Table, column: str, quantity: str) -> str | None:
    """The unit that the file, or else the name of the column, states."""
    return _stated(table.units[column] or name_and_unit(column, quantity)[1], quantity)


def _stated(text: str | None, quantity: str) -> str | None:
    """A unit in the spelling of `unit_of`."""
    if text is None:
        return None
    return spelled(text.split(" since ")[0] if quantity == "time" else text)


def _is_counts(unit: str | None) -> bool:
    return unit in _COUNTS


def _turning(
    motion: str | None, unit: str | None, scale: object, resolution: object, counts_per_turn: object
) -> bool:
    """True for a rotary device: as stated, or as the unit of its position says."""
    if motion not in (None, "linear", "rotary"):
        raise InputError(f'motion is "linear" or "rotary", got {motion!r}')
    kinds = []
    if isinstance(scale, str):
        kinds.append(_scale(scale, "scale of the position")[1].dimension)
    elif unit is not None and not _is_counts(unit):
        kinds.append(unit_of(unit).dimension)
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
    return seen.pop() if seen else False


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
    if unit is None or _is_counts(unit) or per is None:
        return factor * _si(result)
    raw = _known(unit, where)
    if raw.dimension != per.dimension:
        raise InputError(f'{where} is in {unit}; scale "{scale}" is for another unit')
    return factor * _si(result) * _si(raw) / _si(per)


def _by_unit(where: str, quantity: str, unit: str | None, wanted: Dimension, kind: str) -> float:
    if unit is None:
        turns = "joint" in where
        example = {"time": "ms", "position": "rad" if turns else "mm"}.get(quantity, "N*m" if turns else "N")
        raise InputError(f'{where} has no unit; state it with units={{"{quantity}": "{example}"}}')
    if _is_counts(unit):
        raise InputError(
            f'{where} is in counts; say what a count is with scale={{"{quantity}": "0.01 N/count"}}'
        )
    known = _known(unit, where)
    if known.dimension[4]:
        note(unit)  # the answers are in the angle of the log
    if known.dimension != wanted:
        electric = known.dimension in (unit_of("V").dimension, unit_of("A").dimension)
        hint = f'; say what it stands for with scale={{"{quantity}": "2 N/{unit}"}}' if electric else ""
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
        per = None if _is_counts(bottom) else unit_of(bottom)
        return factor, unit_of(spelled(unit)), per
    except InputError as error:
        raise InputError(
            f'{what}: "{text}" is no factor such as "2 N/V" or "0.01 N/count": {error}'
        ) from None
