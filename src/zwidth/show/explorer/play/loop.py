"""From a device and what it renders to a loop that a page plays: law emitted, plant laid out.

The page's engine moves the plant by the module of `firmware.plant` and asks the law by that of
`firmware.module`: with the same hand, what is played has the bits of `zwidth.simulate`; behind
a transmission they differ by rounding.
"""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from importlib.resources import files
from typing import Any

from zwidth.errors import InputError
from zwidth.loop.pair.setup import prepare_pair
from zwidth.loop.plant import Plant
from zwidth.loop.setup import MOST_PIECES, frame_of
from zwidth.loop.two_bodies import numbers_of, packed_two
from zwidth.machine.firmware.javascript import module
from zwidth.machine.firmware.law import law_program
from zwidth.machine.firmware.plant import given_plant, given_two, plant_module, plant_program
from zwidth.model.device import Device, Transmission
from zwidth.model.environment.environment import Environment
from zwidth.model.environment.transfer_function import as_environment
from zwidth.model.operator import LinearHand, Tracking, usual_hand
from zwidth.model.operator.named import usual_kind
from zwidth.model.pairs import Pair
from zwidth.passivity.check import check
from zwidth.passivity.result import Answer
from zwidth.passivity.scope import COLOUR
from zwidth.passivity.transmission import seen_at_motor
from zwidth.quantity.glossary import GLOSSARY, unit_suffix
from zwidth.quantity.parameter import parameters_of
from zwidth.quantity.text import in_words, shown, unit_text
from zwidth.showing import element

LONGEST_DELAY = 10
"""[s]: nobody plays with more."""

_REACH = {"linear": 0.02, "rotary": 1.0}
_OUTSIDE = -0.4
"""Of the reach: where a touch of a wall begins."""

_DO = {
    "handle": "Take the handle, go to the wall and press; then let go.",
    "wheel": "Take the wheel, turn it to the right until it resists, and press; then let go.",
    "knob": "Take the knob, turn it to the right until it resists, and press; then let go.",
}
_NOTICE = "Whether it comes to rest, and whether the hand gets out more energy than it put in."


def played(
    device: Device,
    environment: Environment | Any,
    verdict: Answer | None = None,
    *,
    name: str = "",
    hand: LinearHand | None = None,
    start: float | None = None,
    reach: float | None = None,
    do: str = "",
    notice: str = _NOTICE,
    decide: Callable[[Device, Environment], Answer] = check,
) -> Played:
    """A loop of one device, ready for a page.

    Parameters
    ----------
    device
        With a mass; every number certain.
    environment
        What it renders, with the laws in its chain.
    verdict
        On this loop; None to ask `decide`.
    name
        What the page calls it; by default what the environment says of itself.
    hand
        By default that of `zwidth.operators.usual_hand`: a finger, or fingers on a knob, or hands on a wheel.
    start
        Where handle and hand begin [m; rad]; by default outside a wall, or at 0.
    reach
        The page shows positions from −reach to reach [m; rad]; by default 20 mm, or 1 rad, and a tenth more
        than all the points of a spring.
    do, notice
        What to do, and what to look for.
    decide
        `zwidth.check`, or what takes its place; it is asked last.

    Raises
    ------
    InputError
        If the loop cannot be simulated or emitted, or its delay is too long to be played.
    """
    law = as_environment(environment, device=device)
    text = module(law_program(seen_at_motor(device), law), about=["The law that is played."], numbers=())
    holding = hand or usual_hand(device).hand
    period = device.exact("sample_period")
    farthest = max((abs(float(place)) for place, _ in law.met.points), default=0.0)
    shown = max(_REACH[device.motion], 1.1 * farthest) if reach is None else reach
    begin = (_OUTSIDE * shown if law.unilateral else 0.0) if start is None else start
    frame = frame_of(device.motor_side, _still(holding), period, None, None, 1)
    arm = _arm(device.motor_side, period, frame.plant, holding, begin)
    numbers = numbers_of(device, _still(holding), frame.plant, MOST_PIECES)
    if numbers is not None:
        two = packed_two(numbers)
        own = {key: float(getattr(two.handle, key)) for key in _USED}
        arm |= {"two": {**own, "spring": two.spring, "damper": two.damper, "at_handle": two.sensed > 0.0}}
    return Played(
        name=name or law.describe(device.motion),
        loop=(device, law),
        hand=holding,
        start=begin,
        follower=LinearHand(),
        verdict=decide(device, law) if verdict is None else verdict,
        law=text,
        arms=[arm],
        reach=shown,
        do=do or _DO[_thing(device)],
        notice=notice,
    )


def played_pair(
    pair: Pair,
    verdict: Answer | None = None,
    *,
    name: str = "",
    hand: LinearHand | None = None,
    follower: LinearHand | None = None,
    reach: float | None = None,
    do: str = "",
    notice: str = _NOTICE,
) -> Played:
    """Two arms, ready for a page; the hand holds the leader.

    Parameters
    ----------
    pair
        Without compensation of friction; both arms with a mass.
    verdict
        On this pair; None to ask `zwidth.check`.
    name, hand, reach, do, notice
        As of `played`.
    follower
        What holds the follower where it begins; None for nothing.

    Raises
    ------
    InputError
        If the pair cannot be simulated, or compensates friction.
    """
    if any(pair.compensations):
        raise InputError("a page plays pairs without compensation of friction: leave compensation out")
    holding, other = hand or usual_hand(pair.leader).hand, follower or LinearHand()
    tick = pair.sample_period / pair.own_readings
    setup = prepare_pair(
        pair,
        _still(holding),
        _still(other),
        tick,
        encoder_phase=(0.0, 0.0),
        amplifier=None,
        points_per_sample=1,
    )
    devices = (pair.leader, pair.follower)
    return Played(
        name=name or pair.describe(),
        loop=(pair,),
        hand=holding,
        start=0.0,
        follower=other,
        verdict=check(pair) if verdict is None else verdict,
        law="",
        arms=[
            {**_arm(device, tick, arm.plant, h, 0.0), "law": arm.law._asdict()}
            for device, arm, h in zip(devices, setup.arms, (holding, other), strict=True)
        ],
        reach=_REACH[pair.motion] if reach is None else reach,
        do=do or f"Lead the {'upper arm' if pair.motion == 'linear' else 'left one'}; then let go.",
        notice=notice,
    )


def _thing(device: Device) -> str:
    return {"finger": "handle", "hands-on": "wheel", "fingers-on": "knob"}[usual_kind(device)]


def _still(hand: LinearHand) -> Tracking:
    """A hand that stays where it is: what it is made of is all that is asked for."""
    return Tracking([0.0], mass=hand.mass, stiffness=hand.stiffness, damping=hand.damping)


_USED = ("mass", "damping", "coulomb", "stiction")


def _arm(device: Device, period: Fraction, plant: Plant, hand: LinearHand, start: float) -> dict[str, Any]:
    """What the engine needs of an arm, SI."""
    if device.exact("delay") > LONGEST_DELAY:
        raise InputError(
            f"a delay of {shown(device.exact('delay'), 's', 6)} is not played, at most "
            f"{shown(LONGEST_DELAY, 's')}: the hand would feel nothing for so long"
        )
    delay = device.exact("delay") / period
    return {
        "period": float(period),
        "late": delay.numerator // delay.denominator,
        "offset": float(delay % 1 * period),
        "resolution": float(device.exact("resolution")),
        "plant": {key: float(getattr(plant, key)) for key in _USED},
        "hand": {key: float(value) for key, value in hand._asdict().items()},
        "start": float(start),
        "limit": float(device.exact("force_limit")) if device.force_limit is not None else 0.0,
    }


@dataclass(frozen=True, kw_only=True, eq=False)
class Played:
    """A loop that a page can play: made by `played` or `played_pair`.

    Parameters
    ----------
    name
        What the page calls it.
    loop
        (device, environment), or (pair,).
    hand
        Mass, stiffness and damping of the hand at the handle.
    start
        Where handle and hand begin [m; rad].
    follower
        What holds the follower of a pair where it begins.
    verdict
        On the loop.
    law
        The text of the law's module; "" for a pair.
    arms
        What the engine needs of each arm, SI.
    reach
        The page shows positions from −reach to reach [m; rad].
    do, notice
        What to do, and what to look for.
    """

    name: str
    loop: tuple[Device, Environment] | tuple[Pair]
    hand: LinearHand
    start: float
    follower: LinearHand
    verdict: Answer
    law: str
    arms: list[dict[str, Any]]
    reach: float
    do: str
    notice: str

    @property
    def motion(self) -> str:
        """ "linear" or "rotary"."""
        return self.loop[0].motion

    def facts(self) -> dict[str, Any]:
        """All that the page shows and runs, but the law, as plain data."""
        device = self.loop[0].leader if isinstance(self.loop[0], Pair) else self.loop[0]
        units = {name: GLOSSARY[name].unit_for(self.motion) for name in ("position", "velocity", "force")}
        return {
            "name": self.name,
            "motion": self.motion,
            "thing": _thing(device),
            "do": self.do,
            "notice": self.notice,
            "outcome": self.verdict.outcome,
            "colour": COLOUR[self.verdict.outcome],
            "claim": self.verdict.claim,
            "assumptions": list(self.verdict.small_print()),
            "numbers": list(self._numbers()),
            "keys": {name: unit_suffix(unit) for name, unit in units.items()},
            "force_unit": unit_text(units["force"]),
            "reach": self.reach,
            "often": self.loop[0].own_readings if isinstance(self.loop[0], Pair) else 1,
            "one_sided": len(self.loop) == 2 and self.loop[1].unilateral,
            "arms": self.arms,
        }

    def _numbers(self) -> Iterator[tuple[str, str, str]]:
        """Symbol, name and value of what the loop is made of."""
        if isinstance(self.loop[0], Pair):
            pair = self.loop[0]
            same = pair.leader == pair.follower
            yield "", "coupling", pair.describe()
            yield from _device_numbers(pair.leader, "" if same else " of the leader")
            if not same:
                yield from _device_numbers(pair.follower, " of the follower")
            yield from _hand_numbers("spring that holds the follower", self.follower, self.motion)
        else:
            device, environment = self.loop[0], self.loop[-1]
            assert isinstance(environment, Environment)
            yield "", "law", environment.describe(device.motion)
            yield from _device_numbers(device)
        yield from _hand_numbers("hand", self.hand, self.motion)


def _device_numbers(device: Device, whose: str = "") -> Iterator[tuple[str, str, str]]:
    for key, value in device.parameters().items():
        own, name = GLOSSARY[key], in_words(key, device.motion)
        symbol = "J" if name == "inertia" else own.symbol
        yield symbol, f"{name}{whose}", shown(value, own.unit_for(device.motion))
    if device.transmission is not None:
        for key, value in device.transmission.parameters().items():
            own = parameters_of(Transmission)[key].quantity
            yield own.symbol, f"transmission: {in_words(key)}", shown(value, own.unit_for(device.motion))
        yield "", "encoder", f"at the {device.transmission.encoder}"


def _hand_numbers(name: str, hand: LinearHand, motion: str) -> Iterator[tuple[str, str, str]]:
    """On one line; what is 0 is not there."""
    given = [
        (symbol, shown(value, GLOSSARY[key].unit_for(motion)))
        for symbol, (key, value) in zip(("m_h", "k", "c"), hand._asdict().items(), strict=True)
        if value
    ]
    if given:
        yield ", ".join(symbol for symbol, _ in given), name, ", ".join(text for _, text in given)


_EXPORTED = re.compile(r"^export (?:const|function|class) (\w+)", re.MULTILINE)
_IMPORT_LINE = re.compile(r'^import (\{[^}]*\}) from "\./(\w+)\.mjs";$', re.MULTILINE)

MODULES = ("engine", "recording", "sound", "draw", "player", "view")
"""The page's own, each after those that it imports."""


def play_page(loops: Sequence[Played], *, title: str = "Play with a loop") -> str:
    """A page of HTML on which a person plays these loops; it works from a file, offline, and in a frame.

    Parameters
    ----------
    loops
        At least one; see `played` and `played_pair`.
    title
        Its heading.

    Raises
    ------
    InputError
        If there is no loop.
    """
    if not loops:
        raise InputError("a page plays one loop at least; got none")
    two = any("two" in arm for loop in loops for arm in loop.arms)
    modules = [
        f"const plant = {_as_function(plant_text())};",
        f"plant.two = {_as_function(plant_text(two=True)) if two else 'null'};",
        f"const laws = [{', '.join(_as_function(loop.law) if loop.law else 'null' for loop in loops)}];",
        *(f"const {name} = {_as_function(_file(f'{name}.mjs'))};" for name in MODULES),
        'view.start(document.getElementById("play"), plant, laws);',
    ]
    facts = json.dumps([loop.facts() for loop in loops], ensure_ascii=False).replace("<", "\\u003c")
    parts = {
        "title": element("title", title),
        "heading": element("h1", title),
        "style": _file("play.css"),
        "facts": facts,
        "script": "\n".join(modules).replace("</", "<\\/").replace("<!--", "<\\!--"),
    }
    return re.sub(r"<!-- (\w+) -->", lambda found: parts[found[1]], _file("page.html"))


def plant_text(*, two: bool = False) -> str:
    """The module that moves every device and hand: it is told their numbers, and how long.

    `two` for those with a transmission.
    """
    return plant_module(plant_program(given_two() if two else given_plant(amplified=False), None, "anchored"))


def _file(name: str) -> str:
    return files("zwidth.show.explorer.play").joinpath(name).read_text(encoding="utf-8")


def _as_function(module: str) -> str:
    """An ES module as an expression: what it exports, as one object; what it imports stands before it.

    A page that is a file, or a text in a frame, has no address from which a module could be imported.
    """
    names = ", ".join(_EXPORTED.findall(module))
    body = _IMPORT_LINE.sub(r"const \1 = \2;", module)
    return f"(() => {{\n{re.sub('^export ', '', body, flags=re.MULTILINE)}return {{ {names} }};\n}})()"
