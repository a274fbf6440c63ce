"""Friction and largest force at the handle, from the data sheet of the motor:

    τ_c = n k_t I_0,  F_max = n k_t I_max   of a handle that turns, n turns of the motor in one of its own
    f_c = k_t I_0/r,  F_max = k_t I_max/r   of one that slides, pulled from a drum of radius r

with the torque constant k_t, which is 1/k_v of a speed constant k_v in rad/(V s), the no-load current I_0 and
the largest current I_max.  k_t I_0 is all friction at the no-load speed, viscous friction too: an estimate.
"""

from __future__ import annotations

from collections.abc import Collection
from fractions import Fraction
from typing import NamedTuple

from zwidth.cli.new.questions import Asker, Question, Row, need_unit, understood
from zwidth.errors import InputError
from zwidth.quantity.exact import Exact
from zwidth.quantity.units import parse_number

_UNITS = {"torque_constant": ("N*m/A", "rad/V/s"), "gear_ratio": ("1",), "drum_radius": ("m",)}
_CURRENT_OR_TORQUE = ("A", "N*m")

_MEASURE = (
    "A verdict takes it as 0, the careful side, and says so: hang weights on the handle until it just "
    "keeps moving."
)
_LIMIT = "Nothing but the largest force depends on it."


class _Read(NamedTuple):
    """A positive number, and which of the units it was given in."""

    value: Fraction
    unit: str


def _read(key: str, answer: str) -> _Read:
    units = _UNITS.get(key, _CURRENT_OR_TORQUE)
    if key == "gear_ratio" and ":" in answer:
        return _Read(_turns(answer), "1")
    if not any(map(str.isalpha, answer)) and len(units) > 1:
        raise InputError(f"{key} needs its unit, {' or '.join(units)}, got {answer[:40]}")
    for unit in units:
        try:
            number = parse_number(answer, unit, key)
            break
        except InputError:
            if unit == units[-1]:
                parse_number(answer, units[0], key)  # says what was wrong
    if number.fraction <= 0:
        raise InputError(f"{key} must be > 0, got {number:g}; leave it out if unknown")
    return _Read(number.fraction, unit)


def _turns(answer: str) -> Fraction:
    """Of the motor in one of the handle, of a gear as it is named: 5:1."""
    motor, _, handle = answer.partition(":")
    sides = [parse_number(one.strip(), "1", "gear_ratio").fraction for one in (motor, handle)]
    if not sides[0] >= sides[1] > 0:
        raise InputError(
            f'which of the two turns more in "{answer[:40]}"? write 5 where the motor turns five times '
            "in one turn of the handle, 0.2 where the handle does in one of the motor"
        )
    return sides[0] / sides[1]


def _question(key: str, ask: str, why: str, unknown: str) -> Question:
    return Question(key, ask, why, lambda answer: _understood(key, answer), unknown)


def _understood(key: str, answer: str) -> str:
    read = _read(key, answer)
    number = Exact(read.value)
    need_unit(answer, number, read.unit, key)
    return understood(number, read.unit)


FRICTION = _question(
    "motor_friction",
    "Motor's data sheet: no-load current, or friction torque? such as 0.2 A or 5 mN*m",
    "Friction at the handle is estimated of it: torque constant x no-load current x gear ratio.",
    f"Left out. {_MEASURE}",
)
PEAK = _question(
    "motor_peak",
    "Motor's data sheet: largest current, or peak torque? such as 3.3 A or 0.2 N*m",
    "The largest force follows: torque constant x current x gear ratio.",
    f"Left out. {_LIMIT}",
)
CONSTANT = _question(
    "torque_constant",
    "Torque constant of the motor, or its speed constant? such as 0.06 N*m/A or 270 rpm/V",
    "It makes a torque of the current.",
    "Left out, and with it what follows from a current.",
)
RATIO = _question(
    "gear_ratio",
    "Turns of the motor in one turn of the handle? such as 5 or 5:1; Enter for 1, driven directly",
    "Torque and friction at the handle are so many times those of the motor.",
    "Not known, so nothing is taken from the motor's data sheet.",
)._replace(needed=True, enter="1")
RADIUS = _question(
    "drum_radius",
    "Radius of the drum or pulley on the motor's axis; behind a gear of 5:1 a fifth of it? such as 10 mm",
    "The force at the handle is torque over radius.",
    "Not known, so nothing is taken from the motor's data sheet.",
)._replace(needed=True)

QUESTIONS = (CONSTANT, FRICTION, PEAK, RATIO, RADIUS)

_OF = {"coulomb_friction": (FRICTION, _MEASURE), "force_limit": (PEAK, _LIMIT)}


def derived(ask: Asker, motion: str, wanted: Collection[str]) -> dict[str, Row]:
    """Of the keys that were not measured what the data sheet says, each as a row of the file."""
    if not wanted:
        return {}
    constant = ask(CONSTANT)
    answers = {key: ask(_OF[key][0]) for key in wanted}
    known = {key: _read(_OF[key][0].key, answer) for key, answer in answers.items() if answer is not None}
    usable = [key for key, read in known.items() if constant is not None or read.unit != "A"]
    way = RATIO if motion == "rotary" else RADIUS
    gear = ask(way) if usable else None
    rows = {}
    for key in wanted:
        answer, of = answers[key], _OF[key][1]
        if key not in known:
            also = f"The torque constant {constant} is known; a current is not. " if constant else ""
            rows[key] = Row(key, None, also + of)
        elif key in usable and gear is not None:
            rows[key] = _at_handle(key, known[key], answer or "", constant or "", gear, motion)
        else:
            lacks = CONSTANT if key not in usable else way
            rows[key] = Row(key, None, f"{answer} of the motor says it with {lacks.option}. {of}")
    return rows


def _at_handle(key: str, read: _Read, answer: str, constant: str, gear: str, motion: str) -> Row:
    factors = [answer]
    torque = read.value
    if read.unit == "A":
        k = _read("torque_constant", constant)
        torque *= k.value if k.unit == "N*m/A" else 1 / k.value
        factors.insert(0, constant if k.unit == "N*m/A" else f"1/({constant})")
    ratio = _read("gear_ratio" if motion == "rotary" else "drum_radius", gear).value
    value, unit = (torque * ratio, "N*m") if motion == "rotary" else (torque / ratio, "N")
    formula = f"{' x '.join(factors)} {'x' if motion == 'rotary' else '/'} {gear}"
    estimate = (
        ", at the no-load speed, part of it viscous: an estimate, measure it" if key != "force_limit" else ""
    )
    return Row(key, f"{float(Exact(value)):.6g} {unit}", f"{formula}, of the motor's data sheet{estimate}")
