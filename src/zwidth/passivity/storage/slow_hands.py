"""Slow hands: what covers every hand with more damping covers slow ones with more Coulomb friction.

    v (b_0 − b) ≤ f_c − f_0

b_0 and f_0 cover contact made and broken by every hand: of a spring, or of a wall with virtual damping
(`contact`).  No count of the encoder is gone through: a fine one is as easy as a coarse one.
"""

from __future__ import annotations

from fractions import Fraction
from typing import Any

from zwidth.errors import InputError
from zwidth.model.device import Device
from zwidth.model.environment.environment import Environment
from zwidth.passivity.certificate import FORMAT, Certificate, wall_document
from zwidth.passivity.decision import Decision, decide
from zwidth.passivity.document import loop_document, unit_key
from zwidth.passivity.linear.contact import DampedWall, enough_damping
from zwidth.quantity.text import exact_text

KIND = "slow hands"


def slow_hands(device: Device, environment: Environment, speed: Fraction) -> Certificate | None:
    """A proof for hands whose mean speed stays at or below `speed` [m/s; rad/s], at any depth; None without.

    The mean is over each time in which one force is held: a sample, or each part of it where a delay
    changes the force in between.
    """
    try:
        decision = decide(device, environment)
    except InputError:  # a law without H(z)
        return None
    enough = _enough(decision)
    if enough is None or not _covers(decision, *enough, speed):
        return None
    certificate = Certificate((_document(decision, *enough, speed),))
    return certificate if certificate.verify() else None


def _enough(decision: Decision) -> tuple[Fraction, Fraction] | None:
    """b_0 and f_0 that cover every hand; None where none are known."""
    if decision.is_spring:
        spring = Fraction(decision.loop.numerator[0], decision.loop.denominator[0])
        return enough_damping(decision.loop, spring), spring * decision.setting.resolution / 2
    wall = decision.wall
    if not (isinstance(wall, DampedWall) and decision.setting.unilateral and wall.stiffness >= 0):
        return None
    damping = wall.required_damping(decision.loop)
    if damping is None:
        return None
    return damping, wall.required_friction(decision.setting.resolution, decision.loop.period)


def _covers(decision: Decision, damping: Fraction, friction: Fraction, speed: Fraction) -> bool:
    left_over = decision.setting.coulomb_friction - friction
    return left_over >= 0 and left_over >= (damping - decision.loop.damping) * speed


def _document(decision: Decision, damping: Fraction, friction: Fraction, speed: Fraction) -> dict[str, Any]:
    setting, motion = decision.setting, decision.setting.motion
    loop = loop_document(
        setting.loop, setting.coulomb_friction, setting.resolution, setting.unilateral, motion
    )
    kind = "spring" if decision.is_spring else "contact"
    document: dict[str, Any] = {
        "format": FORMAT,
        "kind": KIND,
        "loop": loop,
        f"largest_speed_{'rad_per_s' if motion == 'rotary' else 'm_per_s'}": exact_text(speed),
        "enough": {
            "kind": kind,
            unit_key("damping", motion): exact_text(damping),
            unit_key("coulomb_friction", motion): exact_text(friction),
        },
    }
    if kind == "contact":
        assert isinstance(decision.wall, DampedWall)
        document["law"] = wall_document(decision.wall, motion)
    return document
