"""Laws that are emitted for small machines, and a device with the travel of a paddle."""

from __future__ import annotations

import zwidth as zw
from zwidth.machine.firmware.emit import Emitted, emit
from zwidth.model.environment.environment import Environment
from zwidth.model.rendering import Hysteresis, OnePole, Window

DEVICE = zw.catalogue.device("haptic-paddle")
TRAVEL = "-60 .. 60 mm"

LAWS: dict[str, Environment] = {
    "spring": zw.Wall(150),
    "damped wall": zw.Wall(150, 0.05),
    "damped wall that never pulls": zw.Wall(150, 0.05, clamped=True),
    "damped wall, window of 4": zw.Wall(150, 0.05, velocity_filter=Window(4)),
    "damped wall, one pole of 5 ms": zw.Wall(150, 0.05, velocity_filter=OnePole("5 ms")),
    "spring with hysteresis": zw.render(zw.Wall(150), Hysteresis(force=0.2)),
    "standard linear solid": zw.StandardLinearSolid(100, 60, 0.3),
    "H(z) of order 2": zw.PulseTransferFunction([150, -40, 10], [1, -0.3, 0.1]),
    "H(z) of order 4": zw.PulseTransferFunction([150, -40, 10, 5, 1], [1, -0.3, 0.1, -0.05, 0.01]),
}
"""By name; each but the one with hysteresis is proved passive."""


def emitted(name: str, number: str, target: str = "c99") -> Emitted:
    return emit(DEVICE, LAWS[name], target=target, number=number, travel=TRAVEL, anyway=True)
