"""What each region of a map is about: which hands, which contact, what of encoder and actuator is counted."""

from __future__ import annotations

from zwidth.model.environment import Wall
from zwidth.passivity.scope import Hands, Scope, scope_of
from zwidth.study.maps.request import Request


def scopes(asked: Request, speed: float) -> dict[str, Scope]:
    """The scope of each region by its name; `speed` is that up to which a wall is quiet [m/s; rad/s]."""
    every = scope_of(asked.device, Wall(1))
    late = asked.device.exact("delay") / asked.device.exact("sample_period")
    known = every.replace(
        contact="kept",
        encoder="not counted" if every.encoder == "counted" else "ideal",
        coulomb_friction=None,
        assumed=(),
    )
    return {
        "passive": every,
        "passive_sustained": every.replace(contact="kept"),
        "quiet": every.replace(hands=Hands(speed=speed, in_each_part=late.denominator != 1)),
        **{f"stable_{name}": known.replace(hands=Hands(impedance=name)) for name, _ in asked.hands},
    }
