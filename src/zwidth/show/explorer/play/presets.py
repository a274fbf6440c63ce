"""Loops to begin with; the verdict on each is asked for where the page is made."""

from __future__ import annotations

from functools import partial
from typing import Any

from zwidth.model.device.device import Device
from zwidth.model.device.rotary import rotary
from zwidth.model.environment import PulseTransferFunction, StandardLinearSolid, Wall
from zwidth.model.environment.nonlinear import NonlinearSpring
from zwidth.model.operator import LinearHand
from zwidth.model.pairs import Pair
from zwidth.model.rendering import render
from zwidth.model.rendering.bounding import ForceBounding
from zwidth.model.rendering.passivity_controller import PassivityController
from zwidth.show.explorer.play.loop import Played, played, played_pair

_SPRING = LinearHand(mass=0.0, stiffness=60.0, damping=0.2)
"""What the follower is tied to [kg, N/m, N·s/m]."""

_PRESS = "Take the handle, push it slowly into the wall, hold it there, then let go."


LIGHT = LinearHand(mass=0.006, stiffness=200.0, damping=0.2)
"""A hand that holds the handle with two finger tips [kg, N/m, N·s/m]: it damps little."""


def _paddle(**changes: Any) -> Device:
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


def _smooth(**changes: Any) -> Device:
    """The same on good bearings: friction hides nothing, and the motor is small."""
    given = {"damping": "0.1 N*s/m", "coulomb_friction": "0.01 N", "force_limit": "5 N", **changes}
    return _paddle(**given)


_pressed = partial(played, hand=LIGHT, do=_PRESS)
_led = partial(played_pair, hand=LIGHT, follower=_SPRING)


def presets() -> list[Played]:
    paddle, smooth, wall = _paddle(), _smooth(), Wall(4000)
    ideal = _smooth(resolution=0)
    controller = PassivityController(largest_damping="unlimited")
    wheel = rotary(
        inertia="0.05 kg*m^2",
        damping="0.02 N*m*s/rad",
        coulomb_friction="0.05 N*m",
        resolution="0.1 mrad",
        rate="500 Hz",
        delay="10 ms",
        force_limit="2 N*m",
        name="wheel",
    )
    arm = _smooth(damping="0.15 N*s/m", force_limit="1 N")
    near = Pair(arm, arm, stiffness=100, damping="0.02")
    return [
        played(
            paddle,
            Wall(300),
            name="A wall that is proved",
            do=_PRESS,
            notice="The handle comes to rest at once, and there is nothing to hear but the press itself.",
        ),
        _pressed(
            _smooth(resolution="0.3 mm"),
            Wall(1500, 10),
            name="Buzz: a coarse encoder",
            notice="Each count is a jump of the measured velocity, and of the damper's force: it buzzes.",
        ),
        played(
            _smooth(rate="100 Hz", force_limit="2 N"),
            Wall(500),
            name="Bounce: a slow rate",
            hand=LIGHT,
            do="Push the handle into the wall and hold the hand still, some millimetres inside.",
            notice="The force is up to 10 ms old: the handle comes out faster than it went in, again and "
            "again.",
        ),
        played(
            wheel,
            PulseTransferFunction([20], [1]),
            name="Death wobble: a wheel, hands off",
            reach=3.0,
            do="Turn the wheel a little, then let go and keep your hands off.",
            notice="Held, it is calm. Hands off it swings on and on: the motor gives what friction takes.",
        ),
        played(
            paddle,
            StandardLinearSolid(60, 150, 4),
            name="Soft tissue",
            do="Press in, wait, and come back quickly.",
            notice="The force falls while you wait, and on the way back there is less of it.",
        ),
        played(
            paddle,
            NonlinearSpring.detents(3, "8 mm", "0.5 N"),
            name="Detents",
            do="Move the handle from one notch to the next, and let go between them.",
            notice="It is drawn into the nearest notch and rests there.",
        ),
        _pressed(
            ideal,
            wall,
            name="Too hard a wall",
            notice="It kicks the hand back, and the hand gets out more energy than it put in.",
        ),
        _pressed(
            ideal,
            render(wall, controller),
            name="The same, passivity controller on",
            notice="Energy that is about to come out is taken by damping: the kicks are gone. "
            "What is proved of it is said above, and no more.",
        ),
        _pressed(
            smooth,
            render(wall, ForceBounding()),
            name="The same, force bounding on",
            notice="The force is never more than what the hand has paid for: softer, and proved.",
        ),
        _led(
            near,
            name="Two arms, no delay",
            do="Lead one arm; the other follows, tied to a spring.",
            notice="The hand feels the spring that the follower pulls at.",
        ),
        _led(
            near.replace(delay="20 ms"),
            name="Two arms, a link of 20 ms",
            do="Lead one arm quickly to and fro, then let go.",
            notice="Each arm is told where the other was 20 ms ago: they swing, and go on.",
        ),
    ]
