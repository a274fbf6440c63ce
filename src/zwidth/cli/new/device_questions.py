"""What `zwidth new device` asks: what a person knows of a device, and why it matters."""

from __future__ import annotations

import re
from collections.abc import Callable

from zwidth.cli.new import motor
from zwidth.cli.new.questions import Question, Row, need_unit, understood
from zwidth.errors import InputError
from zwidth.model.device import Device
from zwidth.model.device.rotary import ROTARY, rotary
from zwidth.model.specification.read import question_unit
from zwidth.quantity.exact import Exact, Interval
from zwidth.quantity.parameter import parameters_of, read_number
from zwidth.quantity.units import parse, parse_number

NEEDED = ("rate", "damping")
"""Without them nothing is proved: who leaves them out must say so."""


def motion_of(answer: str) -> str:
    """ "rotary" or "linear", in these words or in others."""
    said = set(answer.lower().split())
    found = [motion for motion, words in _MOTIONS.items() if said & words]
    if len(found) != 1:
        raise InputError(f'it turns or slides: write rotary or linear, got "{answer[:40]}"')
    return found[0]


_MOTIONS = {
    "rotary": {"rotary", "turn", "turns", "rotate", "rotates", "rotation", "wheel", "knob", "yes", "y"},
    "linear": {"linear", "slide", "slides", "slider", "no", "n"},
}
"""Words of an answer to whether the handle turns."""


MOTION = Question(
    "motion",
    "Does the handle turn, like a wheel or a knob, or slide? rotary or linear",
    "It decides the units: torque and angle, or force and way. A short lever, seen at the hand, slides.",
    motion_of,
    "It must be known: move the handle.",
    needed=True,
)


def unit_of_answer(key: str, motion: str) -> str:
    return "Hz" if key == "rate" else (ROTARY.get(key) or parameters_of(Device)[key]).unit_for(motion)


def _check(key: str, motion: str) -> Callable[[str], str]:
    """Reads an answer as the device itself would, and says how."""

    def check(answer: str) -> str:
        unit = unit_of_answer(key, motion)
        number = read(answer)
        need_unit(answer, number, unit, key)
        return understood(number, unit)

    def read(answer: str) -> Exact | Interval:
        if key in ROTARY:
            why = "leave it out if unknown"
            positive: Exact | Interval = read_number(
                answer, ROTARY[key], key, uncertain=True, bound="> 0", why=why, motion=motion
            )
            return positive
        if key == "rate":
            Device(damping=0, rate=answer)
            return parse(answer, "Hz", key)
        own = parameters_of(Device)[key]
        number: Exact | Interval = read_number(
            answer, own.quantity, key, uncertain=True, bound=own.bound, why=own.why, motion=motion
        )
        if key == "delay":
            question_unit(answer, number, key)
        return number

    return check


def _question(motion: str, key: str, ask: str, why: str, unknown: str) -> Question:
    return Question(key, ask, why, _check(key, motion), unknown, key in NEEDED)


RADIUS = _question(
    "rotary",
    "handle_radius",
    "From the axis to the hand? such as 7 cm; Enter to keep torque and angle, as for a wheel",
    "With it walls are in newtons and metres at the hand; without it in torque and angle.",
    "Left out: torque and angle, at the axis.",
)


def encoder(motion: str) -> Question:
    """What one count of the encoder is."""
    ask = (
        "Encoder, at the axis of the handle? such as 65536 counts/turn, 2000 lines, 14 bit or 0.09 deg; on a "
        "motor that turns 17.45 times as often, 980 counts/turn x 17.45"
        if motion == "rotary"
        else "One step of the encoder, at the handle? such as 22.4 um"
    )
    return Question(
        "encoder",
        ask,
        "Each step of the reading is a step of the force, and dry friction must pay for it.",
        lambda answer: encoder_understood(answer, motion),
        "Left out: a verdict takes it as 0, an ideal encoder, and says so; see its data sheet.",
    )


def inertia(motion: str) -> Question:
    """How heavy it is."""
    key, ask = (
        ("inertia", "Moment of inertia about the axis? such as 0.006 kg m2")
        if motion == "rotary"
        else ("mass", "Mass that the hand feels at the handle? such as 36 g")
    )
    return _question(
        motion,
        key,
        ask,
        "No proof depends on it; zwidth simulate needs it to move the device.",
        "Left out: zwidth identify finds it in a log.",
    )


def loop(motion: str) -> tuple[Question, ...]:
    """How often, how late, and what friction pays for it."""
    such = "0.0001 N*m*s/rad of a knob, 0.02 of a wheel" if motion == "rotary" else "0.1 N*s/m"
    return (
        _question(
            motion,
            "rate",
            "Samples per second of the force loop? such as 1 kHz",
            "The force is held from one sample to the next; the longer, the more energy it gives out.",
            "Nothing is proved without it: zwidth doctor says what rate this machine can keep.",
        ),
        _question(
            motion,
            "delay",
            "Time from reading the position to giving the force? such as 0.3 ms",
            "A late force gives out energy, as a low rate does.",
            "Left out: a verdict takes it as 0, and says so; zwidth serve measures it.",
        ),
        _question(
            motion,
            "damping",
            f"Viscous friction of the device, measured? such as {such}",
            "It pays for the wall: without delay a spring may be as stiff as 2 b/T.",
            "Nothing is proved without it: zwidth identify finds it in a log of the device moved by hand.",
        ),
    )


def forces(motion: str) -> tuple[Question, ...]:
    """What else may be known; else the motor's data sheet is asked for."""
    turns = motion == "rotary"
    return (
        _question(
            motion,
            "coulomb_friction",
            f"Dry friction, measured: what keeps it moving slowly? such as 0.1 {'N*m' if turns else 'N'}",
            "It pays for the steps of the encoder: it must be K Δ/2 or more.",
            "Not measured.",
        ),
        _question(
            motion,
            "force_limit",
            f"Largest {'torque' if turns else 'force'} at the handle? such as {'2 N*m' if turns else '5 N'}",
            "It says how hard a wall can be at all; no proof depends on it.",
            "Not known.",
        ),
    )


def _all(motion: str) -> tuple[Question, ...]:
    return MOTION, inertia(motion), encoder(motion), *loop(motion), *forces(motion)


QUESTIONS = (*_all("rotary"), RADIUS, *_all("linear"), *motor.QUESTIONS)
"""Everything that may be asked; those of either motion twice."""


LINES = 4
"""Counts that quadrature decoding makes of one line."""

_LARGEST_BITS = 40

_COUNTED = re.compile(
    r"(?P<number>2\s*(\^|\*\*)\s*(?P<power>[0-9]{1,2})|[^a-z°^]+?)\s*"
    r"(?P<unit>counts?|steps?|cpr|lines?|ppr|bits?)?(\s*(/|per)\s*(turn|rev(olution)?))?",
    re.IGNORECASE,
)

_GEARED = re.compile(r"(?P<encoder>.+?)\s*(?:[x×]|\btimes\b)\s*(?P<ratio>[0-9.]+)\s*", re.IGNORECASE)
"""An encoder on the motor, and the turns of the motor in one of the handle."""


def read_encoder(answer: str, motion: str) -> Row:
    """The row of the file that says the size of one count."""
    if motion == "linear":
        if re.search(r"count|step|cpr|line|ppr|bit|\^", answer, re.IGNORECASE):
            raise InputError(
                f'of a device that slides the step is a length, got "{answer[:40]}"; with N counts in a turn '
                "of a drum of radius r it is 2 π r/N, of 10 mm and 2000 counts 31.4 um"
            )
        step = parse_number(answer, "m", "resolution")
        need_unit(answer, step, "m", "resolution")
        Device(damping=0, rate=1, resolution=step)
        return Row("resolution", answer)
    geared = _GEARED.fullmatch(answer)
    if geared is not None:
        return _of_the_motor(geared["encoder"], geared["ratio"])
    counted = _COUNTED.fullmatch(answer)
    if counted is None:
        rotary(damping=0, rate=1, resolution=parse_number(answer, "rad", "resolution"))
        return Row("resolution", answer)
    number = str(2 ** int(counted["power"])) if counted["power"] else counted["number"]
    counts, remark = _counts(number, (counted["unit"] or "counts").lower(), answer)
    if float(counts) < 1:
        raise InputError(
            f'an encoder has 1 count in a turn or more, got "{answer[:40]}"; of an angle write the unit'
        )
    rotary(damping=0, rate=1, counts_per_turn=counts)
    return Row("counts_per_turn", counts, remark)


def _of_the_motor(encoder: str, typed: str) -> Row:
    """The row of an encoder on a motor that turns several times in one turn of the handle."""
    ratio = parse_number(typed, "1", "turns of the motor in one of the handle").fraction
    if ratio <= 0:
        raise InputError(f'the motor turns more than 0 times in one turn of the handle, got "{typed[:40]}"')
    row = read_encoder(encoder, "rotary")
    if row.key != "counts_per_turn":
        raise InputError(
            f'behind "x {typed[:20]}" stand the turns of the motor in one of the handle, and before it the '
            f'counts in a turn of the motor, as in "980 counts/turn x 17.45"; got "{encoder[:40]}"'
        )
    counts = f"{float(parse_number(str(row.value), '1', 'counts').fraction * ratio):.12g}"
    rotary(damping=0, rate=1, counts_per_turn=counts)
    of_one = row.remark or f"{row.value} counts in a turn"
    remark = f"{of_one} of the motor, which turns {typed} times in one of the handle"
    return Row("counts_per_turn", counts, remark)


def encoder_understood(answer: str, motion: str) -> str:
    """What one count is, in SI; how many there are in a turn."""
    row = read_encoder(answer, motion)
    unit = "rad" if motion == "rotary" else "m"
    if row.key == "resolution":
        return understood(parse_number(answer, unit, "resolution"), unit)
    step = rotary(damping=0, rate=1, counts_per_turn=str(row.value)).resolution
    remark = f" ({row.remark})" if row.remark else ""
    return f"{row.value} counts in a turn{remark}, one is {understood(step, unit)}"


def _counts(number: str, unit: str, answer: str) -> tuple[str, str]:
    """Counts in a turn, and what was made of the answer."""
    value = parse_number(number, "1", f"number of {unit.removesuffix('s')}s").fraction
    if unit.startswith("bit"):
        if value.denominator != 1 or not 0 < value <= _LARGEST_BITS:
            raise InputError(
                f'an encoder has a whole number of bits, at most {_LARGEST_BITS}, got "{answer[:40]}"'
            )
        return str(2 ** int(value)), f"{value} bits: 2 to the power of {value} counts in a turn"
    if unit.startswith(("line", "ppr")):
        return f"{float(LINES * value):.12g}", f"{number.strip()} lines in a turn, {LINES} counts each"
    return f"{float(value):.12g}", ""
