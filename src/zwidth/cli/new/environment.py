"""The file of what a device renders: a wall, detents, or a stop at the end of its way."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

from zwidth.cli.new.device import guessed
from zwidth.cli.new.device_questions import MOTION, NEEDED, motion_of
from zwidth.cli.new.questions import Asker, Question, Row, Written, need_unit, table, understood, with_unit
from zwidth.cli.output import print_text
from zwidth.errors import InputError
from zwidth.missing import suggestion
from zwidth.model.device import Device
from zwidth.model.environment import NonlinearSpring, Wall
from zwidth.model.specification.read import load_device, read_tables
from zwidth.model.specification.table import Table, quoted
from zwidth.quantity.exact import ends
from zwidth.quantity.spoken import spoken
from zwidth.quantity.text import shown
from zwidth.quantity.units import parse_number
from zwidth.showing import typed

__all__ = ["QUESTIONS", "described"]

DEVICE = "my-device.toml"
"""The file that zwidth new device writes, where nobody names another."""

_HEAD = "As zwidth new environment was told."

_POINTS = 26
"""Of a stop that hardens: the chords are close to the curve."""


def described(ask: Asker, path: Path, named: str | None = None) -> Written:
    """Ask about an environment; its file, and what to do next.

    `path`: where the file will be.
    `named`: the device that is to render it, a file or a name in the catalogue; None: `DEVICE`, where it is
        there.
    """
    kind = kind_of(ask.sure(TYPE))
    whose = DEVICE if named is None else named
    device = _device(ask, named)
    if "motion" in ask or device is None:
        if ask.in_terminal and "motion" not in ask:
            print_text(f"There is no device in {DEVICE} here; --device FILE names another.")
        motion = motion_of(ask.sure(MOTION))
    else:
        motion = device.motion
        print_text(f"{whose} is {motion} at the handle, so this is too; --motion says otherwise.")
    same = device if device is not None and device.motion == motion else None
    text = _FILES[kind](_Asked(ask, motion, same, whose))
    return Written(text, _next(path, whose))


def _device(ask: Asker, named: str | None) -> Device | None:
    if named is not None:
        return device_of(named)
    return None if ask.piped else beside(DEVICE)  # what a pipe answers does not depend on the folder


def _next(path: Path, whose: str) -> list[str]:
    missing = lacking(whose)
    guess = f" {guessed(missing, told_as(whose))}" if missing else ""
    first = (
        []
        if missing is not None
        else ["the device first, or --device FILE if it has another name:", "  zwidth new device"]
    )
    head = f"next, with a guess of what {whose} lacks:" if missing else "next:"
    return [*first, head, f"  zwidth check {typed(whose)} {typed(str(path))}{guess}"]


def refuse_a_device(path: Path) -> None:
    """Refuse to write over the file of a device: its name was most likely meant as the device."""
    if path.exists() and lacking(str(path)) is not None:
        name = typed(str(path))
        raise InputError(
            f"{path} describes a device, and an environment is a file of its own; to describe what that "
            f"device renders: zwidth new environment --device {name}"
        )


class _Asked(NamedTuple):
    """Whoever answers, in the units of a motion; the device if it moves so, and where it is described."""

    ask: Asker
    motion: str
    device: Device | None
    whose: str

    def unit(self, key: str) -> str:
        return units_of(self.motion)[key]

    def sure(self, key: str) -> str:
        """An answer that there is no file without, with its unit."""
        return with_unit(self.ask.sure(questions_of(self.motion)[key]), self.unit(key))

    def perhaps(self, key: str) -> str | None:
        """An answer that may be missing, with its unit."""
        answer = self.ask(questions_of(self.motion)[key])
        return None if answer is None else with_unit(answer, self.unit(key))


def _wall(asked: _Asked) -> str:
    stiffness, damping = asked.sure("stiffness"), asked.perhaps("virtual_damping")
    asked.ask.finish("a wall")
    Wall(stiffness, damping or 0)
    rows = [Row("type", "wall"), Row("stiffness", stiffness)]
    return table("environment", _HEAD, rows + ([Row("damping", damping)] if damping else []))


def _detents(asked: _Asked) -> str:
    count, pitch, peak = (asked.sure(key) for key in ("count", "pitch", "peak"))
    asked.ask.finish("a row of detents")
    spring = NonlinearSpring.detents(int(parse_number(count, "1", "count")), pitch, peak)
    return _spring(spring, f"{count} detents, {pitch} apart, {peak} at most", asked.motion)


def _bump_stop(asked: _Asked) -> str:
    start, stiffness = asked.sure("start"), asked.sure("stiffness")
    hardening = asked.perhaps("hardening")
    depth, reason = _depth(asked, stiffness, hardening)
    asked.ask.finish("a bump stop")
    spring = NonlinearSpring.bump_stop(start, stiffness, hardening or 0, depth, _POINTS if hardening else 2)
    law = f"f = ({stiffness}) u{f' + ({hardening}) u^3' if hardening else ''}"
    return _spring(spring, f"A stop from {start} on, {law}, to u = {depth}{reason}", asked.motion)


def _depth(asked: _Asked, stiffness: str, hardening: str | None) -> tuple[str, str]:
    """How deep it goes, and why so deep: where nobody says it, to the largest force of the device."""
    question, unit = questions_of(asked.motion)["depth"], asked.unit("depth")
    stiff = parse_number(stiffness, asked.unit("stiffness"), "stiffness").fraction
    most = asked.device.force_limit if asked.device is not None else None
    if most is None or stiff <= 0 or hardening is not None:
        return with_unit(asked.ask.sure(question), unit), ""
    factor, told = spoken(unit)
    deepest = f"{float(ends(most)[0] / stiff) * factor:.9g} {told}"
    limit = shown(float(ends(most)[0]), asked.unit("peak"))
    offered = f"{question.ask}; Enter for {deepest}, where it is {limit}, the largest of {asked.whose}"
    answer = asked.ask(
        question._replace(ask=offered, enter=deepest, unknown=f"{deepest}, then.", needed=False)
    )
    if answer is not None and answer != deepest:
        return with_unit(answer, unit), ""
    return deepest, f", where the force is {limit}, the largest of {asked.whose}"


_FILES: dict[str, Callable[[_Asked], str]] = {"wall": _wall, "detents": _detents, "bump-stop": _bump_stop}


def _spring(spring: NonlinearSpring, remark: str, motion: str) -> str:
    """A nonlinear spring as its table, in the angle that was typed."""
    way, force = ("rad", "N*m") if motion == "rotary" else ("m", "N")
    positions, forces = (
        [f"{number * factor:.9g} {told}" for number in numbers]
        for numbers, (factor, told) in ((spring.positions, spoken(way)), (spring.forces, spoken(force)))
    )
    rows = [Row("type", "nonlinear-spring"), Row("positions", positions), Row("forces", forces)]
    return table("environment", f"{_HEAD} {remark}.", rows)


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
        ("peak", f"What leads over the edge of one? such as 0.02 {force}", "Its slope is 4 peak/pitch."),
        ("start", f"Where does the stop begin? such as {many}", "Up to there the handle is free."),
        (
            "hardening",
            f"How does it harden, f = K u + H u^3? such as 1000 {hard}; Enter for not at all",
            "A stop that hardens is as steep as K + 3 H u^2.",
        ),
        ("depth", f"How deep? such as {many}, or largest force/stiffness", "Deeper the force is constant."),
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


_ANY = {"rate": "1 kHz", "damping": "0"}
"""In the place of what the file lacks: motion and largest force do not depend on it."""


def beside(name: str) -> Device | None:
    """As `device_of`; None where there is none to read."""
    try:
        return device_of(name)
    except InputError:
        return None


def device_of(name: str) -> Device:
    """The device of a file or of the catalogue, whose rate and damping may be made up."""
    return load_device([name], {key: _ANY[key] for key in lacking(name) or ()})


def lacking(name: str) -> list[str] | None:
    """What the file of a device has to say for a proof and does not; None where there is no such file."""
    table = _table(name)
    if table is None:
        return None
    given = {"rate" if key == "sample_period" else key for key in table.values}
    return [] if "catalogue" in given else [key for key in NEEDED if key not in given]


def told_as(name: str) -> str:
    """The motion in which the file of a device has its numbers: of a handle on a lever those of its shaft."""
    table = _table(name)
    return "linear" if table is None else str(table.values.get("motion", "linear"))


def _table(name: str) -> Table | None:
    try:
        return read_tables([name], ("device",)).get("device")
    except InputError:
        return None
