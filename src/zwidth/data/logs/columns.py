"""Which column is which, by its name, and the unit that is written there.

"position_mm", "enc (counts)" and "force [N]" are recognised: a unit stands at the end of a name, in brackets,
after a slash or an underscore.  What is left is compared with the words below, the last part of a path alone
("log/left/position" is "position").  Two candidates are never chosen between.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from difflib import get_close_matches
from fractions import Fraction
from typing import Any

from zwidth.data.logs.table import listed
from zwidth.errors import InputError
from zwidth.quantity.units import Dimension, Unit, spelled, unit_of

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
    if word in asked or word == "wished_force":  # of a served loop
        return "commanded_force"
    return "force" if word in ("force", "f", "torque", "tau") else None


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
        if {words[c] for c in found} == {"x"} and "y" in words.values():
            found += [c for c, word in words.items() if word in ("y", "z")]
        if found:
            return found
    return []


def _first_in_seconds(columns: Mapping[str, Any], found: Mapping[str, str]) -> list[str]:
    """The first column, where the file says that it is in a unit of time, however it is called."""
    column, unit = next(iter(columns.items()), ("", None))
    known = isinstance(unit, str) and dimension_of(spelled(unit)) == unit_of("s").dimension
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


_OUTSIDE: Mapping[str, tuple[str, Fraction]] = {
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


COUNTS = ("count", "counts", "cnt", "cts", "ticks", "tick", "lsb", "LSB", "digit", "digits")


def dimension_of(unit: str | None) -> Dimension | None:
    """Of a unit; None where it is none."""
    try:
        return None if unit is None else measured_in(unit).dimension
    except InputError:
        return None


def is_unit(text: str) -> bool:
    """True where a text spells a unit, a count, or nothing."""
    return dimension_of(spelled(text)) is not None or spelled(text) in COUNTS
