"""Loops to begin with: what each shows is known from its verdict, which is asked for where the page is made."""

from __future__ import annotations

from zwidth.device.device import Device
from zwidth.device.rotary import rotary
from zwidth.environment import PulseTransferFunction, StandardLinearSolid, Wall
from zwidth.environment.nonlinear_spring import NonlinearSpring
from zwidth.explorer.play.loop import Played, played, played_pair
from zwidth.operator import LinearHand
from zwidth.pairs import Pair
from zwidth.rendering import render
from zwidth.rendering.energy.force_bounding import ForceBounding
from zwidth.rendering.energy.passivity_controller import PassivityController

_PRESS = "Take the handle, push it slowly into the wall, hold it there, then let go."


def presets() -> list[Played]:
    """Every loop of the page, in its order."""
    return [
        _passive(), _buzz(), _bounce(), _wobble(), _tissue(), _detents(), *_hard_wall(), *_arms(),
    ]  # fmt: skip


def _paddle(**changes: object) -> Device:
    """The haptic paddle of the catalogue, in round numbers."""
    paddle = Device(
        mass="36 g",
        damping="0.15 N*s/m",
        coulomb_friction="0.12 N",
        resolution="22.4 um",
        rate="1 kHz",
        force_limit="16.5 N",
        name="haptic paddle",
    )
    return paddle.replace(**changes)


def _passive() -> Played:
    return played(
        _paddle(),
        Wall(300),
        name="A wall that is proved",
        do=_PRESS,
        notice="The handle comes to rest at once, and there is nothing to hear but the press itself.",
    )


def _buzz() -> Played:
    return played(
        _paddle(resolution="0.2 mm", coulomb_friction="0.02 N"),
        Wall(600, 3),
        name="Buzz: a coarse encoder",
        do=_PRESS,
        notice="The velocity that the damper is told jumps by a count in a sample: it buzzes while you press.",
    )


def _bounce() -> Played:
    return played(
        _paddle(rate="100 Hz"),
        Wall(500),
        name="Bounce: a slow rate",
        do="Push the handle against the wall and hold the hand still at the surface.",
        notice="Each bounce comes out faster than it went in: the force is up to 10 ms old.",
    )


def _wobble() -> Played:
    wheel = rotary(
        inertia="0.05 kg*m^2",
        damping="0.02 N*m*s/rad",
        coulomb_friction="0.05 N*m",
        resolution="0.1 mrad",
        rate="500 Hz",
        delay="10 ms",
        force_limit="8 N*m",
        name="wheel",
    )
    return played(
        wheel,
        PulseTransferFunction([20], [1]),
        name="Death wobble: a wheel, hands off",
        do="Turn the wheel a little, then let go and keep your hands off.",
        notice="Held, it is calm. Hands off it swings further and further: the motor pays for what friction takes.",
    )


def _tissue() -> Played:
    return played(
        _paddle(),
        StandardLinearSolid(60, 150, 4),
        name="Soft tissue",
        do="Press in, wait, and come back quickly.",
        notice="It gives way under the hand: the force falls while you wait, and coming back it is less.",
    )


def _detents() -> Played:
    return played(
        _paddle(),
        NonlinearSpring.detents(3, "8 mm", "0.5 N"),
        name="Detents",
        do="Move the handle from one notch to the next, and let go between them.",
        notice="It snaps into the nearest notch and rests there.",
    )


def _hard_wall() -> list[Played]:
    paddle, wall = _paddle(resolution=0), Wall(2000)
    counted = _paddle()
    return [
        played(
            paddle,
            wall,
            name="Too hard a wall: no controller",
            do=_PRESS,
            notice="It kicks the hand back, and the hand gets out more energy than it put in.",
        ),
        played(
            paddle,
            render(wall, PassivityController()),
            name="The same: passivity controller on",
            do=_PRESS,
            notice="Energy that the controller counts as given out is taken back by damping, a sample later.",
        ),
        played(
            counted,
            render(wall, ForceBounding()),
            name="The same: force bounding on",
            do=_PRESS,
            notice="The force is never more than what the hand has paid for: softer, and it is proved.",
        ),
    ]


def _arms() -> list[Played]:
    arm = _paddle(force_limit="5 N")
    held = LinearHand(mass=0.0, stiffness=60.0, damping=0.2)
    near = Pair(arm, arm, stiffness=60, damping="0.05")
    far = near.replace(delay="20 ms")
    return [
        played_pair(
            near,
            name="Two arms, no delay",
            follower=held,
            notice="The lower arm, tied to a spring, follows; the hand feels that spring.",
        ),
        played_pair(
            far,
            name="Two arms, a link of 20 ms",
            follower=held,
            notice="Both arms swing against each other: each reads where the other was 20 ms ago.",
        ),
    ]
