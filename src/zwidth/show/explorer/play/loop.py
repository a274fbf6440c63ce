"""From a device and what it renders to a loop that a page plays: law emitted, plant laid out.

The page's engine moves the plant by the module of `firmware.plant` and asks the law by that of
`firmware.module`: with the same hand, what is played has the bits of `zwidth.simulate`.
"""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from typing import Any

from zwidth.errors import InputError
from zwidth.loop.pair.setup import prepare_pair
from zwidth.loop.plant import Plant
from zwidth.loop.setup import frame_of
from zwidth.machine.firmware.javascript import module
from zwidth.machine.firmware.law import law_program
from zwidth.model.device.device import Device
from zwidth.model.environment.environment import Environment
from zwidth.model.environment.transfer_function import as_environment
from zwidth.model.operator import LinearHand, Tracking, usual_hand
from zwidth.model.pairs import Pair
from zwidth.passivity.check import check
from zwidth.passivity.result import Answer
from zwidth.show.explorer.play.played import Played

LONGEST_DELAY = 10
"""[s]: nobody plays with more."""

_REACH = {"linear": 0.02, "rotary": 1.0}
_OUTSIDE = -0.4
"""Of the reach: where a touch of a wall begins."""

_DO = "Take the handle, go to the wall and press; then let go."
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
    do: str = _DO,
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
        The page shows positions from −reach to reach [m; rad]; by default 20 mm, or 1 rad.
    do, notice
        What to do, and what to look for.
    decide
        `zwidth.check`, or what takes its place; it is asked last.

    Raises
    ------
    InputError
        If the loop cannot be simulated or emitted, or its delay is too long to be played.
    """
    law = as_environment(environment)
    text = module(law_program(device, law), about=["The law that is played."], numbers=())
    holding = hand or usual_hand(device).hand
    period = device.exact("sample_period")
    shown = _REACH[device.motion] if reach is None else reach
    begin = (_OUTSIDE * shown if law.unilateral else 0.0) if start is None else start
    frame = frame_of(device, _still(holding), period, None, None, 1)
    arm = _arm(device, period, frame.plant, holding, begin)
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
        do=do,
        notice=notice,
    )


def _still(hand: LinearHand) -> Tracking:
    """A hand that stays where it is: what it is made of is all that is asked for."""
    return Tracking([0.0], mass=hand.mass, stiffness=hand.stiffness, damping=hand.damping)


def _arm(device: Device, period: Fraction, plant: Plant, hand: LinearHand, start: float) -> dict[str, Any]:
    """What the engine needs of an arm, SI."""
    if device.exact("delay") > LONGEST_DELAY:
        raise InputError(
            f"a delay of {float(device.exact('delay')):g} s is not played, at most {LONGEST_DELAY} s: "
            "the hand would feel nothing for so long"
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
