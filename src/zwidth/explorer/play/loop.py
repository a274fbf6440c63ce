"""One loop as a page plays it: the emitted law, the numbers of plant and hand, and what is claimed of it.

The page's engine moves the plant by the module of `firmware.plant` and asks the law by that of
`firmware.module`: with the same hand, what is played has the bits of `zwidth.simulate`.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from zwidth.device.device import Device
from zwidth.environment.environment import Environment
from zwidth.environment.transfer_function import as_environment
from zwidth.errors import InputError
from zwidth.firmware.law import law_program
from zwidth.firmware.module import module
from zwidth.loop.pair.setup import prepare_pair
from zwidth.loop.plant import Plant
from zwidth.loop.setup import frame_of
from zwidth.operator import LinearHand, Tracking
from zwidth.pairs import Pair
from zwidth.passivity.check import check
from zwidth.passivity.outcome import COLOUR
from zwidth.passivity.result import Answer
from zwidth.quantity.glossary import GLOSSARY, unit_suffix
from zwidth.quantity.parameter import parameters_of
from zwidth.quantity.text import in_words, shown, unit_text

FINGER = LinearHand(mass=0.006, stiffness=500.0, damping=1.7)
"""Of `operators.Finger`: it holds the handle of a linear device [kg, N/m, N·s/m]."""

BANDWIDTH = 8.0
"""Of the hand that turns a wheel [Hz]."""

LONGEST_DELAY = 10
"""[s]: nobody plays with more."""

_REACH = {"linear": 0.02, "rotary": 1.0}
_DO = "Take the handle, go to the wall and press; then let go."
_NOTICE = "Whether it comes to rest, and whether the hand gets out more energy than it put in."


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
        units = {name: GLOSSARY[name].unit_for(self.motion) for name in ("position", "velocity", "force")}
        return {
            "name": self.name,
            "motion": self.motion,
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
            yield "", "coupling", pair.describe()
            yield from _device_numbers(pair.leader)
        else:
            device, environment = self.loop[0], self.loop[-1]
            assert isinstance(environment, Environment)
            yield "", "law", environment.describe(device.motion)
            yield from _device_numbers(device)
        for symbol, key, value in zip(("m_h", "k", "c"), LinearHand._fields, self.hand, strict=True):
            if value:
                yield symbol, f"{key} of the hand", shown(value, GLOSSARY[key].unit_for(self.motion))


def played(
    device: Device,
    environment: Environment | Any,
    verdict: Answer | None = None,
    *,
    name: str = "",
    hand: LinearHand | None = None,
    start: float = 0.0,
    reach: float | None = None,
    do: str = _DO,
    notice: str = _NOTICE,
) -> Played:
    """A loop of one device, ready for a page.

    Parameters
    ----------
    device
        With a mass; every number certain.
    environment
        What it renders, with the laws in its chain.
    verdict
        On this loop; None to ask `zwidth.check`.
    name
        What the page calls it; by default what the environment says of itself.
    hand
        By default a finger, or a hand of 8 Hz on a wheel.
    start
        Where handle and hand begin [m; rad].
    reach
        The page shows positions from −reach to reach [m; rad]; by default 20 mm, or 1 rad.
    do, notice
        What to do, and what to look for.

    Raises
    ------
    InputError
        If the loop cannot be simulated or emitted, or its delay is too long to be played.
    """
    law = as_environment(environment)
    text = module(law_program(device, law), about=["The law that is played."], numbers=())
    holding = hand or _default_hand(device)
    period = device.exact("sample_period")
    follows = Tracking([start], mass=holding.mass, stiffness=holding.stiffness, damping=holding.damping)
    frame = frame_of(device, follows, period, None, None, 1)
    return Played(
        name=name or law.describe(device.motion),
        loop=(device, law),
        hand=holding,
        start=start,
        follower=LinearHand(),
        verdict=check(device, law) if verdict is None else verdict,
        law=text,
        arms=[_arm(device, period, frame.plant, holding, start)],
        reach=_REACH[device.motion] if reach is None else reach,
        do=do,
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
    do: str = "Lead the upper arm; then let go.",
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
    holding, other = hand or _default_hand(pair.leader), follower or LinearHand()
    hands = [
        Tracking([0.0], mass=h.mass, stiffness=h.stiffness, damping=h.damping) for h in (holding, other)
    ]
    tick = pair.sample_period / pair.own_readings
    setup = prepare_pair(pair, *hands, tick, encoder_phase=(0.0, 0.0), amplifier=None, points_per_sample=1)
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
        do=do,
        notice=notice,
    )


def _default_hand(device: Device) -> LinearHand:
    if device.motion == "linear":
        return FINGER
    if device.mass is None:
        raise InputError("a page moves the device, which takes its inertia: give mass")
    inertia = float(device.exact("mass"))
    return Tracking.of_bandwidth([0.0], frequency=BANDWIDTH, moved_mass=inertia).hand


def _arm(device: Device, period: Fraction, plant: Plant, hand: LinearHand, start: float) -> dict[str, Any]:
    """What the engine needs of an arm, SI."""
    if device.exact("delay") > LONGEST_DELAY:
        raise InputError(
            f"a delay of {float(device.exact('delay')):g} s is not played, at most {LONGEST_DELAY} s: the hand "
            "would feel nothing for so long"
        )
    delay = device.exact("delay") / period
    used = ("mass", "damping", "coulomb", "stiction")
    return {
        "period": float(period),
        "late": delay.numerator // delay.denominator,
        "offset": float(delay % 1 * period),
        "resolution": float(device.exact("resolution")),
        "plant": {key: float(getattr(plant, key)) for key in used},
        "hand": {key: float(value) for key, value in hand._asdict().items()},
        "start": float(start),
        "limit": float(device.exact("force_limit")) if device.force_limit is not None else 0.0,
    }


def _device_numbers(device: Device) -> Iterator[tuple[str, str, str]]:
    for key, value in device.parameters().items():
        own = parameters_of(Device).get(key)
        symbol = own.quantity.symbol if own else GLOSSARY[key].symbol
        yield symbol, in_words(key), shown(value, GLOSSARY[key].unit_for(device.motion))
