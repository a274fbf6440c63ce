"""The file of what a device renders: a wall, detents, or a stop at the end of its way."""

from __future__ import annotations

import shlex
from collections.abc import Callable
from pathlib import Path

from zwidth.cli.asking.device_questions import MOTION, motion_of
from zwidth.cli.asking.questions import Asker, Question
from zwidth.cli.asking.written import Row, Written, table
from zwidth.environment import NonlinearSpring, Wall
from zwidth.errors import InputError
from zwidth.quantity.units import parse_number
from zwidth.specification.table import quoted, suggestion

_HEAD = "As zwidth new environment was told."

_POINTS = 26
"""Of a stop that hardens: the chords are close to the curve."""

_KINDS = ("wall", "detents", "bump-stop")


def _kind(answer: str) -> str:
    if answer not in _KINDS:
        raise InputError(f"there is no {quoted(answer)} here; {suggestion(answer, _KINDS)}")
    return answer


TYPE = Question(
    "type",
    f"What is it to be? {', '.join(_KINDS)}",
    "A wall is a spring from x = 0 on; a bump stop begins further on; detents hold the handle at places.",
    _kind,
    "One of them must be chosen; zwidth check --help names what else a file may describe.",
    needed=True,
)


def _of_unit(unit: str, key: str) -> Callable[[str], object]:
    return lambda answer: parse_number(answer, unit, key)


def _questions(motion: str) -> dict[str, Question]:
    """What is asked, by key, in the units of the motion."""
    way, force, stiff, damped, many = (
        ("rad", "N*m", "N*m/rad", "N*m*s/rad", "10 deg")
        if motion == "rotary"
        else ("m", "N", "N/m", "N*s/m", "5 mm")
    )
    hard = f"{stiff}/{way}^2"
    rows = (
        ("stiffness", stiff, f"How stiff? such as 20 {stiff}", "The device's damping must pay for it."),
        (
            "virtual_damping",
            damped,
            f"With how much virtual damping? such as 0.01 {damped}; Enter for none",
            "It takes out energy, and costs stiffness: velocity is known late and in steps.",
        ),
        ("count", "1", "How many detents? such as 3", "Beyond the first and the last the handle is free."),
        ("pitch", way, f"How far from one to the next? such as {many}", "Its slope is 4 peak/pitch."),
        (
            "peak",
            force,
            f"What leads over the edge of one? such as 0.02 {force}",
            "Its slope is 4 peak/pitch.",
        ),
        ("start", way, f"Where does the stop begin? such as {many}", "Up to there the handle is free."),
        (
            "hardening",
            hard,
            f"How does it harden, f = K u + H u^3? such as 1000 {hard}; Enter for not at all",
            "A stop that hardens is as steep as K + 3 H u^2.",
        ),
        ("depth", way, f"How deep is it at most? such as {many}", "Deeper than that the force is constant."),
    )
    optional = ("virtual_damping", "hardening")
    return {
        key: Question(
            key,
            ask,
            why,
            _of_unit(unit, key),
            "None, then." if key in optional else "It must be known.",
            key not in optional,
        )
        for key, unit, ask, why in rows
    }


QUESTIONS = (TYPE, MOTION, *_questions("rotary").values())
"""Everything that may be asked."""


def described(ask: Asker, path: Path) -> Written:
    """Ask about an environment; its file, and what to do next.

    Raises
    ------
    InputError
        If an answer cannot be used, or one is missing.
    """
    kind, motion = _sure(ask, TYPE), motion_of(_sure(ask, MOTION))
    text = _FILES[kind](ask, _questions(motion), motion)
    does = "check" if kind == "wall" else "limit"
    more = "" if kind == "wall" else " --parameter rate"
    return Written(text, ["next:", f"  zwidth {does} my-device.toml {shlex.quote(str(path))}{more}"])


def _sure(ask: Asker, question: Question) -> str:
    """An answer that there is no file without."""
    while (answer := ask(question)) is None:
        if not ask.in_terminal:
            ask.finish("an environment")
            raise InputError(f"{question.option} must be known: {question.ask}")
    return answer


def _wall(ask: Asker, questions: dict[str, Question], motion: str) -> str:
    stiffness, damping = _sure(ask, questions["stiffness"]), ask(questions["virtual_damping"])
    ask.finish("a wall")
    Wall(stiffness, damping or 0)
    rows = [Row("type", "wall"), Row("stiffness", stiffness)]
    return table("environment", _HEAD, rows + ([Row("damping", damping)] if damping else []))


def _detents(ask: Asker, questions: dict[str, Question], motion: str) -> str:
    count, pitch, peak = (_sure(ask, questions[key]) for key in ("count", "pitch", "peak"))
    ask.finish("a row of detents")
    many = parse_number(count, "1", "count")
    if many.fraction.denominator != 1:
        raise InputError(f"count is a whole number of detents, got {count}")
    spring = NonlinearSpring.detents(int(many), pitch, peak)
    return _spring(spring, f"{count} detents, {pitch} apart, {peak} at most", motion)


def _bump_stop(ask: Asker, questions: dict[str, Question], motion: str) -> str:
    start, stiffness = _sure(ask, questions["start"]), _sure(ask, questions["stiffness"])
    hardening, depth = ask(questions["hardening"]), _sure(ask, questions["depth"])
    ask.finish("a bump stop")
    spring = NonlinearSpring.bump_stop(start, stiffness, hardening or 0, depth, _POINTS if hardening else 2)
    return _spring(
        spring, f"A stop from {start} on, f = {stiffness} u{_harder(hardening)}, to {depth}", motion
    )


def _harder(hardening: str | None) -> str:
    return f" + {hardening} u^3" if hardening else ""


_FILES: dict[str, Callable[[Asker, dict[str, Question], str], str]] = {
    "wall": _wall,
    "detents": _detents,
    "bump-stop": _bump_stop,
}


def _spring(spring: NonlinearSpring, remark: str, motion: str) -> str:
    """A nonlinear spring as its table."""
    way, force = ("rad", "N*m") if motion == "rotary" else ("m", "N")
    positions, forces = (
        [f"{number:.9g} {unit}" for number in numbers]
        for numbers, unit in ((spring.positions, way), (spring.forces, force))
    )
    rows = [Row("type", "nonlinear-spring"), Row("positions", positions), Row("forces", forces)]
    return table("environment", f"{_HEAD} {remark}.", rows)
