"""The file of a device, made of what a person knows of it, and of what the motor's data sheet says."""

from __future__ import annotations

from collections.abc import Iterable
from math import floor, inf, log10
from pathlib import Path

from zwidth.cli.new import motor
from zwidth.cli.new.device_questions import (
    MOTION,
    NEEDED,
    QUESTIONS,
    RADIUS,
    encoder,
    forces,
    inertia,
    loop,
    motion_of,
    read_encoder,
    unit_of_answer,
)
from zwidth.cli.new.questions import Asker, Question, Row, Written, table, with_unit
from zwidth.model.device import Device
from zwidth.model.environment import Wall
from zwidth.model.specification.read import build_device, tables_of
from zwidth.passivity.check import check
from zwidth.quantity.spoken import spoken
from zwidth.showing import typed

__all__ = ["QUESTIONS", "described"]

_HEAD = "As zwidth new device was told. What was not measured is an estimate: zwidth identify measures it."


def described(ask: Asker, path: Path) -> Written:
    """Ask about a device; its file, and what to do next."""
    motion = _motion(ask)
    rows = [Row("motion", motion), _row(ask, inertia(motion), motion)]
    answer, unknown = ask(encoder(motion)), Row("resolution", None, encoder(motion).unknown)
    rows.append(unknown if answer is None else read_encoder(answer, motion))
    if motion == "rotary" and (radius := ask(RADIUS)) is not None:
        rows.append(Row(RADIUS.key, radius))
    rows += [_row(ask, question, motion) for question in loop(motion)]
    measured = {question.key: _row(ask, question, motion) for question in forces(motion)}
    sheet = motor.derived(ask, motion, [key for key, row in measured.items() if row.value is None])
    rows += [sheet.get(key, row) for key, row in measured.items()]
    ask.finish("a device")
    at_handle = "linear" if any(row.key == RADIUS.key for row in rows) else motion
    text = table("device", _HEAD, rows)
    return Written(text, _next(text, [row.key for row in rows if row.value is None], path, motion, at_handle))


def _motion(ask: Asker) -> str:
    turning = [key for key in ("inertia", "handle_radius", "gear_ratio") if key in ask]
    sliding = [key for key in ("mass", "drum_radius") if key in ask]
    if "motion" not in ask and bool(turning) != bool(sliding):
        return "rotary" if turning else "linear"
    return motion_of(ask.sure(MOTION))


def _row(ask: Asker, question: Question, motion: str) -> Row:
    answer = ask(question)
    if answer is None:
        return Row(question.key, None, question.unknown)
    return Row(question.key, with_unit(answer, unit_of_answer(question.key, motion)))


def _next(text: str, unknown: list[str], path: Path, motion: str, at_handle: str) -> list[str]:
    """What to type now: a check, or what must be measured before it."""
    name = typed(str(path))
    missing = [key for key in NEEDED if key in unknown]
    if missing:
        tried = f"{name} {guessed(missing, motion)} {_GUESSES['stiffness'][at_handle]}"
        turned = motion == "rotary" and "damping" in missing
        guess = "the damping of a knob (a wheel has 0.02)" if turned else "a guess"
        first = [*(line for key in missing for line in _MEASURE[key]), f"to try what if, with {guess}:"]
    else:
        device = build_device(tables_of(text, path.name, ("device",))["device"])
        tried, first = f"{name} {_stiffness(device)}", ["next, a wall:"]
    return [
        *first,
        f"  zwidth check {tried}",
        "the same as a page to hand on:",
        f"  zwidth report {tried} -o {typed(str(path.with_suffix('.html')))}",
        "a file of what it renders, a wall, detents or a stop:",
        f"  zwidth new environment --device {name}",
    ]


def guessed(missing: Iterable[str], motion: str) -> str:
    """Options with a guess of what a device must have and lacks."""
    guesses = {"rate": '--rate "1 kHz"', "damping": _GUESSES["damping"][motion]}
    return " ".join(guesses[key] for key in missing)


_GUESSES = {
    "stiffness": {"linear": '--stiffness "100 N/m"', "rotary": '--stiffness "0.1 N*m/deg"'},
    "damping": {"linear": '--damping "0.1 N*s/m"', "rotary": '--damping "0.0001 N*m*s/rad"'},
}
_MEASURE = {
    "rate": ("measure the rate of your loop; what this machine can keep says", "  zwidth doctor"),
    "damping": (
        "measure the damping: log position and force while a hand moves the device, then",
        "  zwidth identify session.csv -o identified.toml",
    ),
}


def _stiffness(device: Device) -> str:
    """The option of a stiffness to begin with: near the largest passive one, cut to two digits."""
    largest = getattr(check(device, Wall(1)), "max_stiffness", None)
    if largest is None or not 0 < largest < inf:
        return _GUESSES["stiffness"][device.motion]
    factor, unit = spoken("N*m/rad") if device.motion == "rotary" else (1.0, "N/m")
    digit = 10.0 ** (floor(log10(largest * factor)) - 1)
    return f'--stiffness "{floor(largest * factor / digit) * digit:.4g} {unit}"'
