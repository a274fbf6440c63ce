"""Which column is which, and its numbers in SI: by a unit, a factor, "2 N/V", or a step, "22.4 um".

No unit, no number: a column whose unit nobody states is refused.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from difflib import get_close_matches
from fractions import Fraction
from typing import Any, NoReturn

import numpy as np

from zwidth.data.logs.table import Motion, Table, listed
from zwidth.errors import InputError
from zwidth.quantity.exact import Exact
from zwidth.quantity.spoken import note
from zwidth.quantity.units import PI, Dimension, Unit, parse_number, plain, spelled, unit_of

_LENGTH, _ANGLE, _TIME = unit_of("m").dimension, unit_of("rad").dimension, unit_of("s").dimension
_FORCE, _TORQUE = unit_of("N").dimension, unit_of("N*m").dimension
_COUNTS = ("count", "counts", "cnt", "cts", "ticks", "tick", "lsb", "LSB", "digit", "digits")


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
    _check_keys("units", units, columns)
    _check_keys("scale", scale, columns)
    scale = {quantity: _number_or_text(given) for quantity, given in (scale or {}).items()}
    _check_scales(scale)
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
        if quantity == "position" and _is_counts(stated[quantity]) and not isinstance(times, str):
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


def is_unit(text: str) -> bool:
    """True where a text spells a unit, a count, or nothing."""
    unit = spelled(text)
    try:
        measured_in(unit)
    except InputError:
        return _is_counts(unit)
    return True


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
    try:
        return None if unit is None else measured_in(unit).dimension
    except InputError:  # refused where it is used
        return None


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
    if unit is None or _is_counts(unit) or per is None:
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
    if _is_counts(unit):
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
        per = None if _is_counts(bottom) else unit_of(bottom)
        return factor, unit_of(spelled(unit)), per
    except InputError as error:
        raise InputError(
            f'{what}: "{text}" is no factor such as "2 N/V" or "0.01 N/count": {error}'
        ) from None


# "position_mm", "enc (counts)" and "force [N]" are recognised: a unit stands at the end of a name, in
# brackets, after a slash or an underscore.  What is left is compared with the words below, the last part of a
# path alone ("log/left/position" is "position").  Two candidates are never chosen between.

QUANTITIES = ("time", "position", "hand_force", "actuator_force")

_WORDS: dict[str, tuple[str, ...]] = {
    "time": (
        "time t timestamp timestamps stamp elapsed elapsed_time time_stamp datetime seconds sec clock "
        "zeit uhrzeit zeitstempel temps heure tiempo hora tempo ora",
    ),
    "position": (
        "measured_position",
        "position pos x q qpos displacement encoder enc encoder_position enc_pos encoder_pos encoder_counts "
        "enc_counts counts ticks angle theta joint_position stroke "
        "weg lage stellung auslenkung winkel déplacement posición ángulo posizione spostamento",
    ),
    "hand_force": (
        "hand_force f_h fh f_hand hand_torque tau_h handkraft handmoment",
        "force f load_cell loadcell load_cell_force force_sensor measured_force external_force contact_force "
        "interaction_force user_force torque measured_torque load_cell_torque kraft drehmoment moment effort "
        "fuerza forza",
    ),
    "actuator_force": (
        "actuator_force actuator_torque f_a fa motor_force motor_torque tau_m motorkraft motormoment",
        "commanded_force commanded_torque command_force force_command force_commanded f_cmd force_cmd "
        "cmd_force torque_cmd torque_command tau_cmd desired_force sollkraft sollmoment",
    ),
}
"""Words for each quantity, the better ones first: the encoder's reading before any other position."""

_SUFFIXES = {
    "time": "s ms us µs μs ns sec secs seconds min",
    "position": "m mm um µm μm nm cm rad mrad urad deg degrees turn turns rev count counts cnt cts ticks lsb",
    "hand_force": "N mN kN n N_m Nm mNm mN_m Nmm N_mm V mV count counts lsb",
    "actuator_force": "N mN kN n N_m Nm mNm mN_m Nmm N_mm V mV A mA count counts lsb",
}

_BRACKETS = re.compile(r"^(.*?)\s*(?:\[([^\[\]]*)\]|\(([^()]*)\)|\s/\s*(\S+))\s*$")
_VECTOR = re.compile(r"(force|torque|velocity|linear|angular|acceleration|orientation)[./][xyzw]$")
"""Components of what is no position, in a message."""

_PLACE = re.compile(r"^(.*\S)\[([^\[\]]*)\]$")
"""Behind a list in a message or a matrix which of it is meant, by number or by name: "q[0]", "q[elbow]"."""

_AGAIN = re.compile(r" \(\d+\)$")
"""Behind a name that stands there more than once, see `layout`: it may be meant as the first one may."""


def recognise(
    columns: Mapping[str, Any], chosen: Mapping[str, str | None] | None, source: str
) -> dict[str, str]:
    """The column of each quantity that there is: first what the user chose, None to go without."""
    found = _checked(columns, chosen or {}, source)
    for quantity in QUANTITIES:
        if quantity in found or quantity in (chosen or {}):
            continue
        candidates = _candidates(quantity, [c for c in columns if c not in found.values()])
        if not candidates and quantity == "time":
            candidates = _first_in_seconds(columns, found)
        if len(candidates) > 1:
            raise InputError(
                f"{source}: {listed(candidates)} may each be the {quantity}; "
                f'say which with columns={{"{quantity}": "{candidates[0]}"}}'
            )
        if candidates:
            found[quantity] = candidates[0]
    if "position" not in found:
        raise InputError(
            f'{source}: no column is known to be the position; say which with columns={{"position": …}}; '
            f"there are {listed(columns) or 'no columns of numbers'}"
        )
    return {quantity: found[quantity] for quantity in QUANTITIES if quantity in found}


def name_and_unit(column: str, quantity: str) -> tuple[str, str | None]:
    """The word and the unit in a column's name: "position_mm" is "position" and "mm"."""
    column = _AGAIN.sub("", column)
    bare = column.strip()
    placed = _PLACE.match(bare)
    if placed is not None and (placed[2].isdigit() or bare.startswith("/") or not is_unit(placed[2])):
        bare = placed[1]
    bracketed = _BRACKETS.match(bare) if bare == column.strip() else None
    if bracketed is not None:
        unit = next(g for g in bracketed.groups()[1:] if g is not None).strip()
        return _word(bracketed[1]), unit or None
    name, slash, last = bare.partition("/")
    if slash and last in _SUFFIXES[quantity].split():  # "t/s", as German sheets have it, and no path
        return _word(name), last
    word = re.split(r"[/.]", bare)[-1]
    for suffix in sorted(_SUFFIXES[quantity].split(), key=len, reverse=True):
        if word.endswith("_" + suffix) and len(word) > len(suffix) + 1:
            return _word(word[: -len(suffix) - 1]), suffix
    plain = _word(word)
    if plain in ("encoder_counts", "enc_counts"):
        return plain, "counts"
    return plain, plain if plain in ("counts", "ticks", "seconds", "sec") else None


def role_of_force(column: str) -> str | None:
    """What a column of force is by its name: "actuator_force" that the motor gave, "commanded_force" that the
    law asked for, "force" where it may be either, or the hand's; None where it is none of these."""
    word = name_and_unit(column, "actuator_force")[0]
    if _VECTOR.search(column.lower()):
        return None
    given, asked = (tier.split() for tier in _WORDS["actuator_force"])
    if word in given or word == "effort":  # of a joint state: what the motor gives
        return "actuator_force"
    return (
        "commanded_force"
        if word in asked or word == "wished_force"  # of a served loop
        else "force"
        if word in ("force", "f", "torque", "tau")
        else None
    )


_AIMED = "target goal desired des reference ref setpoint command commanded cmd planned soll"
_OF_A_PLACE = "position pos q qpos x angle theta joint encoder displacement weg winkel lage"


def is_target(column: str) -> bool:
    """True of a column that is by its name the position that a law aims at: "goal_position", "q_des"."""
    if _VECTOR.search(column.lower()):
        return False
    word = re.sub(r"^soll(?=position|weg|winkel|lage)", "soll_", name_and_unit(column, "position")[0])
    words = {each for each in word.split("_") if each and not each.isdigit()}
    alone = bool(words) and words <= {"target", "goal", "setpoint", "reference"}
    aimed, place = set(_AIMED.split()), set(_OF_A_PLACE.split())
    return alone or (words <= aimed | place and bool(words & aimed) and bool(words & place))


def _word(text: str) -> str:
    last = re.split(r"[/.]", text.strip())[-1]
    return re.sub(r"[\s\-]+", "_", last.strip().lower())


def _candidates(quantity: str, columns: list[str]) -> list[str]:
    words = {c: name_and_unit(c, quantity)[0] for c in columns if not _VECTOR.search(c.lower())}
    for tier in _WORDS[quantity]:
        found = [column for column, word in words.items() if word in tier.split()]
        if found == [c for c in found if words[c] == "x"] and "y" in words.values():
            found += [c for c in columns if words[c] in ("y", "z")] if found else []
        if found:
            return found
    return []


def _first_in_seconds(columns: Mapping[str, Any], found: Mapping[str, str]) -> list[str]:
    """The first column, where the file says that it is in a unit of time, however it is called."""
    column, unit = next(iter(columns.items()), ("", None))
    try:
        known = isinstance(unit, str) and measured_in(spelled(unit)).dimension == _TIME
    except InputError:
        known = False
    return [column] if known and column not in found.values() else []


def check_quantity(what: str, name: str) -> None:
    """Refuse a name that is none of the quantities."""
    if name not in QUANTITIES:
        raise InputError(f'{what}: there is no quantity "{name}"; there are {", ".join(QUANTITIES)}')


def _checked(columns: Mapping[str, Any], chosen: Mapping[str, str | None], source: str) -> dict[str, str]:
    for quantity, column in chosen.items():
        check_quantity("columns", quantity)
        if column is not None and column not in columns:
            near = get_close_matches(column, list(columns), n=1)
            hint = f'; did you mean "{near[0]}"?' if near else ""
            raise InputError(f'{source} has no column "{column}"{hint}; there are {listed(columns)}')
    taken: dict[str, str] = {}
    for quantity, column in chosen.items():
        if column is not None and (other := taken.setdefault(column, quantity)) != quantity:
            raise InputError(
                f'{source}: column "{column}" is given as the {other} and as the {quantity}; one column '
                "holds one quantity: which is it?"
            )
    return {quantity: column for quantity, column in chosen.items() if column is not None}


WEIGHT = Fraction("9.80665")
"""Of a kilogram [N], by definition (3rd CGPM, 1901)."""

POUND = WEIGHT * Fraction("0.45359237")
"""Of force [N]."""

_OUTSIDE: Mapping[str, tuple[str, Fraction]] = {
    **dict.fromkeys(("gf", "pond"), ("N", WEIGHT / 1000)),
    **dict.fromkeys(("kgf", "kp"), ("N", WEIGHT)),
    "lbf": ("N", POUND),
    **dict.fromkeys(("in", "inch", "inches"), ("m", Fraction("0.0254"))),
    **dict.fromkeys(("d", "day", "days", "tag", "tage"), ("s", Fraction(86400))),
    **dict.fromkeys(("h", "hr", "hours"), ("s", Fraction(3600))),
    **dict.fromkeys(("minutes", "mins"), ("s", Fraction(60))),
}


def measured_in(text: str) -> Unit:
    """A unit as `unit_of` has it, or one of these."""
    try:
        return unit_of(text)
    except InputError:
        if text not in _OUTSIDE:
            raise
    base, scale = _OUTSIDE[text]
    return unit_of(base)._replace(scale=scale)
