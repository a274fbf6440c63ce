"""What `zwidth new environment` asks: of a wall, of detents, of a stop."""

from __future__ import annotations

from collections.abc import Callable

from zwidth.cli.asking.device_questions import MOTION
from zwidth.cli.asking.numbers import need_unit, understood
from zwidth.cli.asking.questions import Question
from zwidth.errors import InputError
from zwidth.model.specification.table import quoted, suggestion
from zwidth.quantity.units import parse_number

_KINDS = ("wall", "detents", "bump-stop")

_ALSO = {"stop": "bump-stop", "bumpstop": "bump-stop", "end-stop": "bump-stop", "detent": "detents"}
"""What people say instead."""


def kind_of(answer: str) -> str:
    """ "wall", "detents" or "bump-stop", in these words or in others."""
    word = "-".join(answer.lower().replace("_", " ").split())
    kind = _ALSO.get(word, word)
    if kind not in _KINDS:
        raise InputError(f"there is no {quoted(answer)} here; {suggestion(word, _KINDS)}")
    return kind


TYPE = Question(
    "type",
    f"What is it to be? {', '.join(_KINDS)}",
    "A wall is a spring from x = 0 on; a bump stop begins further on; detents hold the handle at places.",
    kind_of,
    "One of them must be chosen; zwidth check --help names what else a file may describe.",
    needed=True,
)


def _of_unit(unit: str, key: str) -> Callable[[str], str]:
    def check(answer: str) -> str:
        number = parse_number(answer, unit, key)
        need_unit(answer, number, unit, key)
        if key == "count" and number.fraction.denominator != 1:
            raise InputError(f"count is a whole number of detents, got {answer[:40]}")
        return understood(number, unit)

    return check


def units_of(motion: str) -> dict[str, str]:
    """The unit of each answer."""
    way, force, stiff, damped = (
        ("rad", "N*m", "N*m/rad", "N*m*s/rad") if motion == "rotary" else ("m", "N", "N/m", "N*s/m")
    )
    return {
        "stiffness": stiff,
        "virtual_damping": damped,
        "count": "1",
        "pitch": way,
        "peak": force,
        "start": way,
        "hardening": f"{force}/{way}^3",
        "depth": way,
    }


def questions_of(motion: str) -> dict[str, Question]:
    """What is asked, by key, in the units of the motion."""
    units = units_of(motion)
    stiff, damped, force, hard = (units[key] for key in ("stiffness", "virtual_damping", "peak", "hardening"))
    many = "10 deg" if motion == "rotary" else "5 mm"
    rows = (
        ("stiffness", f"How stiff? such as 20 {stiff}", "The device's damping must pay for it."),
        (
            "virtual_damping",
            f"With how much virtual damping? such as 0.01 {damped}; Enter for none",
            "It takes out energy, and costs stiffness: velocity is known late and in steps.",
        ),
        ("count", "How many detents? such as 3", "Beyond the first and the last the handle is free."),
        ("pitch", f"How far from one to the next? such as {many}", "Its slope is 4 peak/pitch."),
        (
            "peak",
            f"What leads over the edge of one? such as 0.02 {force}",
            "Its slope is 4 peak/pitch.",
        ),
        ("start", f"Where does the stop begin? such as {many}", "Up to there the handle is free."),
        (
            "hardening",
            f"How does it harden, f = K u + H u^3? such as 1000 {hard}; Enter for not at all",
            "A stop that hardens is as steep as K + 3 H u^2.",
        ),
        (
            "depth",
            f"How deep? such as {many}, or largest force/stiffness",
            "Deeper the force is constant.",
        ),
    )
    optional = ("virtual_damping", "hardening")
    return {
        key: Question(
            key,
            ask,
            why,
            _of_unit(units[key], key),
            "None, then." if key in optional else "It must be known.",
            key not in optional,
        )
        for key, ask, why in rows
    }


QUESTIONS = (TYPE, MOTION, *questions_of("rotary").values())
"""Everything that may be asked."""
