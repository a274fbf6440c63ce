"""The hand where nobody says which: of the size of what it holds.

a handle that slides                 a finger
what turns, J < 0.0003 kg·m²         thumb and finger on a knob
what turns, J ≥ 0.0003 kg·m²         two hands on a wheel
"""

from __future__ import annotations

from zwidth.model.device.device import Device
from zwidth.model.operator.finger import Finger
from zwidth.model.operator.on_a_knob import FingersOn
from zwidth.model.operator.on_a_wheel import HandsOn
from zwidth.quantity.exact import ends

HEAVIEST_KNOB = 0.0003
"""Inertia from which on what turns is taken for a wheel [kg·m²]: chosen, between fingers and hands."""

_KINDS: dict[str, type[Finger]] = {"finger": Finger, "fingers-on": FingersOn, "hands-on": HandsOn}


def usual_hand(device: Device) -> Finger:
    """The hand that holds a device where nobody says which, with its default numbers.

    Parameters
    ----------
    device
        Its motion and mass decide; where the mass is not known, or may be that of a wheel, it is a wheel.
    """
    return _KINDS[usual_kind(device)]()


def usual_kind(device: Device) -> str:
    """The name of that hand: "finger", "fingers-on" or "hands-on"."""
    if device.motion == "linear":
        return "finger"
    is_knob = device.mass is not None and float(ends(device.mass)[1]) < HEAVIEST_KNOB
    return "fingers-on" if is_knob else "hands-on"
