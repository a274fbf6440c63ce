"""Hands by name, and the one that is meant where nobody says which."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

from zwidth.model.device.device import Device
from zwidth.model.operator.fingers import Finger, FingersOn, HandsOff, HandsOn
from zwidth.model.operator.machines import ConstantForce, Cycle, Dowel, Guide
from zwidth.model.operator.operator import ParametricOperator
from zwidth.model.operator.touches import MaliciousTouch, SoftTouch, TypicalTouch
from zwidth.quantity.exact import ends

OPERATORS: Mapping[str, type[ParametricOperator]] = MappingProxyType(
    {
        "constant-force": ConstantForce,
        "cycle": Cycle,
        "dowel": Dowel,
        "finger": Finger,
        "fingers-on": FingersOn,
        "guide": Guide,
        "hands-off": HandsOff,
        "hands-on": HandsOn,
        "malicious": MaliciousTouch,
        "soft": SoftTouch,
        "typical": TypicalTouch,
    }
)
"""The operators that are a few numbers, by the name under which a command line knows them."""

HEAVIEST_KNOB = 0.0003
"""Inertia from which on what turns is taken for a wheel [kg·m²]: chosen, between fingers and hands."""

_KINDS: dict[str, type[Finger]] = {"finger": Finger, "fingers-on": FingersOn, "hands-on": HandsOn}


def usual_hand(device: Device) -> Finger:
    """The hand that holds a device where nobody says which, with its default numbers.

    Motion and mass decide; where the mass is not known, or may be that of a wheel, it is a wheel.
    """
    return _KINDS[usual_kind(device)]()


def usual_kind(device: Device) -> str:
    """The name of that hand: "finger", "fingers-on" or "hands-on"."""
    if device.motion == "linear":
        return "finger"
    is_knob = device.mass is not None and float(ends(device.mass)[1]) < HEAVIEST_KNOB
    return "fingers-on" if is_knob else "hands-on"
